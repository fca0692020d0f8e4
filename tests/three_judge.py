"""three.js, three-vrm and three-vrm-animation in a headless browser, as judges of poses. The page sees no network."""

import base64
import mimetypes
from pathlib import Path
from typing import Any
from urllib.parse import urlparse

import pytest

MODULES = Path(__file__).parents[1] / "web" / "node_modules"
HOME = "http://judge.test/"
_PAGE = """<!doctype html><script type="importmap">{"imports": {
  "three": "/three/build/three.module.js",
  "three/addons/": "/three/examples/jsm/",
  "@pixiv/three-vrm": "/@pixiv/three-vrm/lib/three-vrm.module.js",
  "@pixiv/three-vrm-animation": "/@pixiv/three-vrm-animation/lib/three-vrm-animation.module.js"
}}</script>"""

_SETUP = """
async () => {
  const THREE = await import("three");
  const { GLTFLoader } = await import("three/addons/loaders/GLTFLoader.js");
  const { VRMLoaderPlugin } = await import("@pixiv/three-vrm");
  const animation = await import("@pixiv/three-vrm-animation");
  const load = (text) => {
    const loader = new GLTFLoader();
    loader.register((parser) => new VRMLoaderPlugin(parser));
    loader.register((parser) => new animation.VRMAnimationLoaderPlugin(parser));
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return loader.parseAsync(bytes.buffer, "");
  };
  window.judge = { THREE, animation, load };
}
"""

_NODES = """
async ([glb, clip, times]) => {
  const { THREE, load } = window.judge;
  const gltf = await load(glb);
  const count = gltf.parser.json.nodes.length;
  const nodes = await Promise.all(Array.from({ length: count }, (_, i) => gltf.parser.getDependency("node", i)));
  const mixer = new THREE.AnimationMixer(gltf.scene);
  const action = mixer.clipAction(gltf.animations[clip]);
  action.setLoop(THREE.LoopOnce);
  action.clampWhenFinished = true;
  action.play();
  return times.map((time) => {
    mixer.setTime(time);
    gltf.scene.updateMatrixWorld(true);
    const place = new THREE.Vector3(), turn = new THREE.Quaternion();
    return nodes.map((node) => [...node.getWorldPosition(place).toArray(), ...node.getWorldQuaternion(turn).toArray()]);
  });
}
"""

_THINGS = """
async ([glb, times]) => {
  const { THREE, load } = window.judge;
  const gltf = await load(glb);
  const mixer = new THREE.AnimationMixer(gltf.scene);
  for (const clip of gltf.animations.slice(0, 1)) {
    const action = mixer.clipAction(clip).setLoop(THREE.LoopOnce);
    action.clampWhenFinished = true;
    action.play();
  }
  return times.map((time) => {
    mixer.setTime(time);
    gltf.scene.updateMatrixWorld(true);
    const found = {};
    gltf.scene.traverse((mesh) => {
      if (!mesh.isMesh || mesh.isSkinnedMesh) return;
      mesh.geometry.computeBoundingBox();
      const { min, max } = mesh.geometry.boundingBox;
      found[mesh.userData.name ?? mesh.name] = [...Array(8).keys()].map((i) =>
        new THREE.Vector3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z)
          .applyMatrix4(mesh.matrixWorld).toArray());
    });
    return found;
  });
}
"""

_BVH = """
async ([text, times]) => {
  const { THREE } = window.judge;
  const { BVHLoader } = await import("three/addons/loaders/BVHLoader.js");
  const { skeleton, clip } = new BVHLoader().parse(text);
  const mixer = new THREE.AnimationMixer(skeleton.bones[0]);
  const action = mixer.clipAction(clip);
  action.setLoop(THREE.LoopOnce);
  action.clampWhenFinished = true;
  action.play();
  return times.map((time) => {
    mixer.setTime(time);
    skeleton.bones[0].updateMatrixWorld(true);
    const place = new THREE.Vector3();
    return Object.fromEntries(skeleton.bones.map((bone) => [bone.name, bone.getWorldPosition(place).toArray()]));
  });
}
"""

