"""Goal functions GF_x(t): the configuration a group would like to have at each key time (paper, section 4.2).

They guide the search (soft constraint); obstacles overrule them. The paper's two kinds: fixed (the waist, upright) and
periodic (an arm, swinging with the stride).
"""

from collections.abc import Mapping
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body.dof import LOCAL_GROUPS, DofGroup
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.planning.root_path import RootPath

Floats = NDArray[np.float64]


_ABDUCTION = 1  # component of an arm
_LIFT = 0.25  # radians for each m/s to the side
_SLIGHT = 0.05  # m/s: below, it sets in gently


class GoalFunction(Protocol):
    """Gives a group's goal configurations along a root path."""

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

    Who steps sideways spreads the legs, and keeps the hands off them.
    """

    def goals(path: RootPath) -> Floats:
        found = np.array(motions.goal(group, path.states[:, 6], path.states[:, 3]), np.float64)
        if group is not DofGroup.WAIST:
            found[:, _ABDUCTION] += _LIFT * (np.hypot(path.states[:, 4], _SLIGHT) - _SLIGHT)
        return found

    return goals


def natural_walk(motions: MotionSet = STOCK) -> Mapping[DofGroup, GoalFunction]:
    """The goal functions of the paper's system: waist upright, arms swinging; or both as a recorded walk has them."""
    return {
        group: fixed_goal(np.zeros(group.size))
        if group is DofGroup.WAIST and motions.swing is None
        else periodic_goal(group, motions)
        for group in LOCAL_GROUPS
    }


def goal_configurations(goals: Mapping[DofGroup, GoalFunction], path: RootPath) -> Floats:
    """The goals of all local groups side by side: (n+1, 11) waist, left arm, right arm."""
    return np.concatenate([goals[group](path) for group in LOCAL_GROUPS], axis=1)
