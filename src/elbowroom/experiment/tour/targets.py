"""Places to visit, drawn from all that can be reached."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.planning.navigation.way import Place

_APART = 1.0  # metres from one target to the next, at least, where there is so much room
_DRAWS = 50  # to get as far apart


def random_targets(navigator: Navigator, start: Place, count: int, seed: int) -> list[Place]:
    """Places that can be reached from a start, each about as likely; raises `InputError` where none can."""
    room = navigator.room()
    points = np.argwhere(navigator.reachable(start))
    if not len(points):
        raise InputError(f"tour: nothing can be reached from the start at {start[0]:.2f}, {start[1]:.2f}")
    rng, targets, last = np.random.default_rng([seed, 7]), list[Place](), np.array(start)
    for _ in range(count):
        last = _next(rng, room.places(points), last)
        targets.append((round(float(last[0]), 3), round(float(last[1]), 3)))
    return targets


def _next(rng: np.random.Generator, places: NDArray[np.float64], last: NDArray[np.float64]) -> NDArray[np.float64]:
    found: NDArray[np.float64] = places[rng.integers(len(places))]
    for _ in range(_DRAWS):
        if np.hypot(*(found - last)) >= _APART:
            break
        found = places[rng.integers(len(places))]
    return found
