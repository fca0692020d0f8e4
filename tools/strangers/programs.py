"""Each program of others, and how far its joints are from ours in the files that it reads."""

import json
import subprocess
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import bvhio
import numpy as np

from avatar_builder import json_of
from elbowroom.body.loading.hanim_names import hanim_name
from elbowroom.geometry import quaternion
from gltf_judge import validated
from strangers.walk import Walk
from three_judge import MODULES, ThreeJudge
from x_ite import XIte

HERE = Path(__file__).parent


@dataclass(frozen=True)
class Finding:
    """What one program makes of one format."""

    program: str
    version: str
    format: str
    away: float | None = None  # millimetres, at the worst joint
    errors: int | None = None  # that a validator found
    note: str = ""  # why there is neither


def apart(python: Path, script: str, walk: Walk, ending: str) -> dict[str, Any]:
    """The answer of a script that runs in an environment of its own."""
    frames, names = json.dumps(walk.frames), json.dumps(walk.names)
    call = [str(python), str(HERE / script), str(walk.file(ending)), str(walk.animation.fps), frames, names]
    done = subprocess.run(call, capture_output=True, text=True, check=True, timeout=300)
    answer: dict[str, Any] = json.loads(done.stdout.strip().splitlines()[-1])
    return answer


def blender(python: Path, walk: Walk) -> Iterator[Finding]:
    """Blender's importers."""
    for ending in ("bvh", "glb", "usda"):
        told = apart(python, "blender.py", walk, ending)
        yield Finding("Blender", told["version"], ending, walk.away(told["places"]))


def usd(python: Path, walk: Walk) -> Iterator[Finding]:
    """OpenUSD itself, and its validators."""
    told = apart(python, "usd.py", walk, "usda")
    yield Finding("OpenUSD", told["version"], "usda", walk.away(told["places"]), len(told["errors"]))


def bvhio_(walk: Walk) -> Iterator[Finding]:
    """The BVH reader of the tests."""
    root, shown = bvhio.readAsHierarchy(str(walk.file("bvh"))), []
    for frame in walk.frames:
        root.loadPose(frame)
        at = {joint.Name: [0.01 * value for value in joint.PositionWorld] for joint, _, _ in root.layout()}
        shown.append([at[name] for name in walk.names])
    yield Finding("bvhio", version("bvhio"), "bvh", walk.away(shown))


def validator(walk: Walk) -> Iterator[Finding]:
    """Khronos' validator."""
    for ending in ("glb", "vrma"):
        report = validated(walk.file(ending).read_bytes())
        yield Finding("glTF validator", report["validatorVersion"], ending, None, report["issues"]["numErrors"])


def three(chromium: Any, walk: Walk) -> Iterator[Finding]:
    """three.js and three-vrm."""
    judge = ThreeJudge(chromium)
    release = f"0.{judge.release()}"
    glb = walk.file("glb").read_bytes()
    names = [node.get("name") for node in json_of(glb)["nodes"]]
    nodes = [names.index(name) for name in walk.names]
    shown = np.array(judge.nodes(glb, 0, walk.times))[:, nodes, :3]
    yield Finding("three.js", release, "glb", walk.away(shown))
    placed = judge.bvh(walk.file("bvh").read_text(), walk.times)
    places = 0.01 * np.array([[pose[name] for name in walk.names] for pose in placed])
    yield Finding("three.js", release, "bvh", walk.away(places))
    yield _three_vrm(judge, walk)
    judge.close()


def _three_vrm(judge: ThreeJudge, walk: Walk) -> Finding:
    """The normalised bones of the avatar that three-vrm animates, put together; eyes are no part of the animation."""
    rest, parents = walk.avatar.skeleton.positions, walk.avatar.skeleton.parents
    shown = judge.bones(walk.avatar.glb or b"", walk.file("vrma").read_bytes(), walk.times)
    places = np.empty((len(shown), len(walk.names), 3))
    for frame, pose in enumerate(shown):
        turns = np.empty((len(walk.names), 4))
        for joint, name in enumerate(walk.names):
            own, parent = np.array(pose[name]), parents[joint]
            turns[joint] = own[:4] if parent < 0 else quaternion.multiply(turns[parent], own[:4])
            along = own[4:] if parent < 0 else quaternion.rotate(turns[parent], rest[joint] - rest[parent])
            places[frame, joint] = along if parent < 0 else places[frame, parent] + along
    package = json.loads((MODULES / "@pixiv" / "three-vrm-animation" / "package.json").read_text())
    return Finding("three-vrm", package["version"], "vrma", walk.away(places))


def x_ite(chromium: Any, walk: Walk) -> Iterator[Finding]:
    """X_ITE."""
    judge = XIte(chromium)
    last = len(walk.animation) - 1
    told = judge.moved(walk.file("x3d").read_text(), [frame / last for frame in walk.frames])
    shown = [[pose[hanim_name(name)] for name in walk.names] for pose in told["shown"]]
    judge.close()
    yield Finding("X_ITE", told["version"], "x3d", walk.away(shown))


Program = Callable[[], Iterator[Finding]]
