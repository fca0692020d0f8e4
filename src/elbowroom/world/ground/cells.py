"""Triangles over the cells of a grid: which have a part in each cell, and how low and how high that is."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, plain
from elbowroom.world.clipping import clipped
from elbowroom.world.places.floor_area import FloorArea

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Ints = NDArray[np.int32]
Longs = NDArray[np.int64]

_CELL = 0.08  # metres
_MOST_CELLS, _MOST_PARTS = 400_000, 8_000_000
_HAIR = 1e-4  # metres by which what is known of a part of a triangle is wide of it
_X, _Z, _CORNERS = plain(0), plain(2), plain(3)  # axes over the ground, and what a triangle has
_CORNERS_AT = [0, 1, 3, 4, 5, 6]  # x and z of a triangle's corners among what `planes_of` has of it


class CellGrid(NamedTuple):
    """Cells over the ground; metres."""

    corner: tuple[float, float]  # x, z
    cell: float
    shape: tuple[int, int]  # cells along x and z, numbered ix * shape[1] + iz

    @property
    def cells(self) -> int:
        """How many there are."""
        return self.shape[0] * self.shape[1]


class CellParts(NamedTuple):
    """Parts (M,) of triangles in cells."""

    cells: Ints  # in which cell each is
    triangles: Ints  # of which triangle
    bottoms: Floats32  # how low it comes there, at least
    tops: Floats32  # how high it comes there, at most


def grid_over(triangles: Floats, floor: FloorArea | None) -> CellGrid:
    """Cells over all of the triangles (T, 3, 3) and the floor, as small as their number and that of parts allows."""
    flat = triangles[:, :, [0, 2]]
    least, most = flat.min(axis=(0, 1)), flat.max(axis=(0, 1))
    if floor is not None:
        corner = np.array(floor.origin)
        least, most = np.minimum(least, corner), np.maximum(most, corner + floor.cell * np.array(floor.there.shape))
    cell = max(_CELL, float(np.sqrt(np.prod(most - least + _CELL) / _MOST_CELLS)))
    while True:
        wide, deep = (int(size / cell) + 1 for size in (most - least).tolist())
        grid = CellGrid((float(least[0]), float(least[1])), cell, (wide, deep))
        if _count(_spans(flat, grid)) <= _MOST_PARTS:
            return grid
        cell *= 2.0


def parts_of(planes: Floats, grid: CellGrid, first: int = 0) -> CellParts:
    """The parts of triangles (T, 10), as `Ground` has them and numbered from `first`, in the cells of a grid."""
    spans = _spans(planes[:, _CORNERS_AT].reshape(-1, 3, 2), grid)
    return CellParts(*_parts_in(planes, spans, _count(spans), (*grid.corner, grid.cell), grid.shape[1], first))


def cell_by_cell(parts: CellParts, grid: CellGrid) -> tuple[Longs, Longs, Floats32, Floats32]:
    """The parts of each cell together, those first that begin higher: `Ground`'s starts, members, bottoms and tops."""
    order = np.lexsort((-parts.bottoms, parts.cells))
    starts = np.concatenate([[0], np.bincount(parts.cells, minlength=grid.cells).cumsum()])
    tops = parts.tops[order]
    _raise_to_later(starts, tops)
    return starts, parts.triangles[order].astype(np.int64), parts.bottoms[order], tops


def _spans(flat: Floats, grid: CellGrid) -> Longs:
    """The first and the last cell along x, and along z, (T, 4) of triangles (T, 3, 2) seen from above."""
    low = np.floor((flat.min(axis=1) - grid.corner) / grid.cell).astype(np.int64)
    high = np.floor((flat.max(axis=1) - grid.corner) / grid.cell).astype(np.int64)
    last = np.array(grid.shape) - 1
    low, high = np.clip(low, 0, last), np.clip(high, 0, last)
    return np.ascontiguousarray(np.stack([low[:, 0], high[:, 0], low[:, 1], high[:, 1]], axis=1))


def _count(spans: Longs) -> int:
    """How many cells spans (T, 4) have together."""
    return int(((spans[:, 1] - spans[:, 0] + 1) * (spans[:, 3] - spans[:, 2] + 1)).sum())


@exact_kernel
def _parts_in(
    planes: Floats, spans: Longs, most: int, grid: tuple[float, float, float], deep: int, first: int
) -> tuple[Ints, Ints, Floats32, Floats32]:
    """What `CellParts` has of triangles that are in the cells of their spans (T, 4) if anywhere; at most `most` parts.

    `grid`: x and z of its corner, and the side of a cell. A part within `_HAIR` of a cell counts.
    """
    x, z, side = grid
    cells, numbers, count = np.empty(most, np.int32), np.empty(most, np.int32), 0
    bottoms, tops = np.empty(most, np.float32), np.empty(most, np.float32)
    for t in range(spans.shape[0]):
        for ix in range(spans[t, 0], spans[t, 1] + 1):
            for iz in range(spans[t, 2], spans[t, 3] + 1):
                corner = (x + side * ix - _HAIR, z + side * iz - _HAIR)
                _, low, high = part_in(planes[t], corner, side + 2.0 * _HAIR)
                if low <= high:
                    cells[count], numbers[count] = ix * deep + iz, first + t
                    bottoms[count], tops[count] = low - _HAIR, high + _HAIR
                    count += 1
    return cells[:count].copy(), numbers[:count].copy(), bottoms[:count].copy(), tops[:count].copy()


@exact_kernel
def _raise_to_later(starts: Longs, tops: Floats32) -> None:
    """Raise how high each part comes to the highest of those that follow it in its cell."""
    for cell in range(starts.shape[0] - 1):
        for m in range(starts[cell + 1] - 2, starts[cell] - 1, -1):
            tops[m] = max(tops[m], tops[m + 1])


@helper
def part_in(triangle: Floats, corner: tuple[float, float], side: float) -> tuple[float, float, float]:
    """The area of a triangle within a square, seen from above, and the lowest and the highest point of that part."""
    piece, other = np.zeros((8, 3)), np.zeros((8, 3))
    for i, at in enumerate((0, 3, 5)):
        piece[i, 0], piece[i, 2] = triangle[at], triangle[at + 1]
        along, aside = triangle[at] - triangle[0], triangle[at + 1] - triangle[1]
        piece[i, 1] = triangle[2] + triangle[7] * along + triangle[8] * aside
    count = clipped(piece, _CORNERS, _X, corner[0], 1.0, other)
    count = clipped(other, count, _Z, corner[1], 1.0, piece)
    count = clipped(piece, count, _X, corner[0] + side, -1.0, other)
    count = clipped(other, count, _Z, corner[1] + side, -1.0, piece)
    area, low, high = 0.0, np.inf, -np.inf
    for i in range(count):
        j = (i + 1) % count
        area += piece[i, 0] * piece[j, 2] - piece[j, 0] * piece[i, 2]
        low, high = min(low, piece[i, 1]), max(high, piece[i, 1])
    return 0.5 * abs(area), low, high
