"""Legs between two frames as a screen shows them: hips go straight there, and each joint turns by the shortest arc.

Feet do not go straight then, as those of states in between two root states do: where they are raised quickly, by some
millimetres not, and by centimetres where they are put elsewhere at once.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOWERING, DofGroup
from elbowroom.body.gait.foot_state import Z
from elbowroom.body.gait.legs import leg_rotations
from elbowroom.body.pose.kinematics import BodyModel, lower_body
from elbowroom.body.pose.posing import pose_legs
from elbowroom.body.root import FOOT, ROOT_STATE, WITH_FEET
from elbowroom.geometry import quaternion
from elbowroom.planning.model.levers import raised_between

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_LOWERING = LOWERING - DofGroup.ROOT.size  # its place in an upper body
_RAISED, _SWUNG = 0.04, 0.10  # metres that legs move at most while feet are raised, and feet beside: less goes straight
_APART = 0.02  # metres that feet go at most from one moment to the next at which legs are looked at
_QUARTERS = 4  # of the time between two frames are looked at, at least


class TurnedLegs(NamedTuple):
    """Pelvis and legs at some shares of the time between two frames."""

    states: Floats  # (N, ROOT_STATE) straight between those of the frames, seen from the place of the first
    lowerings: Floats  # (N,)
    axes: Floats32  # (C, 6, N) of the capsules


def turned_at(one: Floats, other: Floats) -> Floats:
    """At which shares (N,) of the time between frames legs are to be looked at, for root states (ROOT_STATE or more,).

    At none where they go straight, nearly; at the more the farther feet go.
    """
    feet = range(ROOT_STATE, min(len(one), WITH_FEET), FOOT)
    before, after = one.tolist(), other.tolist()
    ways = (math.dist(before[at : at + Z + 1], after[at : at + Z + 1]) for at in feet)  # of x and z, which come first
    raised, swung = raised_between(one, other), max(ways, default=0.0)
    if raised <= _RAISED and swung <= _SWUNG:
        return np.empty(0)
    count = _QUARTERS * math.ceil(max(raised, swung) / (_QUARTERS * _APART))
    return np.arange(1.0, count) / count


def turned_legs(
    model: BodyModel, roots: tuple[Floats, Floats], uppers: tuple[Floats, Floats], shares: Floats
) -> TurnedLegs:
    """The legs at `shares` (N,) of the time between frames of root states (ROOT_STATE or more,) and uppers (LOCAL,)."""
    states, lowerings = np.stack(roots), np.array([upper[_LOWERING] for upper in uppers])
    states[:, :2] -= states[0, :2]
    feet, sinks = lower_body(model.gait, states, lowerings)
    turns = leg_rotations(model.leg_rest, feet, sinks, states)
    shown = quaternion.slerp(turns[0], turns[1], shares[:, None, None])
    rows = _between(states, shares)
    return TurnedLegs(
        rows,
        _between(lowerings, shares),
        pose_legs(model.figure, model.roots.posed, rows, shown, _between(sinks, shares)),
    )


def _between(values: Floats, shares: Floats) -> Floats:
    """Straight from the first of two values (2, ...) to the second, at `shares` (N,)."""
    between: Floats = values[0] + shares.reshape(-1, *[1] * (values.ndim - 1)) * (values[1] - values[0])
    return between
