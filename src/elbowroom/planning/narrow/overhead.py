"""Where a way is low: something hangs over all of it that a head can be put beside, and one has to duck."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper
from elbowroom.planning.narrow.build import Build
from elbowroom.planning.narrow.places import NarrowPlaces, free_on
from elbowroom.world.obstacles.free_map import CELL, LEVELS, Window

Floats = NDArray[np.float64]

SPARE = 0.05  # metres above the crown that people like to have
LEAST = 0.6  # of one's height: what hangs lower is no way
_BESIDE = 0.15  # metres to either side where a head can be put
_UP = 0.06  # metres above its level from which free distances are measured
_MET = 0.10  # metres: what is nearer than this to the middle of a way on some level is in it


def low_places(narrow: NarrowPlaces, ways: Floats, height: float) -> Floats:
    """The low ones (K, 3) of ways (N, 4), as in `NarrowPlaces.on`: places x, z and how high they are, metres.

    Where nothing is met on a level that makes a way low the levels below are not looked at.
    """
    lowest = int(np.searchsorted(LEVELS, LEAST * narrow.build.tall - _UP - _MET))
    above = narrow.around(ways, height, _BESIDE + CELL, (min(lowest, len(LEVELS) - 1), len(LEVELS)))
    if not _is_met(above, ways):
        return np.empty((0, 3))
    return _low_ones(narrow.around(ways, height, _BESIDE + CELL), narrow.build, ways)


@exact_kernel
def _is_met(window: Window, ways: Floats) -> bool:
    """Whether anything is in one of the ways (N, 4) on a level of the window."""
    for n in range(ways.shape[0]):
        for side in range(-1, 2):
            aside = side * _BESIDE
            x, z = ways[n, 0] + aside * ways[n, 3], ways[n, 1] - aside * ways[n, 2]
            for level in range(window.lowest, window.lowest + window.distances.shape[0]):
                if free_on(window, level, x, z) < _MET:
                    return True
    return False


@exact_kernel
def _low_ones(window: Window, build: Build, ways: Floats) -> Floats:
    out, count = np.empty((ways.shape[0], 3)), 0
    for n in range(ways.shape[0]):
        x, z, across_x, across_z = ways[n, 0], ways[n, 1], ways[n, 3], -ways[n, 2]
        room = 0.0
        for side in range(-1, 2):
            aside = side * _BESIDE
            room = max(room, _headroom(window, x + aside * across_x, z + aside * across_z))
        if LEAST * build.tall < room < build.tall + SPARE:
            out[count, 0], out[count, 1], out[count, 2] = x, z, room
            count += 1
    return out[:count].copy()


@helper
def _headroom(window: Window, x: float, z: float) -> float:
    """How high the lowest thing over a place hangs, metres; 0 where one stands there.

    It is as far above the level below as that is free, at most up to the level on which it is.
    """
    below = 0.0
    for n in range(window.distances.shape[0]):
        free = free_on(window, n, x, z)
        if free < _MET:
            return 0.0 if n == 0 else float(min(LEVELS[n - 1] + _UP + below, LEVELS[n] + _UP + _MET))
        below = free
    return np.inf
