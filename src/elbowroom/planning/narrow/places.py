"""Where a way is narrow: things stand to both sides of it. A wall ahead makes no way narrow, nor does one beside."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, inner_exact_kernel
from elbowroom.planning.narrow.build import Build
from elbowroom.world.obstacles.free_map import CELL, EVERY_LEVEL, FreeMap, Levels, Window

Floats = NDArray[np.float64]
Pair = tuple[float, float]  # x and z

EVERY = 0.05  # metres between places that are looked at
MARGIN = 0.075  # metres that people like to leave on either side
_TOUCH = 0.03  # metres: what is nearer than this to a look is met
_COARSE = 0.01  # metres that the map says too much hard by a wall
_LOOKS = 24  # to a side
_BODY = 0.5  # of the least half breadth: where what stands is nearer than that nobody goes


class NarrowPlaces:
    """Finds narrow places for one body among what stands."""

    def __init__(self, build: Build, free_map: FreeMap) -> None:
        self.build, self._map = build, free_map
        self.half = build.swinging + MARGIN  # metres: half the distance of two things between which nobody minds any

    def on(self, ways: Floats, height: float) -> Floats:
        """The narrow ones (K, 3) of ways (N, 4): places x, z and half the distance of what stands to both sides.

        A way has a place and the direction in which one walks there, a unit vector. To the first one comes from a
        `height`.
        """
        return _narrow_ones(self.window(ways, height), self.build, self.half, ways)

    def window(self, ways: Floats, height: float) -> Window:
        """The part of the map beside ways (N, 4), as far as a gap is broad, between elbows and shoulders."""
        return self.around(ways, height, 2.0 * self.half, (self.build.low, self.build.high))

    def around(self, ways: Floats, height: float, aside: float, levels: Levels = EVERY_LEVEL) -> Window:
        """The part of the map that is no farther than so many metres from ways (N, 4), on some levels."""
        low, high = ways[:, :2].min(axis=0) - aside, ways[:, :2].max(axis=0) + aside
        return self._map.window(low, high, (float(ways[0, 0]), height, float(ways[0, 1])), levels)


@exact_kernel
def _narrow_ones(window: Window, build: Build, half: float, ways: Floats) -> Floats:
    out, count, far = np.empty((ways.shape[0], 3)), 0, 2.0 * half
    for n in range(ways.shape[0]):
        place, across = (ways[n, 0], ways[n, 1]), (ways[n, 3], -ways[n, 2])
        inside = free_at(window, build, place[0], place[1]) < _BODY * build.slim
        left = far if inside else beside(window, build, place, across, far)
        if left < far:
            both = left + beside(window, build, place, (-across[0], -across[1]), far - left)
            if both < far:
                out[count, 0], out[count, 1], out[count, 2] = ways[n, 0], ways[n, 1], 0.5 * both
                count += 1
    return out[:count].copy()


@exact_kernel
def beside(window: Window, build: Build, place: tuple[float, float], aside: tuple[float, float], far: float) -> float:
    """Metres from a place in the direction `aside` to what stands there; `far` if that is farther.

    Each look leads as far on as nothing is near.
    """
    gone = 0.0
    for _ in range(_LOOKS):
        free = free_at(window, build, place[0] + gone * aside[0], place[1] + gone * aside[1])
        if free < _TOUCH:
            return float(min(gone + max(free - _COARSE, 0.0), far))
        gone += free
        if gone >= far:
            break
    return far


@inner_exact_kernel
def free_at(window: Window, build: Build, x: float, z: float) -> float:
    """The free distance at a place, bilinear, at the levels of a build; the window's edge holds outside."""
    least = np.inf
    for n in range(build.low, build.high):
        least = min(least, free_on(window, n, x, z))
    return float(least)


@inner_exact_kernel
def free_on(window: Window, level: int, x: float, z: float) -> float:
    """The free distance at a place on one level of the map, bilinear; the window's edge holds outside."""
    free = window.distances[level - window.lowest]
    p = min(max((x - window.x) / CELL, 0.0), free.shape[0] - 1.0)
    q = min(max((z - window.z) / CELL, 0.0), free.shape[1] - 1.0)
    i, k = min(int(p), free.shape[0] - 2), min(int(q), free.shape[1] - 2)
    u, v = p - i, q - k
    low = free[i, k] * (1.0 - v) + free[i, k + 1] * v
    high = free[i + 1, k] * (1.0 - v) + free[i + 1, k + 1] * v
    return float(low * (1.0 - u) + high * u)
