"""Others who walk about in the same place: each goes from one random place near by to the next, and all make way."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.dataset.hands import HANDS, TOUR, Hand, UsersWay
from elbowroom.errors import InputError
from elbowroom.experiment.crossing import DT
from elbowroom.experiment.tour.targets import random_targets
from elbowroom.planning.navigation.way import Spot
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

_DRAWS = 200  # of a place to begin at
_APART, _NEAR = 1.2, 6.0  # metres to who walks and to each other at the beginning, at least; to who walks, at most


class NoRoomError(InputError):
    """There is no room for so many."""


@dataclass
class Companion:
    """One who walks there too."""

    humanoid: Humanoid
    controller: Controller
    hand: Hand
    frames: list[Frame] = field(default_factory=list)

    def step(self, time: float) -> None:
        """Go on for a frame."""
        stuck = bool(self.frames) and self.frames[-1].stuck
        self.frames.append(self.controller.step(self.hand(time, self.controller.root, stuck), DT))


class Company:
    """All who walk about one."""

    def __init__(self, walker: Controller, companions: Sequence[Companion]) -> None:
        self.companions = tuple(companions)
        self._walker = walker

    def tell(self) -> None:
        """Say to each where the others mean to go."""
        everyone = [self._walker, *(one.controller for one in self.companions)]
        if len(everyone) > 1:
            told = [controller.prediction() for controller in everyone]
            for k, controller in enumerate(everyone):
                controller.others = (*told[:k], *told[k + 1 :])

    def step(self, time: float) -> None:
        """Let all but the walker go on for a frame."""
        for one in self.companions:
            one.step(time)


def company_of(walker: Controller, humanoids: Sequence[Humanoid], scene: Scene, seed: int) -> Company:
    """So many others about a walker, begun at random places near it; raises `NoRoomError` where there are too few."""
    rng = np.random.default_rng([seed, 2])
    taken, companions = [(walker.root.x, walker.root.z)], list[Companion]()
    for humanoid in humanoids:
        controller = _begun(walker, humanoid, scene, taken, rng)
        at = controller.root.x, controller.root.z
        taken.append(at)
        companions.append(Companion(humanoid, controller, HANDS[TOUR](UsersWay(np.array([at, at])), controller, rng)))
    return Company(walker, companions)


def _begun(
    walker: Controller, humanoid: Humanoid, scene: Scene, taken: Sequence[Spot], rng: np.random.Generator
) -> Controller:
    """Somebody at a free place, apart from those that are taken, facing anywhere."""
    root, settings = walker.root, walker.settings
    for x, height, z in _places(walker, rng):
        away = math.hypot(x - root.x, z - root.z)
        if away <= _NEAR and min(math.hypot(x - a, z - b) for a, b in taken) >= _APART:
            start = RootState(x=x, z=z, heading=float(rng.uniform(-math.pi, math.pi)), height=height)
            try:
                return Controller(humanoid, scene, planner=settings.planner, seed=settings.seed, start=start)
            except InputError:
                continue  # there is room for the legs, and not for the arms
    raise NoRoomError(f"no room for {len(taken)} others near where the walk begins")


def _places(walker: Controller, rng: np.random.Generator) -> Iterator[tuple[float, float, float]]:
    here = walker.root.x, walker.root.height, walker.root.z
    yield from random_targets(walker.navigator, here, _DRAWS, int(rng.integers(2**31)))
