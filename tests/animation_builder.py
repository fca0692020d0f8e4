"""GLB files with an animation, made on the spot from a known motion of an avatar's normalised joints."""

import json
from typing import Any

import numpy as np
from numpy.typing import NDArray

from avatar_builder import Recipe, build
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid_bytes
from elbowroom.formats.packing import write_glb
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]
FPS = 30.0


def joint_motion(humanoid: Humanoid, frames: int, seed: int = 0) -> tuple[Floats, Floats]:
    """Smooth random normalised rotations (F, J, 4) and hips (F, 3) of an avatar."""
    rng = np.random.default_rng(seed)
    phase = rng.uniform(0.0, 2.0 * np.pi, (len(humanoid.skeleton.names), 3))
    t = np.arange(frames)[:, None, None] / max(frames, 2)
    vectors = 0.4 * np.sin(2.0 * np.pi * t + phase)
    hips = humanoid.skeleton.positions[0] + 0.1 * np.sin(2.0 * np.pi * t[:, 0] + np.arange(3.0))
    return quaternion.from_rotation_vector(vectors), hips


def animated_glb(recipe: Recipe | None = None, *, mode: str = "LINEAR", vrma: bool = False, frames: int = 6) -> bytes:
    """An avatar after the recipe with one animation, "made": `joint_motion` of it."""
    glb = build(recipe or Recipe(mesh=False))
    humanoid = load_humanoid_bytes(glb, "made.glb")
    assert humanoid.rig is not None
    local, hips = joint_motion(humanoid, frames)
    turns = np.stack([humanoid.rig.node_rotations(pose) for pose in local])
    tracks = {("rotation", int(node)): turns[:, j] for j, node in enumerate(humanoid.rig.nodes)}
    tracks["translation", int(humanoid.rig.nodes[0])] = np.stack([humanoid.rig.hips_position(at) for at in hips])
    content, binary = _parts(glb)
    if vrma:
        bones = {bone: {"node": int(n)} for bone, n in zip(humanoid.skeleton.names, humanoid.rig.nodes, strict=True)}
        content["extensions"] = {"VRMC_vrm_animation": {"specVersion": "1.0", "humanoid": {"humanBones": bones}}}
        content["extensionsUsed"] = ["VRMC_vrm_animation"]
    return write_glb(content, _with_animation(content, binary, tracks, mode))


def _with_animation(content: dict[str, Any], binary: bytes, tracks: dict[tuple[str, int], Floats], mode: str) -> bytes:
    blob = bytearray(binary)
    views, accessors = content.setdefault("bufferViews", []), content.setdefault("accessors", [])

    def add(values: Floats, kind: str) -> int:
        data = np.ascontiguousarray(values, "<f4").tobytes()
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data)})
        accessors.append({"bufferView": len(views) - 1, "componentType": 5126, "count": len(values), "type": kind})
        blob.extend(data)
        return len(accessors) - 1

    frames = len(next(iter(tracks.values())))
    times = add(np.arange(frames)[:, None] / FPS, "SCALAR")
    samplers: list[dict[str, Any]] = []
    channels: list[dict[str, Any]] = []
    for (path, node), values in tracks.items():
        outputs = values if mode != "CUBICSPLINE" else _with_tangents(values)
        output = add(outputs, "VEC4" if path == "rotation" else "VEC3")
        channels.append({"sampler": len(samplers), "target": {"node": node, "path": path}})
        samplers.append({"input": times, "output": output, "interpolation": mode})
    content["animations"] = [{"name": "made", "samplers": samplers, "channels": channels}]
    content["buffers"] = [{"byteLength": len(blob)}]
    return bytes(blob)


def _with_tangents(values: Floats) -> Floats:
    slopes = np.gradient(values, 1.0 / FPS, axis=0)
    return np.stack([slopes, values, slopes], axis=1).reshape(-1, values.shape[1])


def _parts(glb: bytes) -> tuple[dict[str, Any], bytes]:
    size = int.from_bytes(glb[12:16], "little")
    content: dict[str, Any] = json.loads(glb[20 : 20 + size])
    return content, glb[28 + size :]
