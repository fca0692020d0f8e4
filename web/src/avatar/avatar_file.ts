/** Loads a VRM or glTF avatar and finds its nodes by their index in the file. */

import { VRMLoaderPlugin, VRMUtils, type VRM } from "@pixiv/three-vrm";
import { Mesh, Object3D, SkinnedMesh, type Group } from "three";
import { GLTFLoader, type GLTF } from "three/addons/loaders/GLTFLoader.js";
import { asked } from "../net/asked";
import { addDecoders } from "./decoders";
import { orderGeometry } from "./triangle_order";

/** An avatar ready to be posed. */
export interface AvatarFile {
  readonly scene: Group;
  /** Null for glTF files without VRM data. */
  readonly vrm: VRM | null;
  /** Scene objects by glTF node index. */
  readonly nodes: ReadonlyMap<number, Object3D>;
}

/** @throws Error when the file cannot be fetched or read */
export async function loadAvatarFile(url: string): Promise<AvatarFile> {
  const loader = new GLTFLoader();
  loader.register((parser) => new VRMLoaderPlugin(parser, { autoUpdateHumanBones: false }));
  const file = await (await asked(url)).arrayBuffer();
  await addDecoders(loader, file);
  const gltf = await loader.parseAsync(file, "").finally(() => loader.dracoLoader?.dispose());
  const vrm = (gltf.userData["vrm"] as VRM | undefined) ?? null;
  gltf.scene.traverse(prepareMesh);
  return { scene: gltf.scene, vrm, nodes: nodesByIndex(gltf) };
}

/** Frees what the file holds on the graphics card. */
export function disposeAvatarFile(file: AvatarFile): void {
  file.scene.removeFromParent();
  VRMUtils.deepDispose(file.scene);
}

function nodesByIndex(gltf: GLTF): Map<number, Object3D> {
  const nodes = new Map<number, Object3D>();
  for (const [object, reference] of gltf.parser.associations) {
    const index = (reference as { nodes?: number } | undefined)?.nodes;
    if (index === undefined || !(object instanceof Object3D)) continue;
    const known = nodes.get(index);
    if (!known || object === known.parent) nodes.set(index, object);
  }
  return nodes;
}

/** Skinned meshes move away from their rest bounds, so they are always drawn; their triangles are put in order. */
function prepareMesh(object: Object3D): void {
  if (!(object instanceof Mesh)) return;
  object.castShadow = true;
  object.receiveShadow = !(object instanceof SkinnedMesh);
  object.frustumCulled = false;
  orderGeometry(object.geometry);
}
