"""The planners of upper-body motion by name: one registry for controller, experiments, command line and page."""

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.errors import InputError
from elbowroom.planning.exact.planner import ExactPlanner
from elbowroom.planning.names import EXACT, FIGURE6
from elbowroom.planning.paper.local_planner import LocalPlanner
from elbowroom.planning.result import LocalPlan
from elbowroom.planning.root.path import RootPath
from elbowroom.world.scene import Scene


class Planner(Protocol):
    """Finds upper-body motion for root paths; it may learn from plan to plan."""

    def reset(self) -> None:
        """Forget all plans made: equal calls from here on give equal plans."""

    def plan(self, path: RootPath, start: NDArray[np.float64], rng: np.random.Generator) -> LocalPlan:
        """Motion along `path` that begins at `start` (11,): waist, left arm, right arm, radians."""


class PlannerFactory(Protocol):
    """Makes a planner; both planners' classes are such."""

    def __call__(self, humanoid: Humanoid, scene: Scene, *, motions: MotionSet = ...) -> Planner:
        """A new planner for a humanoid in a scene that has learnt `motions`."""


PLANNERS: dict[str, PlannerFactory] = {
    EXACT: ExactPlanner,
    FIGURE6: LocalPlanner,
}


def make_planner(name: str, humanoid: Humanoid, scene: Scene, motions: MotionSet = STOCK) -> Planner:
    """A new planner of this name for a humanoid in a scene. Raises `InputError` if there is none of this name."""
    if name not in PLANNERS:
        raise InputError(f"planner {name[:40]!r} is unknown; there are {', '.join(PLANNERS)}")
    return PLANNERS[name](humanoid, scene, motions=motions)
