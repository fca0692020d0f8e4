"""Feet that glide where they have no room for steps of their own: into the walking cycle, and on as it has them."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.cycle import GaitShape, flat_place, roll_of
from elbowroom.body.gait.foot_state import (
    FLAT,
    LIFT,
    LIFT_RATE,
    LIFTING,
    PITCH,
    RISING,
    SWING,
    VELOCITY,
    YAW,
    X,
    Z,
    carry,
    is_flat,
    land,
    position,
    rests,
    tilt,
)
from elbowroom.body.gait.stepping_times import TURNING
from elbowroom.body.gait.stride import stride_at
from elbowroom.body.root import FOOT, ROOT_STATE, WITH_FEET
from elbowroom.jit import brief_exact_kernel

Floats = NDArray[np.float64]

_GLIDE, _PIVOT = 1.5, 5.0  # m/s of a standard leg, and rad/s, by which feet glide into the cycle
_SKIM, _OFF = 0.03, 0.06  # metres of a standard leg that a foot is lifted which is so far beside the cycle, or more
_AT_LEAST = 0.2  # of its swing is over, for a foot that does


@brief_exact_kernel
def glide_feet(legs: Floats, scale: float, before: Floats, root: Floats, dt: float, holds: bool, out: Floats) -> None:
    """The feet `dt` seconds later, as `step_feet`, where there is no room for steps of their own.

    They go as the walking cycle has them, and what they are beside it becomes less; if it `holds`, while they swing,
    and one that stands stays until the cycle lifts it. Under a root that rests they end up flat on the ground and
    stand, wherever in the cycle that is.
    """
    carry(before, root, out)
    holds = holds and not rests(root)
    first, stride = stride_at(scale, before), stride_at(scale, root)
    for side in range(2):
        foot, was = out[ROOT_STATE + FOOT * side :], before[ROOT_STATE + FOOT * side :]
        x0, z0, yaw0, _ = flat_place(legs, first, side, position(before[6], side))
        u = position(root[6], side)
        x, z, yaw, swung = flat_place(legs, stride, side, u)
        pitch, lift = roll_of(stride, u)
        if holds and swung <= 0.0 and (was[SWING] <= 0.0 or was[LIFT] < FLAT):
            land(foot)
            tilt(foot, pitch, dt)
            continue
        dx, dz, turned = was[X] - x0, was[Z] - z0, was[YAW] - yaw0
        left = max(1.0 - dt * _GLIDE * np.sqrt(scale) / max(np.hypot(dx, dz), 1e-9), 0.0)
        twisted = max(1.0 - dt * _PIVOT / max(abs(turned), 1e-9), 0.0)
        stayed = foot[X], foot[Z], foot[YAW]  # where it would be if it stood
        foot[X], foot[Z], foot[YAW] = x + left * dx, z + left * dz, yaw + twisted * turned
        off = left * np.hypot(dx, dz) + TURNING * scale * twisted * abs(turned)
        lift = max(lift, _SKIM * scale * min(off / (_OFF * scale), 1.0))
        foot[LIFT] = was[LIFT] + min(max(lift - was[LIFT], -LIFT_RATE * dt), LIFT_RATE * dt)
        foot[LIFTING] = (foot[LIFT] - was[LIFT]) / dt if dt > 0.0 else 0.0
        foot[PITCH] = was[PITCH]
        tilt(foot, pitch, dt)
        if max(left, twisted) > 0.0:
            foot[SWING] = max(swung, _AT_LEAST)
        else:
            foot[SWING] = 0.0 if rests(root) and is_flat(foot) else swung
        foot[RISING] = 0.0
        for i in range(3):
            foot[VELOCITY + i] = (foot[X + i] - stayed[i]) / dt if holds and dt > 0.0 and foot[SWING] > 0.0 else 0.0


def gliding(gait: GaitShape, before: Floats, root: Floats, dt: float, *, holds: bool = False) -> Floats:
    """`root` (7 or more,) with feet (WITH_FEET,) that go from those of `before` to those of the walking cycle.

    If it `holds`, only while they swing.
    """
    out = np.empty(WITH_FEET)
    glide_feet(gait.legs, gait.scale, before, root[:ROOT_STATE].copy(), dt, holds, out)
    return out
