"""The canned walk: what games show, and what assistance is compared with."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.goal import goal_configurations, natural_walk
from elbowroom.planning.result import LocalPlan, PlanStatus
from elbowroom.planning.root_path import RootPath


def canned_walk(path: RootPath) -> LocalPlan:
    """The goal functions' upper-body motion along a root path as it is, whatever it touches."""
    goals = goal_configurations(natural_walk(), path)
    return LocalPlan(PlanStatus.FOUND, goals, goals, ())


def standing_posture(root: NDArray[np.float64]) -> NDArray[np.float64]:
    """The relaxed upper body (11,) of somebody who stands at root state (7,)."""
    posture: NDArray[np.float64] = canned_walk(RootPath(0.0, 1.0, np.stack([root, root]))).goals[0]
    return posture
