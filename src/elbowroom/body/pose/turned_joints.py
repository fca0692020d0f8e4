"""How the numbers of a posture turn joints: the rotations of spine, arms and legs in their parents' frames."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.pose.frames import product_into
from elbowroom.body.pose.joint_tree import SpineColumn
from elbowroom.jit import inner_kernel, plain

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

_FIRST, _SECOND = plain(0), plain(1)  # rows of scratch


@inner_kernel
def set_power(x: float, y: float, z: float, scale: float, out: Floats, k: int) -> None:
    """out[k] = exp(scale (x, y, z))."""
    half = 0.5 * scale * np.sqrt(x * x + y * y + z * z)
    factor = 0.5 * scale * (1.0 - half * half / 6.0) if abs(half) < 1e-4 else 0.5 * scale * np.sin(half) / half
    out[k, 0], out[k, 1], out[k, 2], out[k, 3] = factor * x, factor * y, factor * z, np.cos(half)


@inner_kernel
def set_column(column: SpineColumn, bend: float, twist: float, local: Floats) -> None:
    """The joints of a column: each takes its share of the rotation vector of Ry(twist) Rx(bend)."""
    cb, sb, ct, st = np.cos(0.5 * bend), np.sin(0.5 * bend), np.cos(0.5 * twist), np.sin(0.5 * twist)
    x, y, z, w = ct * sb, st * cb, -st * sb, ct * cb
    sine = np.sqrt(x * x + y * y + z * z)
    angle = 2.0 * np.arctan2(sine, w)
    factor = angle / sine if sine > 1e-9 else 2.0
    for i in range(len(column.joints)):
        set_power(x * factor, y * factor, z * factor, column.shares[i], local, column.joints[i])


@inner_kernel
def set_arm(joints: Indices, mirror: float, arm: Floats, local: Floats, scratch: Floats) -> None:
    """Upper arm and forearm for (flexion, abduction, internal rotation, elbow); `mirror` is +1 left, -1 right."""
    upper, lower = joints[0], joints[1]
    set_power(-arm[0], 0.0, mirror * arm[1], 1.0, scratch, _FIRST)
    half = 0.5 * np.sqrt(0.5)
    # Ry(-m i) Rz(-m 90 deg): the product of two rotations about axes, written out
    c, s = 2.0 * half * np.cos(0.5 * arm[2]), -mirror * 2.0 * half * np.sin(0.5 * arm[2])
    scratch[1, 0], scratch[1, 1], scratch[1, 2], scratch[1, 3] = -mirror * s, s, -mirror * c, c
    product_into(scratch, _FIRST, scratch, _SECOND, local, upper)
    local[lower, 0], local[lower, 1] = 0.0, -mirror * np.sin(0.5 * arm[3])
    local[lower, 2], local[lower, 3] = 0.0, np.cos(0.5 * arm[3])


@inner_kernel
def set_legs(joints: Indices, rotations: Floats, local: Floats) -> None:
    """Thigh, shin, foot and toes of both legs; joints (2, 4), -1 where the avatar has no such bone."""
    for side in range(2):
        for part in range(4):
            joint = joints[side, part]
            if joint >= 0:
                for i in range(4):
                    local[joint, i] = rotations[side, part, i]
