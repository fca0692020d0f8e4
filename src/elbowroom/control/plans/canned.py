"""The canned walk: what games show, and what assistance is compared with."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.result import LocalPlan, PlanStatus
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]


def canned_walk(path: RootPath, start: Floats, motions: MotionSet = STOCK) -> LocalPlan:
    """The goal functions' upper-body motion along a root path, from `start` (LOCAL,) on, whatever it touches."""
    goals = natural_walk(motions)(path)
    configurations = goals.copy()
    configurations[0] = start
    return LocalPlan(PlanStatus.FOUND, configurations, goals, ())


def standing_posture(root: Floats) -> Floats:
    """The relaxed upper body (LOCAL,) of somebody who stands at root state (7,)."""
    posture: Floats = natural_walk()(RootPath(0.0, 1.0, np.stack([root, root])))[0]
    return posture
