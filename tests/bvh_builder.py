"""BVH files made on the spot: a known motion in any unit, up axis, facing, order of channels and rest pose."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d
from scipy.spatial.transform import Rotation

from avatar_builder import MIXAMO
from elbowroom.body.bones import PARENTS
from elbowroom.clips.body_motion import BodyMotion
from elbowroom.geometry import quaternion
from odd_bodies import SKELETON

Floats = NDArray[np.float64]

BONES = tuple(bone for bone in SKELETON.names if bone in MIXAMO)


@dataclass(frozen=True)
class BvhRecipe:
    """What the file is to be like."""

    unit: float = 0.01  # metres
    to_file: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)  # from Y up, facing +Z, to the file's axes
    order: str = "ZXY"
    arms_down: float = 0.0  # rest pose: arms below the horizontal, radians
    all_positions: bool = False  # six channels for every joint
    names: dict[str, str] = field(default_factory=lambda: dict(MIXAMO))
    fps: float = 30.0
    crlf: bool = False


def random_motion(rng: np.random.Generator, frames: int = 12, smooth: float = 0.0) -> BodyMotion:
    """A figure that stands upright and moves every joint a little, at random; `smooth` over so many frames."""
    index = [SKELETON.index(bone) for bone in BONES]
    vectors = 0.4 * rng.standard_normal((frames, len(BONES), 3))
    if smooth:
        vectors = gaussian_filter1d(vectors, smooth, axis=0) * np.sqrt(3.5 * smooth)
    local = quaternion.from_rotation_vector(vectors)
    local[:, 0] = quaternion.multiply(quaternion.about_axis(1, 0.3 * rng.standard_normal(frames)), local[:, 0])
    turns = local.copy()
    for i, bone in enumerate(BONES):
        parent = _parent(bone)
        if parent is not None:
            turns[:, i] = quaternion.multiply(turns[:, BONES.index(parent)], local[:, i])
    hips = SKELETON.positions[0] + 0.2 * rng.standard_normal((frames, 3))
    soles = np.zeros((2, 2, 3))
    return BodyMotion("made", BONES, SKELETON.positions[index], 1.0 / 30.0, turns, hips, soles)


def write_bvh(motion: BodyMotion, recipe: BvhRecipe) -> bytes:
    """The motion as a BVH file."""
    rest = _rest_turns(recipe)
    to_file = np.array(recipe.to_file)
    offsets = _offsets(motion, rest, recipe)
    lines = ["HIERARCHY"]
    _joint(lines, "hips", 0, offsets, recipe)
    lines += ["MOTION", f"Frames: {len(motion)}", f"Frame Time: {1.0 / recipe.fps:.9f}"]
    world = {
        bone: quaternion.multiply(
            quaternion.multiply(to_file, quaternion.multiply(motion.turn(bone), quaternion.conjugate(rest[bone]))),
            quaternion.conjugate(to_file),
        )
        for bone in BONES
    }
    rows = []
    hips = quaternion.rotate(to_file, motion.hips) / recipe.unit
    for bone in _depth_first("hips"):
        parent = _parent(bone)
        local = world[bone] if parent is None else quaternion.multiply(quaternion.conjugate(world[parent]), world[bone])
        if parent is None or recipe.all_positions:
            rows.append(hips if parent is None else np.tile(offsets[bone], (len(motion), 1)))
        angles = Rotation.from_quat(local).as_euler(recipe.order, degrees=True)
        rows.append(angles)
    table = np.concatenate(rows, axis=1)
    lines += [" ".join(f"{value:.9g}" for value in row) for row in table]
    return ("\r\n" if recipe.crlf else "\n").join([*lines, ""]).encode()


def _joint(lines: list[str], bone: str, depth: int, offsets: dict[str, Floats], recipe: BvhRecipe) -> None:
    pad = "\t" * depth
    lines.append(f"{pad}{'JOINT' if depth else 'ROOT'} {recipe.names[bone]}")
    lines.append(pad + "{")
    lines.append(f"{pad}\tOFFSET " + " ".join(f"{value:.9g}" for value in offsets[bone]))
    turns = [f"{axis}rotation" for axis in recipe.order]
    places = [f"{axis}position" for axis in "XYZ"] if depth == 0 or recipe.all_positions else []
    lines.append(f"{pad}\tCHANNELS {len(turns) + len(places)} " + " ".join(places + turns))
    for child in _children(bone):
        _joint(lines, child, depth + 1, offsets, recipe)
    if not _children(bone):
        lines += [f"{pad}\tEnd Site", pad + "\t{", f"{pad}\t\tOFFSET 0 0 0", pad + "\t}"]
    lines.append(pad + "}")


def _rest_turns(recipe: BvhRecipe) -> dict[str, Floats]:
    """How far each bone is turned from the T-pose in the file's rest pose."""
    turns = dict.fromkeys(BONES, quaternion.IDENTITY)
    for side, sign in (("left", -1.0), ("right", 1.0)):
        for bone in ("UpperArm", "LowerArm", "Hand"):
            turns[side + bone] = quaternion.about_axis(2, sign * recipe.arms_down)
    return turns


def _offsets(motion: BodyMotion, rest: dict[str, Floats], recipe: BvhRecipe) -> dict[str, Floats]:
    offsets = {"hips": np.zeros(3)}
    for bone in BONES[1:]:
        parent = _parent(bone)
        step = motion.rest[BONES.index(bone)] - motion.rest[BONES.index(parent or "hips")]
        turned = quaternion.rotate(rest[parent or "hips"], step)
        offsets[bone] = quaternion.rotate(np.array(recipe.to_file), turned) / recipe.unit
    return offsets


def _parent(bone: str) -> str | None:
    parent = PARENTS[bone]
    while parent is not None and parent not in BONES:
        parent = PARENTS[parent]
    return parent


def _children(bone: str) -> list[str]:
    return [other for other in BONES if _parent(other) == bone]


def _depth_first(bone: str) -> list[str]:
    return [bone, *(below for child in _children(bone) for below in _depth_first(child))]
