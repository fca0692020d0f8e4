"""Which obstacles come near a rectangle on the ground, without looking at all of them: built once for a scene.

Each obstacle lies in one cell of one grid over the ground: that of its middle, in the finest grid whose cells are as
large as it is. So whatever meets a rectangle has its middle less than half a cell outside of it, on each grid. The
cells are not kept, only the obstacles in the order of their cells: those of a row of cells lie side by side and are
found by bisection. So grids may be as wide as they like.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import brief_exact_kernel, inner_exact_kernel

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_FINEST = 1.0  # metres
_COARSER = 4.0  # times, from grid to grid
_GRIDS = 8  # the last has cells of 16 km: everything in a scene has a grid
_BITS = 24  # of a cell's number along one axis
_OFFSET = 2 ** (_BITS - 1)


class Grids(NamedTuple):
    """B bounds on the ground, in the order of their cells."""

    keys: Longs  # (B,) grid, row, column as one number, increasing
    order: Longs  # (B,) whose they are
    least: Floats  # (B, 2) x and z, metres, by number
    most: Floats  # (B, 2)


def grids_of(least: Floats, most: Floats) -> Grids:
    """The grids for bounds (B, 2) on the ground."""
    size = (most - least).max(axis=1, initial=0.0)
    level = np.ceil(np.log(np.maximum(size, _FINEST) / _FINEST) / np.log(_COARSER) - 1e-9).astype(np.int64)
    level = np.clip(level, 0, _GRIDS - 1)
    cells = np.floor(0.5 * (least + most) / (_FINEST * _COARSER**level)[:, None]).astype(np.int64) + _OFFSET
    keys = (level << (2 * _BITS)) | (cells[:, 0] << _BITS) | cells[:, 1]
    order = np.argsort(keys, kind="stable")
    return Grids(keys[order], order, np.ascontiguousarray(least), np.ascontiguousarray(most))


def meeting(grids: Grids, least: tuple[float, float], most: tuple[float, float]) -> Longs:
    """The numbers of the bounds that meet the rectangle from `least` to `most`, x and z, in their order."""
    found: Longs = np.sort(meeting_any_order(grids, least[0], least[1], most[0], most[1]))
    return found


@brief_exact_kernel
def meeting_any_order(grids: Grids, low_x: float, low_z: float, high_x: float, high_z: float) -> Longs:
    """`meeting` for kernels that do not care about the order."""
    found, count = np.empty(grids.keys.shape[0], np.int64), 0
    cell = _FINEST
    for level in range(_GRIDS):
        first_x, last_x = _cell(low_x - 0.5 * cell, cell), _cell(high_x + 0.5 * cell, cell)
        first_z, last_z = _cell(low_z - 0.5 * cell, cell), _cell(high_z + 0.5 * cell, cell)
        base = level << (2 * _BITS)
        at = _first_from(grids.keys, base | (first_x << _BITS) | first_z)
        end = base | (last_x << _BITS) | last_z
        while at < grids.keys.shape[0] and grids.keys[at] <= end:
            row = (grids.keys[at] >> _BITS) & (2 * _OFFSET - 1)
            column = grids.keys[at] & (2 * _OFFSET - 1)
            if column < first_z:
                at = _first_from(grids.keys, base | (row << _BITS) | first_z)
            elif column > last_z:
                at = _first_from(grids.keys, base | ((row + 1) << _BITS) | first_z)
            else:
                own = grids.order[at]
                across = grids.least[own, 0] <= high_x and grids.most[own, 0] >= low_x
                if across and grids.least[own, 1] <= high_z and grids.most[own, 1] >= low_z:
                    found[count] = own
                    count += 1
                at += 1
        cell *= _COARSER
    return found[:count]


@inner_exact_kernel
def _cell(coordinate: float, cell: float) -> int:
    """The number of the cell that holds a coordinate; the outermost for what is farther."""
    return int(min(max(np.floor(coordinate / cell) + _OFFSET, 0.0), 2.0 * _OFFSET - 1.0))


@inner_exact_kernel
def _first_from(keys: Longs, key: int) -> int:
    """The first of the keys that is not less."""
    low, high = 0, keys.shape[0]
    while low < high:
        middle = (low + high) // 2
        if keys[middle] < key:
            low = middle + 1
        else:
            high = middle
    return low
