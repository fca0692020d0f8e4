"""Where one can stand over the points of a grid: at one height on a plain, on several floors at several.

A way leads from a place to the one over a neighbouring point that is nearest in height, no more than a step up or down.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel, helper
from elbowroom.world.ground.ground import Ground, heights_at

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

_MOST = 32  # surfaces over one point that are told apart
_SIDES = np.array([[1, 0], [0, 1], [-1, 0], [0, -1], [1, 1], [1, -1], [-1, 1], [-1, -1]])
_BETTER = 1e-9  # cells


@by_reference
class Surfaces(NamedTuple):
    """N places, those over a point from the lowest up, the points row by row."""

    columns: int  # points in a row
    cell: float  # metres between points
    step: float  # metres up or down from one to the next
    starts: Longs  # (points+1,) the first of each point
    points: Longs  # (N,) over which each lies
    heights: Floats  # (N,) metres


def one_plane(shape: tuple[int, int], cell: float) -> Surfaces:
    """A place at height 0 over each point of `shape`, rows and columns."""
    count = shape[0] * shape[1]
    return Surfaces(shape[1], cell, np.inf, np.arange(count + 1), np.arange(count), np.zeros(count))


def over_ground(
    ground: Ground, corner: tuple[float, float], shape: tuple[int, int], cell: float, headroom: float
) -> Surfaces:
    """Where the ground is over points of `shape`, rows along z and columns along x, from a corner x and z on.

    What lies less than a step, or less than the `headroom`, under other ground cannot be stood on.
    """
    starts = np.zeros(shape[0] * shape[1] + 1, np.int64)
    none = np.empty(0)
    grid = (corner[0], corner[1], cell)
    _fill(ground, grid, shape[1], headroom, starts, none, writes=False)
    np.cumsum(starts, out=starts)
    heights = np.empty(int(starts[-1]))
    _fill(ground, grid, shape[1], headroom, starts, heights, writes=True)
    points = np.repeat(np.arange(shape[0] * shape[1]), np.diff(starts))
    return Surfaces(shape[1], cell, ground.step, starts, points, heights)


@exact_kernel
def _fill(
    ground: Ground, grid: tuple[float, float, float], columns: int, headroom: float, starts: Longs, out: Floats,
    writes: bool,
) -> None:  # fmt: skip
    """Count the surfaces over each point (in `starts`, one further on), or write them to where these begin.

    The `grid` begins at x and z, its points lie so far apart.
    """
    own, (low_x, low_z, cell) = np.empty(_MOST), grid
    for point in range(starts.shape[0] - 1):
        many, count = heights_at(ground, low_x + cell * (point % columns), low_z + cell * (point // columns), own), 0
        for i in range(many):
            if i + 1 == many or own[i + 1] - own[i] >= headroom:
                own[count] = own[i]
                count += 1
        if writes:
            out[starts[point] : starts[point] + count] = own[:count]
        else:
            starts[point + 1] = count


@helper
def onto(surfaces: Surfaces, point: int, height: float) -> int:
    """The place over a point that is nearest to a height, no more than a step from it; -1 where there is none."""
    best, least = -1, surfaces.step
    for n in range(surfaces.starts[point], surfaces.starts[point + 1]):
        rise = abs(surfaces.heights[n] - height)
        if rise <= least:
            best, least = n, rise
    return best


@helper
def beside(surfaces: Surfaces, n: int, rows: int, columns: int) -> int:
    """The place that a way leads to from place `n`, so many rows and columns on; -1 where there is none."""
    i, j = surfaces.points[n] // surfaces.columns + rows, surfaces.points[n] % surfaces.columns + columns
    if not (0 <= j < surfaces.columns and 0 <= i < (surfaces.starts.shape[0] - 1) // surfaces.columns):
        return -1
    return onto(surfaces, i * surfaces.columns + j, surfaces.heights[n])


@exact_kernel
def to_edges(surfaces: Surfaces, farthest: float) -> Floats32:
    """How far each place (N,) is from the nearest edge, where no way leads on, at most `farthest` metres.

    An edge lies halfway to the point that is missing. Beyond the border of the grid it may go on.
    """
    count, columns = surfaces.points.shape[0], surfaces.columns
    rows = (surfaces.starts.shape[0] - 1) // columns
    away, edge = np.full(count, np.inf), np.empty((count, 2))
    waiting, size = np.empty(count, np.int64), 0
    queued = np.zeros(count, np.bool_)
    for n in range(count):
        i, j = surfaces.points[n] // columns, surfaces.points[n] % columns
        for side in range(8):
            a, b = i + _SIDES[side, 0], j + _SIDES[side, 1]
            if 0 <= a < rows and 0 <= b < columns and beside(surfaces, n, _SIDES[side, 0], _SIDES[side, 1]) < 0:
                apart = np.hypot(float(a - i), float(b - j))
                if apart < away[n]:
                    away[n], edge[n, 0], edge[n, 1] = apart, a, b
        if away[n] < np.inf:
            waiting[size] = n
            size += 1
            queued[n] = True
    most = farthest / surfaces.cell + 0.5
    first = 0
    while size > 0:  # a ring: each place waits at most once at a time
        n = waiting[first]
        first, size = (first + 1) % count, size - 1
        queued[n] = False
        for side in range(8):
            m = beside(surfaces, n, _SIDES[side, 0], _SIDES[side, 1])
            if m < 0:
                continue
            i, j = surfaces.points[m] // columns, surfaces.points[m] % columns
            apart = np.hypot(edge[n, 0] - i, edge[n, 1] - j)
            if apart < min(away[m], most) - _BETTER:
                away[m], edge[m, 0], edge[m, 1] = apart, edge[n, 0], edge[n, 1]
                if not queued[m]:
                    waiting[(first + size) % count] = m
                    size += 1
                    queued[m] = True
    out = np.empty(count, np.float32)
    for n in range(count):
        out[n] = min(max(away[n] - 0.5, 0.0) * surfaces.cell, farthest)
    return out
