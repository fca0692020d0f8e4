"""Places to visit, drawn from all that can be reached."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.planning.navigation.way import Place, Spot

_APART = 1.0  # metres from one target to the next, at least, where there is so much room
_DRAWS = 50  # to get as far apart


def random_targets(navigator: Navigator, start: Place | Spot, count: int, seed: int) -> list[Place]:
    """Places that can be reached from a start, each about as likely; raises `InputError` where none can."""
    places = navigator.room().places[navigator.reachable(start)]
    if not len(places):
        raise InputError(f"tour: nothing can be reached from the start at {start[0]:.2f}, {start[-1]:.2f}")
    rng, targets, last = np.random.default_rng([seed, 7]), list[Place](), places[0]
    for _ in range(count):
        last = _next(rng, places, last)
        x, height, z = np.round(last, 3).tolist()
        targets.append((x, height, z))
    return targets


def _next(rng: np.random.Generator, places: NDArray[np.float64], last: NDArray[np.float64]) -> NDArray[np.float64]:
    found: NDArray[np.float64] = places[rng.integers(len(places))]
    for _ in range(_DRAWS):
        if np.linalg.norm(found - last) >= _APART:
            break
        found = places[rng.integers(len(places))]
    return found
