"""Ways of steering: who walks straight, who looks round with the mouse, who flips keys, who visits places."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RootState
from elbowroom.control.controller import FORWARD, Controller
from elbowroom.control.journey import Journey
from elbowroom.experiment.bench.steer_scenes import KEY_FLIPS, STOP_AND_GO, STRAFING, Steer, mouse_look
from elbowroom.experiment.crossing import DT
from elbowroom.experiment.gauntlet.line import CourseLine
from elbowroom.experiment.gauntlet.user import CourseUser
from elbowroom.experiment.scripted_user import ScriptedUser
from elbowroom.experiment.tour.targets import random_targets
from elbowroom.planning.command import Command
from elbowroom.planning.navigation.way import NoWayError, Place

Floats = NDArray[np.float64]
Hand = Callable[[float, RootState, bool], Command]  # seconds since the start, where the avatar is, whether it is stuck

TOUR = "tour"
_VISITS = 100  # places of a tour, at most


@dataclass(frozen=True, eq=False)
class UsersWay:
    """Where a user means to go."""

    route: Floats  # (m, 2) x and z, metres
    line: CourseLine | None = None  # of a random course


Made = Callable[[UsersWay, Controller, np.random.Generator], Hand]


def _straight(way: UsersWay, controller: Controller, rng: np.random.Generator) -> Hand:
    """W is held, along the line of a course; who is stuck backs up and tries again."""
    del controller
    if way.line is not None:
        user = CourseUser(way.line, rng)
        return lambda _, root, stuck: user.command(root, stuck, DT)
    walker = ScriptedUser(rng)
    return lambda _, __, stuck: walker.command(stuck, DT)


def _steered(made: Callable[[Floats], Steer]) -> Made:
    def hand(way: UsersWay, controller: Controller, rng: np.random.Generator) -> Hand:
        del controller
        steer, begins = made(way.route), float(rng.uniform(0.0, 3.0))
        return lambda time, root, _: steer(begins + time, root.x, root.z)

    return hand


def _looking(way: UsersWay, controller: Controller, rng: np.random.Generator) -> Hand:
    del controller, rng
    steer = mouse_look(way.route)
    return lambda time, root, _: steer(time, root.x, root.z)


class _Tour:
    """Goes to one random place after the other, by the way that the map knows."""

    def __init__(self, way: UsersWay, controller: Controller, rng: np.random.Generator) -> None:
        del way
        root, self._navigator, self._interval = controller.root, controller.navigator, controller.settings.interval
        here = float(root.x), float(root.height), float(root.z)
        self._targets = random_targets(self._navigator, here, _VISITS, int(rng.integers(2**31)))
        self._journey: Journey | None = None

    def __call__(self, time: float, root: RootState, stuck: bool) -> Command:
        here, plans = (float(root.x), float(root.height), float(root.z)), int(time / self._interval)  # one for each
        while self._targets and (self._journey is None or not self._journey.walking):
            self._journey = self._set_out(here, self._targets.pop())
        return Command() if self._journey is None else self._journey.command(root, DT, stuck=stuck, plans=plans)

    def _set_out(self, here: Place, target: Place) -> Journey | None:
        try:
            return Journey(self._navigator, self._navigator.find(here, target), FORWARD)
        except NoWayError:
            return None  # from where it stands now


# Each of `spec.STEERING`.
HANDS: dict[str, Made] = {
    "straight": _straight,
    "mouse look": _looking,
    "key flips": _steered(KEY_FLIPS),
    "stop and go": _steered(STOP_AND_GO),
    "strafing": _steered(STRAFING),
    TOUR: _Tour,
}
