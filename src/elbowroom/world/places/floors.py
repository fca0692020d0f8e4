"""The floors of a place: heights at which there is room to stand, and where on each one can walk."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.places.columns import Columns

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

HEADROOM = 1.8  # metres: with less above it nobody stands upright
SLIM = 0.2  # metres: the half width of somebody who walks
_TREAD = 0.03  # metres: what is so little higher or lower is the same floor
_SAME = 0.1  # metres: levels closer than this are one
_APART = 0.3
_LEAST_AREA, _LEAST_SHARE = 1.0, 0.03  # m², and share of the largest: less is a table, not a floor
_LEAST_WALK = 0.5  # m² that can be walked on
_MOST_FLOORS = 16
_ENOUGH = 0.5  # share of the largest floor that the lowest must have to be walked on
_OVER_ROOMS = 0.25  # share of what is walkable on a roof
_ALL_ROUND = np.ones((3, 3), bool)


@dataclass(frozen=True, eq=False)
class Floor:
    """One level of a place."""

    height: float  # metres
    there: Flags  # (nx, nz) whether there is a floor
    blocked: Flags  # (nx, nz) whether something stands on it
    room: Floats  # (nx, nz) metres to the nearest edge or obstacle; 0 where nobody can be
    columns: Columns

    @cached_property
    def walkable(self) -> Flags:
        """(nx, nz) where a slim body may be on its way."""
        from scipy import ndimage  # slow to import, and not needed on a plain

        middles = self.room >= SLIM
        reached: Flags = ndimage.distance_transform_edt(~middles) * self.columns.cell <= SLIM
        return reached & (self.room > 0.0) if middles.any() else middles

    @property
    def area(self) -> float:
        """Of what is walkable, m²."""
        return float(self.walkable.sum()) * self.columns.cell**2

    def regions(self) -> tuple[NDArray[np.int32], list[float]]:
        """Numbers (nx, nz) from 1 of the regions that hang together for a slim body, and their sizes in m²."""
        from scipy import ndimage  # slow to import, and not needed on a plain

        numbers, count = ndimage.label(self.room >= SLIM, _ALL_ROUND)
        sizes = np.bincount(numbers.reshape(-1), minlength=count + 1)[1:]
        return numbers, (sizes * self.columns.cell**2).tolist()


def floors_of(columns: Columns) -> tuple[Floor, ...]:
    """The floors from the lowest to the highest; none where nobody can stand."""
    found = (floor_at(columns, height) for height in sorted(_levels(columns)))
    return tuple(floor for floor in found if floor.area >= _LEAST_WALK)


def floor_at(columns: Columns, height: float) -> Floor:
    """The floor at a height, whatever there is of it."""
    from scipy import ndimage  # slow to import, and not needed on a plain

    there = columns.grid(columns.level & (np.abs(columns.low - height) <= _TREAD))
    stands = (columns.high > height + _TREAD) & (columns.low < height + HEADROOM)
    blocked = columns.grid(stands | (columns.inside & (np.abs(columns.low - height) <= _TREAD)))
    free = np.pad(there & ~blocked, 1)
    distance = ndimage.distance_transform_edt(free)[1:-1, 1:-1] - 0.5
    return Floor(height, there, blocked, np.maximum(distance, 0.0) * columns.cell, columns)


def ground_floor(floors: tuple[Floor, ...]) -> Floor | None:
    """The lowest floor that is at least half as large as the largest; None without floors.

    Roofs do not count, where there is anything else: over a furnished room, or one of thick walls, they are larger.
    """
    standing = standing_surfaces(floors[0].columns) if floors else None
    inside = [floor for floor in floors if standing is not None and not _is_roof(floor, standing)] or floors
    areas = [floor.area for floor in inside]
    largest = max(areas, default=0.0)
    return next((floor for floor, area in zip(inside, areas, strict=True) if area >= _ENOUGH * largest), None)


def _is_roof(floor: Floor, standing: Flags) -> bool:
    """Whether one could stand below much of what is walkable on a floor, and nothing is above that."""
    columns = floor.columns
    covered = columns.grid(columns.low > floor.height + _SAME)
    over_a_room = columns.grid(standing & (columns.low < floor.height - HEADROOM))
    roof = floor.walkable & over_a_room & ~covered
    return bool(roof.sum() > _OVER_ROOMS * floor.walkable.sum())


def _levels(columns: Columns) -> Iterator[float]:
    """Heights at which there is room to stand, the most spacious first."""
    from scipy import ndimage  # slow to import, and not needed on a plain

    stood = standing_surfaces(columns) & _uncovered(columns)
    cells, steps = columns.cells[stood], np.round(columns.low[stood] / 0.01).astype(np.int64)
    if not len(steps):
        return
    first, least_area = int(steps.min()), 0.0
    counts = np.bincount(steps - first).astype(np.float64)
    left = np.ones(len(counts), bool)
    reach, apart = round(_SAME / 0.01), round(_APART / 0.01)
    for _ in range(_MOST_FLOORS):
        around = ndimage.uniform_filter1d(np.where(left, counts, 0.0), 2 * reach + 1, mode="constant")
        best = int(np.argmax(around))
        window = slice(max(best - reach, 0), best + reach + 1)
        near = np.abs(steps - first - best) <= reach
        area = len(np.unique(cells[near & left[steps - first]])) * columns.cell**2
        least_area = max(least_area, _LEAST_AREA, _LEAST_SHARE * area)
        if area < least_area:
            return
        yield 0.01 * (first + window.start + int(np.argmax(np.where(left, counts, 0.0)[window])))
        left[max(best - apart, 0) : best + apart + 1] = False


def _uncovered(columns: Columns) -> Flags:
    """The surfaces (S,) that no other level one lies on: of boards on boards the topmost is stood on."""
    close = (columns.cells[1:] == columns.cells[:-1]) & (columns.low[1:] - columns.low[:-1] <= _SAME)
    return np.append(~(close & columns.level[1:]), True)[: len(columns.cells)]


def standing_surfaces(columns: Columns, headroom: float = HEADROOM) -> Flags:
    """The level surfaces with so much room above, metres: nothing from a little above them up to that, nor a solid."""
    cells, low, high = columns.cells, columns.low, columns.high
    tall = float(np.max(high, initial=0.0) - np.min(low, initial=0.0)) + 1.0
    reached = np.maximum.accumulate(np.append(-np.inf, high + cells * tall))[:-1] - cells * tall  # from below, by now
    free: Flags = columns.level & ~columns.inside & (reached <= low + _SAME)
    for ahead in range(1, len(cells)):
        near = (cells[ahead:] == cells[:-ahead]) & (low[ahead:] - low[:-ahead] < headroom)
        if not near.any():
            break
        free[:-ahead] &= ~(near & (high[ahead:] - low[:-ahead] > _SAME))
    return free
