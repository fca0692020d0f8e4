"""The planners of upper-body motion by name: one registry for controller, experiments, command line and page."""

import re
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.errors import InputError
from elbowroom.planning.exact.planner import ExactPlanner
from elbowroom.planning.names import BUILT_IN, EXACT, FIGURE6, add_planner_name, check_planner
from elbowroom.planning.paper.local_planner import LocalPlanner
from elbowroom.planning.result import LocalPlan
from elbowroom.planning.root.path import RootPath
from elbowroom.world.scene import Scene


class Planner(Protocol):
    """Finds upper-body motion for root paths; it may learn from plan to plan.

    A class with these two methods is a planner, whatever it inherits from.
    """

    def reset(self) -> None:
        """Forget all plans made: equal calls from here on give equal plans."""

    def plan(self, path: RootPath, start: NDArray[np.float64], rng: np.random.Generator) -> LocalPlan:
        """Motion along `path` that begins at `start` (LOCAL,), radians.

        It is free at the key times and between them as far as the planner looks; the controller checks every pose once
        more before it is shown, and holds the avatar where one would touch. `rng` is the only source of chance.
        """


class PlannerFactory(Protocol):
    """Makes a planner: the class of one, or a function. Whoever needs no motions ignores them."""

    def __call__(self, humanoid: Humanoid, scene: Scene, *, motions: MotionSet = ...) -> Planner:
        """A new planner for a humanoid in a scene that has learnt `motions`."""


PLANNERS: dict[str, PlannerFactory] = {
    EXACT: ExactPlanner,
    FIGURE6: LocalPlanner,
}
_NAME = re.compile(r"[a-z][a-z0-9_-]{0,39}")


def register_planner(name: str, factory: PlannerFactory) -> None:
    """From now on `Controller(planner=name)`, experiments and page know this planner too, within this process.

    `factory` makes one for an avatar in a scene. A name of one's own can be given anew. Raises `InputError` for the
    name of a planner that comes with the package, and for one that is not made of 1 to 40 small letters, digits,
    `_` and `-`, the first a letter.
    """
    if name in BUILT_IN:
        raise InputError(f"planner {name!r} comes with the package; choose another name")
    if not _NAME.fullmatch(name):
        raise InputError(f"planner {name[:40]!r}: a name is 1 to 40 small letters, digits, _ and -, the first a letter")
    PLANNERS[name] = factory
    add_planner_name(name)


def make_planner(name: str, humanoid: Humanoid, scene: Scene, motions: MotionSet = STOCK) -> Planner:
    """A new planner of this name for a humanoid in a scene. Raises `InputError` if there is none of this name."""
    check_planner(name)
    return PLANNERS[name](humanoid, scene, motions=motions)
