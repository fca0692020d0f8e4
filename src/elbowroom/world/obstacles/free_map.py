"""The free distance over the ground: how far away what stands is, at every place and at several heights.

It lies in the world's frame and depends on no command, no path and no body: all planners in a place share one map.
Tiles are filled where somebody comes near, on the levels that are asked for, and stay, since what stands never moves.
What is in a tile does not depend on who filled it or when. Moving things are not in it.

Where the ground is not the plane, heights are those above the ground in the middle of a tile, of the floor that one is
on, and what is no higher than a step is left out: feet may step onto it.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.ground.ground import PLAIN, Ground, height_along
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.rows import about, is_empty

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Span = tuple[float, float]
Near = Callable[[Floats, Floats, Span], Nearby]
Start = tuple[float, float, float]
Levels = tuple[int, int]

CELL = 0.04  # metres between neighbouring points
TILE = 16  # points on a tile's side
LEVELS: Floats = 0.1 + 0.2 * np.arange(10.0)  # metres above the ground
FARTHEST = 0.7  # metres: greater distances are not told apart
_TALL = 0.06  # metres: half the height of the upright line that stands for a level
_SAME = 0.01  # metres: floors that are told apart
_ALIKE = 20  # of these: heights that are told apart where there is no floor, as far as levels are
EVERY_LEVEL = 0, len(LEVELS)
_BLOCK = 2  # tiles by tiles that windows on plain ground are made of: who walks on needs the same for a while
_WINDOWS = 8  # that are remembered
_MOST = 4096  # tiles that are remembered: 40 MB


class Window(NamedTuple):
    """A part of the map, for kernels."""

    distances: Floats32  # (levels, X, Z) metres, at most `FARTHEST`
    x: float  # of the first point, metres
    z: float
    lowest: int  # the number in `LEVELS` of the first of these levels


class FreeMap:
    """The map of one place; threads may share it."""

    def __init__(self, near: Near, ground: Ground = PLAIN) -> None:
        """`near` tells what stands over a rectangle, of which it is given the corners (2,), x and z, on some `ground`.

        What reaches into a span of heights.
        """
        self._near, self._ground = near, ground
        self._tiles: dict[tuple[int, ...], Floats32] = {}  # by row, row, floor and levels
        self._windows: dict[tuple[int, ...], Window] = {}  # by the tiles that they hold, on plain ground
        self._whole = ground.plain  # whether all levels are filled: there is little to fill, or others ask for them too

    def window(self, low: Floats, high: Floats, start: Start = (0.0, 0.0, 0.0), levels: Levels = EVERY_LEVEL) -> Window:
        """The part between two corners (2,) on the ground, x and z; it may reach a little farther.

        Of the floor that one comes to from a start (x, height, z), on the levels from the first number on and before
        the second, or on more of them: each costs as much as any other.
        """
        side, plain = CELL * TILE, self._ground.plain
        levels = EVERY_LEVEL if self._whole else levels
        block = _BLOCK if plain else 1
        first = [block * int(np.floor(edge / (block * side))) for edge in low]
        last = [block * int(np.floor(edge / (block * side))) + block - 1 for edge in high]
        ends = *first, *last
        known = self._windows.get(ends) if plain else None
        if known is not None:
            return known
        wide, deep = last[0] - first[0] + 1, last[1] - first[1] + 1
        distances = np.empty((levels[1] - levels[0], wide * TILE, deep * TILE), np.float32)
        for i in range(wide):
            for k in range(deep):
                tile = self._tile(first[0] + i, first[1] + k, start, levels)
                distances[:, i * TILE : (i + 1) * TILE, k * TILE : (k + 1) * TILE] = tile
        found = Window(distances, first[0] * side, first[1] * side, levels[0])
        if plain:
            if len(self._windows) >= _WINDOWS:
                self._windows.clear()
            self._windows[ends] = found
        return found

    def distances(self, places: Floats, height: float, floor: float = 0.0) -> Floats32:
        """How far what stands lower than `height` is from places (..., 2), x and z, to some centimetres.

        `floor` is the height of the ground at the first place. Frames ask for that, and would wait for what no plan has
        had filled: from now on all levels are.
        """
        self._whole = True
        ends = places.reshape(-1, 2)
        low, high = (edge(ends, axis=0) for edge in (np.min, np.max))
        window = self.window(low, high, (float(ends[0, 0]), floor, float(ends[0, 1])))
        cells = np.rint((places - (window.x, window.z)) / CELL).astype(np.int64)
        i, k = (np.minimum(cells[..., axis], window.distances.shape[axis + 1] - 1) for axis in (0, 1))
        found: Floats32 = window.distances[height > LEVELS][:, i, k].min(axis=0)
        return found

    def _tile(self, i: int, k: int, start: Start, levels: Levels) -> Floats32:
        """The distances (levels, TILE, TILE) of the tile in row `i` along x and row `k` along z, on some levels."""
        floor = 0 if self._ground.plain else self._floor(start, _middle(i, k))
        tile = self._tiles.get((i, k, floor, *levels))
        if tile is None:
            whole = self._tiles.get((i, k, floor, *EVERY_LEVEL))
            if whole is not None:
                return whole[slice(*levels)]
            tile = self._filled(_middle(i, k), floor * _SAME, levels)
            if len(self._tiles) >= _MOST:
                self._tiles.clear()
            self._tiles[i, k, floor, *levels] = tile
        return tile

    def _floor(self, start: Start, middle: Floats) -> int:
        """How high the ground is at a place, as one comes to it; where there is none, about as one sets out.

        Who climbs sets out from another height each time, and would have the same filled again and again.
        """
        height = height_along(self._ground, start, float(middle[0]), float(middle[1]))
        return round(height / _SAME) if np.isfinite(height) else _ALIKE * round(start[1] / (_ALIKE * _SAME))

    def _filled(self, middle: Floats, floor: float, levels: Levels) -> Floats32:
        """A tile, reckoned from its middle: so it is as exact far from the world's origin as near to it."""
        half, these = 0.5 * CELL * TILE, slice(*levels)
        least, most = floor + float(LEVELS[these][0]), floor + float(LEVELS[these][-1])
        low, high = least - _TALL - FARTHEST, most + _TALL + FARTHEST
        heights = low if self._ground.plain else max(low, floor + self._ground.step), high
        near = self._near(middle - half - FARTHEST, middle + half + FARTHEST, heights)
        if is_empty(near):
            return _OPEN[these]
        near = about(near, float(middle[0]), float(middle[1]), floor)
        points = np.ascontiguousarray(_POINTS[..., these, :]).reshape(1, 6, -1)
        return clearance(points, _THIN, near, FARTHEST).reshape(-1, TILE, TILE)


def _middle(i: int, k: int) -> Floats:
    """The middle (2,) of the tile in row `i` along x and row `k` along z."""
    middle: Floats = 0.5 * CELL * TILE * np.array([2.0 * i + 1.0, 2.0 * k + 1.0])
    return middle


def _points() -> Floats32:
    """Upright lines (6, levels, TILE TILE) at all points of a tile, seen from its middle."""
    along = CELL * (np.arange(TILE) - 0.5 * TILE)
    y, x, z = (part.reshape(len(LEVELS), -1) for part in np.meshgrid(LEVELS, along, along, indexing="ij"))
    return np.stack([x, y - _TALL, z, x, y + _TALL, z]).astype(np.float32)


_POINTS, _THIN = _points(), np.zeros(1, np.float32)
_OPEN: Floats32 = np.full((len(LEVELS), TILE, TILE), FARTHEST, np.float32)  # the tile where nothing is near
