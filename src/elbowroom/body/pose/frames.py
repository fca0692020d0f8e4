"""Frames of joints, in rows of arrays: put at places, one after the other along a tree, and the capsules on them.

Rotations are quaternions, rows `xyzw` of (J, 4); all in float64.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import inner_kernel, plain

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Segments = NDArray[np.float32]

_FIRST = plain(0)
_OTHER_END = plain(3)  # where it begins in the row (6,) of a capsule


@inner_kernel
def product_into(a: Floats, i: int, b: Floats, j: int, out: Floats, k: int) -> None:
    """out[k] = a[i] b[j]."""
    ax, ay, az, aw = a[i, 0], a[i, 1], a[i, 2], a[i, 3]
    bx, by, bz, bw = b[j, 0], b[j, 1], b[j, 2], b[j, 3]
    out[k, 0] = aw * bx + ax * bw + ay * bz - az * by
    out[k, 1] = aw * by - ax * bz + ay * bw + az * bx
    out[k, 2] = aw * bz + ax * by - ay * bx + az * bw
    out[k, 3] = aw * bw - ax * bx - ay * by - az * bz


@inner_kernel
def offset_into(
    q: Floats, j: int, arm: tuple[float, float, float], base: Floats, i: int, out: Floats, k: int, at: int
) -> None:
    """out[k, at:at+3] = base[i] + the vector `arm` rotated by q[j]."""
    x, y, z = arm
    qx, qy, qz, qw = q[j, 0], q[j, 1], q[j, 2], q[j, 3]
    tx, ty, tz = 2.0 * (qy * z - qz * y), 2.0 * (qz * x - qx * z), 2.0 * (qx * y - qy * x)
    out[k, at] = base[i, 0] + x + qw * tx + qy * tz - qz * ty
    out[k, at + 1] = base[i, 1] + y + qw * ty + qz * tx - qx * tz
    out[k, at + 2] = base[i, 2] + z + qw * tz + qx * ty - qy * tx


@inner_kernel
def set_turn(out: Floats, k: int, turn: tuple[float, float, float, float]) -> None:
    """out[k] = turn."""
    out[k, 0], out[k, 1], out[k, 2], out[k, 3] = turn


@inner_kernel
def place_frame(joint: int, rotations: Floats, places: Floats, x: float, y: float, z: float, heading: float) -> None:
    """Put a base frame at a point, turned about +Y."""
    rotations[joint, 0], rotations[joint, 1] = 0.0, np.sin(0.5 * heading)
    rotations[joint, 2], rotations[joint, 3] = 0.0, np.cos(0.5 * heading)
    places[joint, 0], places[joint, 1], places[joint, 2] = x, y, z


@inner_kernel
def frames_along(
    order: Indices, parents: Indices, offsets: Floats, local: Floats, rotations: Floats, places: Floats
) -> None:
    """Frames of the joints in `order`, parents first; the parent of the first is in place already."""
    for i in range(len(order)):
        joint = order[i]
        parent = parents[joint]
        arm = offsets[joint, 0], offsets[joint, 1], offsets[joint, 2]
        offset_into(rotations, parent, arm, places, parent, places, joint, _FIRST)
        product_into(rotations, parent, local, joint, rotations, joint)


@inner_kernel
def segments_into(
    joints: Indices, ends: Floats, rotations: Floats, places: Floats, row: Floats, n: int, out: Segments
) -> None:
    """Capsule end points of posture `n` into out (C, 6, N); `row` (1, 6) is scratch."""
    for c in range(len(joints)):
        j = joints[c]
        offset_into(rotations, j, (ends[c, 0], ends[c, 1], ends[c, 2]), places, j, row, _FIRST, _FIRST)
        offset_into(rotations, j, (ends[c, 3], ends[c, 4], ends[c, 5]), places, j, row, _FIRST, _OTHER_END)
        for i in range(6):
            out[c, i, n] = row[0, i]
