"""Ways of steering: who walks straight, who looks round with the mouse, who flips keys."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RootState
from elbowroom.experiment.bench.steer_scenes import KEY_FLIPS, STOP_AND_GO, STRAFING, Steer, mouse_look
from elbowroom.experiment.gauntlet.line import CourseLine
from elbowroom.experiment.gauntlet.user import CourseUser
from elbowroom.experiment.scripted_user import ScriptedUser
from elbowroom.planning.command import Command

Floats = NDArray[np.float64]
Hand = Callable[[float, RootState, bool], Command]  # seconds since the start, where the avatar is, whether it is stuck


@dataclass(frozen=True, eq=False)
class Way:
    """Where a user means to go."""

    route: Floats  # (m, 2) x and z, metres
    line: CourseLine | None = None  # of a random course


def _straight(way: Way, rng: np.random.Generator, dt: float) -> Hand:
    """W is held, along the line of a course; who is stuck backs up and tries again."""
    if way.line is not None:
        user = CourseUser(way.line, rng)
        return lambda _, root, stuck: user.command(root, stuck, dt)
    walker = ScriptedUser(rng)
    return lambda _, __, stuck: walker.command(stuck, dt)


def _steered(made: Callable[[Floats], Steer]) -> Callable[[Way, np.random.Generator, float], Hand]:
    def hand(way: Way, rng: np.random.Generator, dt: float) -> Hand:
        del dt
        steer, begins = made(way.route), float(rng.uniform(0.0, 3.0))
        return lambda time, root, _: steer(begins + time, root.x, root.z)

    return hand


def _looking(way: Way, rng: np.random.Generator, dt: float) -> Hand:
    del rng, dt
    steer = mouse_look(way.route)
    return lambda time, root, _: steer(time, root.x, root.z)


HANDS: dict[str, Callable[[Way, np.random.Generator, float], Hand]] = {
    "straight": _straight,
    "mouse look": _looking,
    "key flips": _steered(KEY_FLIPS),
    "stop and go": _steered(STOP_AND_GO),
    "strafing": _steered(STRAFING),
}
