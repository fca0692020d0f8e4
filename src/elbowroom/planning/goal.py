"""Goal functions GF_x(t): the configuration a group would like to have at each key time (paper, section 4.2).

They guide the search (soft constraint); obstacles overrule them. The paper's two kinds: fixed (the waist, upright) and
periodic (an arm, swinging with the stride). The head looks where the root goes (`gaze`).
"""

from collections.abc import Mapping
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body import dof
from elbowroom.body.clips.stock_clips import HANGING, arm_swing, swing_into
from elbowroom.body.dof import ARMS, LOCAL, LOCAL_GROUPS, DofGroup, clamp, columns_of
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.jit import exact_kernel
from elbowroom.planning.gaze import look
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]

_ABDUCTION = 1  # component of an arm
_LIFT = 0.25  # radians for each m/s to the side
_SLIGHT = 0.05  # m/s: below, it sets in gently
_TURN = 1  # component of the head
_LEFT_ARM, _RIGHT_ARM = (columns_of(arm).start for arm in ARMS)
_HEAD = columns_of(DofGroup.HEAD).start


class GoalFunction(Protocol):
    """Gives the goal configurations of a group, or of all local groups, along a root path."""

    def __call__(self, path: RootPath) -> Floats:
        """Goal configurations (n+1, d) at the path's key times, radians."""


def fixed_goal(configuration: ArrayLike) -> GoalFunction:
    """Always the same configuration (d,)."""
    fixed = np.array(configuration, np.float64)

    def goals(path: RootPath) -> Floats:
        return fixed[None].repeat(len(path.states), axis=0)

    return goals


def periodic_goal(group: DofGroup, motions: MotionSet = STOCK) -> GoalFunction:
    """The swing of `group`, in time with the gait phase, as wide as the speed asks for; at rest at standstill.

    Who steps sideways spreads the legs, and keeps the hands off them. The head turns to where the root goes besides.
    """

    def goals(path: RootPath) -> Floats:
        found = np.array(motions.goal(group, path.states[:, 6], path.states[:, 3]), np.float64)
        if group.is_arm:
            found[:, _ABDUCTION] += _LIFT * (np.hypot(path.states[:, 4], _SLIGHT) - _SLIGHT)
        if group is DofGroup.HEAD:
            found[:, _TURN] += [look(path.states, path.interval, n) for n in range(len(found))]
            found = clamp(group, found)
        return found

    return goals


def side_by_side(goals: Mapping[DofGroup, GoalFunction]) -> GoalFunction:
    """The goals of all local groups, as one function of configurations (n+1, LOCAL): `LOCAL_GROUPS`."""

    def together(path: RootPath) -> Floats:
        return dof.side_by_side({group: goals[group](path) for group in LOCAL_GROUPS})

    return together


def natural_walk(motions: MotionSet = STOCK) -> GoalFunction:
    """The goals of all local groups (n+1, LOCAL) as in the paper: waist upright, arms swinging, the head ahead;
    or as a recorded walk or a style has them."""
    if not motions.is_stock_walk:
        return side_by_side({group: periodic_goal(group, motions) for group in LOCAL_GROUPS})
    starts, cubics = arm_swing(DofGroup.LEFT_ARM).cubics

    def together(path: RootPath) -> Floats:
        return _stock_walk(starts, cubics, HANGING, path.states, path.interval)

    return together


@exact_kernel
def _stock_walk(starts: Floats, cubics: Floats, hanging: Floats, states: Floats, interval: float) -> Floats:
    """An upright waist and the `periodic_goal` of head and arms in the stock swing, (n+1, LOCAL) at states (n+1, 7)."""
    out = np.zeros((states.shape[0], LOCAL))
    for n in range(states.shape[0]):
        forward, lateral, phase = states[n, 3], states[n, 4], states[n, 6]
        lift = _LIFT * (np.hypot(lateral, _SLIGHT) - _SLIGHT)
        out[n, _HEAD + _TURN] = look(states, interval, n)
        for arm, ahead in ((_LEFT_ARM, 0.0), (_RIGHT_ARM, 0.5)):
            swing_into(starts, cubics, hanging, phase + ahead, forward, out[n, arm:])
            out[n, arm + _ABDUCTION] += lift
    return out