_BONES = """
async ([avatar, vrma, times]) => {
  const { THREE, animation, load } = window.judge;
  const vrm = (await load(avatar)).userData.vrm;
  const motion = (await load(vrma)).userData.vrmAnimations[0];
  const mixer = new THREE.AnimationMixer(vrm.scene);
  const action = mixer.clipAction(animation.createVRMAnimationClip(motion, vrm));
  action.setLoop(THREE.LoopOnce);
  action.clampWhenFinished = true;
  action.play();
  return times.map((time) => {
    mixer.setTime(time);
    const pose = {};
    for (const name of Object.keys(vrm.humanoid.humanBones)) {
      const node = vrm.humanoid.getNormalizedBoneNode(name);
      if (node) pose[name] = [...node.quaternion.toArray(), ...node.position.toArray()];
    }
    return pose;
  });
}
"""

_POSES = """
async ([avatar, poses]) => {
  const { THREE, load } = window.judge;
  const vrm = (await load(avatar)).userData.vrm;
  const names = Object.keys(vrm.humanoid.humanBones).filter((name) => vrm.humanoid.getRawBoneNode(name));
  const place = new THREE.Vector3(), turn = new THREE.Quaternion();
  const shown = poses.map(({ rotations, hips }) => {
    for (const [name, rotation] of Object.entries(rotations))
      vrm.humanoid.getNormalizedBoneNode(name)?.quaternion.fromArray(rotation);
    vrm.humanoid.getNormalizedBoneNode("hips").position.fromArray(hips);
    vrm.humanoid.update();
    vrm.scene.updateMatrixWorld(true);
    return Object.fromEntries(names.map((name) => {
      const node = vrm.humanoid.getRawBoneNode(name);
      return [name, [...node.getWorldPosition(place).toArray(), ...node.getWorldQuaternion(turn).toArray()]];
    }));
  });
  return { version: vrm.meta.metaVersion, shown };
}
"""


class ThreeJudge:
    """A page with three.js in it."""

    def __init__(self, browser: Any) -> None:
        if not (MODULES / "@pixiv" / "three-vrm-animation").is_dir():
            pytest.skip("three-vrm-animation is not installed: run `npm ci` in web")
        self._page = browser.new_page()
        self._page.route("**/*", self._answer)
        self._page.goto(HOME)
        self._page.evaluate(_SETUP)

    def nodes(self, glb: bytes, clip: int, times: list[float]) -> list[list[list[float]]]:
        """World position and rotation of every node at these times of a clip."""
        found: list[list[list[float]]] = self._page.evaluate(_NODES, [_text(glb), clip, times])
        return found

    def things(self, glb: bytes, times: list[float]) -> list[dict[str, list[list[float]]]]:
        """The corners of the boxes round all meshes without a skin, by name, at these times of the first clip."""
        found: list[dict[str, list[list[float]]]] = self._page.evaluate(_THINGS, [_text(glb), times])
        return found

    def bvh(self, text: str, times: list[float]) -> list[dict[str, list[float]]]:
        """World position of every joint of a BVH file at these times, by name, in the file's unit."""
        found: list[dict[str, list[float]]] = self._page.evaluate(_BVH, [text, times])
        return found

    def release(self) -> str:
        """The version of three.js."""
        return str(self._page.evaluate("window.judge.THREE.REVISION"))

    def bones(self, avatar: bytes, vrma: bytes, times: list[float]) -> list[dict[str, list[float]]]:
        """Normalised local rotation and position of every bone of a VRM that plays a VRM animation."""
        found: list[dict[str, list[float]]] = self._page.evaluate(_BONES, [_text(avatar), _text(vrma), times])
        return found

    def poses(self, avatar: bytes, poses: list[dict[str, Any]]) -> dict[str, Any]:
        """World position and rotation of every bone's own node of a VRM in some poses of three-vrm.

        A pose has `rotations`, normalised and local by bone, and `hips`, where the normalised hips are. The answer has
        `version`, "0" or "1", and `shown`, by pose and bone.
        """
        found: dict[str, Any] = self._page.evaluate(_POSES, [_text(avatar), poses])
        return found

    def close(self) -> None:
        """Close the page."""
        self._page.close()

    def _answer(self, route: Any) -> None:
        path = urlparse(route.request.url).path
        file = MODULES / path.lstrip("/")
        if path == "/":
            route.fulfill(body=_PAGE, content_type="text/html")
        elif route.request.url.startswith(HOME) and file.is_file():
            kind = "text/javascript" if file.suffix == ".js" else mimetypes.guess_type(file.name)[0]
            route.fulfill(path=str(file), content_type=kind or "application/octet-stream")
        else:
            route.abort()


def _text(data: bytes) -> str:
    return base64.b64encode(data).decode()
