"""Writes BVH: a skeleton whose rest pose has no rotations, and its motion as Euler angles.

Joints that move carry three position channels and an offset of zero: some programs let the channels take the offset's
place, others add the two, and so both put them in the same place.
"""

import warnings
from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.takes import Take
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_AXES = "XYZ"
_STILL = 1e-9  # units: a joint that moves less from its place needs no position channels


def write_bvh(take: Take, tips: Mapping[str, Floats], order: str = "ZXY") -> bytes:
    """The bytes of a BVH file.

    `take` has one root, and no rotations or scales in its rest pose; `tips` (3,) are the ends of bones without a joint
    below, by joint; `order` is that of the rotations, "ZXY" or any other of the six.
    """
    tree = take.tree
    if np.abs(tree.rotations[:, :3]).max() > _STILL or np.abs(tree.scales - 1.0).max() > _STILL:
        raise ValueError("BVH has no room for rotations and scales of the rest pose")
    order = order.upper()
    joints = list(_depth_first(take, int(tree.order[0])))
    moved = np.abs(take.translations - tree.translations).max(axis=(0, 2)) > _STILL
    moved[tree.order[0]] = True
    lines = ["HIERARCHY"]
    _joint(lines, take, int(tree.order[0]), moved, (order, tips), 0)
    lines += ["MOTION", f"Frames: {len(take)}", f"Frame Time: {take.frame_time:.10f}"]
    angles = euler_angles(take.rotations[:, joints], order)
    columns = []
    for place, joint in enumerate(joints):
        columns += [take.translations[:, joint]] * bool(moved[joint]) + [angles[:, place]]
    rows = np.concatenate(columns, axis=1)
    lines += [" ".join(f"{value:.9g}" for value in row) for row in rows.tolist()]
    return "\n".join([*lines, ""]).encode()


def euler_angles(rotations: Floats, order: str) -> Floats:
    """Angles (F, J, 3) in degrees for rotations (F, J, 4), in the order in which they are applied.

    Each joint's angles go on from one frame to the next without a jump: of the two ways to write a rotation, and of all
    whole turns, the nearest to the frame before is taken.
    """
    frames, joints = rotations.shape[:2]
    first = _angles(rotations.reshape(-1, 4), order).reshape(frames, joints, 3)
    flipped = first * [1.0, -1.0, 1.0] + 180.0
    out = np.empty_like(first)
    last = np.zeros((joints, 3))
    for frame in range(frames):
        ways = np.stack([first[frame], flipped[frame]])
        ways += 360.0 * np.round((last - ways) / 360.0)
        nearest = np.argmin(np.abs(ways - last).sum(axis=2), axis=0)
        last = out[frame] = ways[nearest, np.arange(joints)]
    return out


def _angles(rotations: Floats, order: str) -> Floats:
    """Some angles (N, 3) in degrees; where the middle one is a right angle the last is zero."""
    from scipy.spatial.transform import Rotation  # slow to import

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # SciPy tells of such right angles
        found: Floats = Rotation.from_quat(quaternion.normalize(rotations)).as_euler(order, degrees=True)
    return found


def _children(take: Take, joint: int) -> list[int]:
    return np.flatnonzero(take.tree.parents == joint).tolist()


def _depth_first(take: Take, joint: int) -> Iterator[int]:
    yield joint
    for child in _children(take, joint):
        yield from _depth_first(take, child)


def _joint(
    lines: list[str],
    take: Take,
    joint: int,
    moved: NDArray[np.bool_],
    settings: tuple[str, Mapping[str, Floats]],
    depth: int,
) -> None:
    """The lines of a joint and all below it."""
    order, tips = settings
    pad, name = "\t" * depth, take.tree.names[joint]
    offset = np.zeros(3) if moved[joint] else take.tree.translations[joint]
    channels = [f"{axis}position" for axis in _AXES if moved[joint]] + [f"{axis}rotation" for axis in order]
    lines += [f"{pad}{'JOINT' if depth else 'ROOT'} {name}", pad + "{", f"{pad}\tOFFSET {_text(offset)}"]
    lines.append(f"{pad}\tCHANNELS {len(channels)} {' '.join(channels)}")
    children = _children(take, joint)
    for child in children:
        _joint(lines, take, child, moved, settings, depth + 1)
    if not children:
        end = f"{pad}\t\tOFFSET {_text(tips.get(name, np.zeros(3)))}"
        lines += [f"{pad}\tEnd Site", f"{pad}\t{{", end, f"{pad}\t}}"]
    lines.append(pad + "}")


def _text(vector: Floats) -> str:
    return " ".join(f"{value:.9g}" for value in vector)
