"""Legs between two frames as a screen shows them: hips go straight there, and each joint turns by the shortest arc.

Feet do not go straight then, as those of states in between two root states do: where they are raised quickly, by some
millimetres not.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOWERING, DofGroup
from elbowroom.body.gait.legs import leg_rotations
from elbowroom.body.pose.kinematics import BodyModel, lower_body
from elbowroom.body.pose.posing import pose_legs
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_LOWERING = LOWERING - DofGroup.ROOT.size  # its place in an upper body
SHARES = np.array([0.25, 0.5, 0.75])  # of the time between two frames, at which legs are looked at


class TurnedLegs(NamedTuple):
    """Pelvis and legs at some shares of the time between two frames."""

    states: Floats  # (N, ROOT_STATE) straight between those of the frames, seen from the place of the first
    lowerings: Floats  # (N,)
    axes: Floats32  # (C, 6, N) of the capsules


def turned_legs(model: BodyModel, roots: tuple[Floats, Floats], uppers: tuple[Floats, Floats]) -> TurnedLegs:
    """The legs at `SHARES` of the time between frames of root states (ROOT_STATE,) and upper bodies (LOCAL,)."""
    states, lowerings = np.stack(roots), np.array([upper[_LOWERING] for upper in uppers])
    states[:, :2] -= states[0, :2]
    feet, sinks = lower_body(model.gait, states, lowerings)
    turns = leg_rotations(model.leg_rest, feet, sinks, states)
    shown = quaternion.slerp(turns[0], turns[1], SHARES[:, None, None])
    rows = _between(states)
    return TurnedLegs(
        rows, _between(lowerings), pose_legs(model.figure, model.roots.posed, rows, shown, _between(sinks))
    )


def _between(values: Floats) -> Floats:
    """Straight from the first of two values (2, ...) to the second."""
    shares = SHARES.reshape(-1, *[1] * (values.ndim - 1))
    between: Floats = values[0] + shares * (values[1] - values[0])
    return between
