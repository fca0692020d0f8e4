"""Gaps in the ground that one steps over: no wider than a foot is long, with ground on both sides about as high.

Between boards, before the floor at the end of a stair, over a joint or a slot. Seen on the ground's grid: where the
middle of a square has no ground at some height, but squares on two sides of it have, the gap is spanned there; so it is
where a crack goes through a square between its neighbours. Cracks narrower than a quarter of a square are overlooked.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, inner_exact_kernel
from elbowroom.world.ground.ground import Ground, heights_at
from elbowroom.world.ground.whole_squares import is_whole

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

WIDEST = 0.32  # metres
_MOST = 8  # heights over a square that are told apart
_ROOM = 256  # squares that are spanned, at first; at least as many as `_MOST`
_AXES = np.array([[1, 0], [0, 1], [1, 1], [1, -1]])


class _Squares(NamedTuple):
    """The squares of a ground's grid, and the heights at which there is ground in the middle of each."""

    ground: Ground
    counts: Longs  # (cells,) heights of each
    heights: Floats  # (cells, _MOST)


def spans_over(ground: Ground) -> Floats:
    """Level triangles (T, 3, 3) over the gaps of some ground, each pair of them as wide as two of its squares.

    So they reach the ground beside them, which may begin anywhere in a square.
    """
    squares = _Squares(ground, *_heights(ground))
    middles, side = _spanned(squares), ground.cell
    corners = np.array([[-side, 0.0, -side], [side, 0.0, -side], [side, 0.0, side], [-side, 0.0, side]])
    spans = middles[:, None] + corners
    return np.concatenate([spans[:, [0, 1, 2]], spans[:, [0, 2, 3]]])


@exact_kernel
def _heights(ground: Ground) -> tuple[Longs, Floats]:
    """How many heights there are in the middle of each square (cells,), and which (cells, most)."""
    cells, out = ground.shape[0] * ground.shape[1], np.empty(_MOST)
    counts, heights = np.zeros(cells, np.int64), np.zeros((cells, _MOST))
    for cell in range(cells):
        x = ground.corner[0] + ground.cell * (cell // ground.shape[1] + 0.5)
        z = ground.corner[1] + ground.cell * (cell % ground.shape[1] + 0.5)
        counts[cell] = heights_at(ground, x, z, out)
        heights[cell] = out
    return counts, heights


@exact_kernel
def _spanned(squares: _Squares) -> Floats:
    """The middles (N, 3) of the squares over which gaps are spanned: x, height, z."""
    ground, found, over, out = squares.ground, 0, np.empty(_MOST), np.empty((_ROOM, 3))
    for cell in range(squares.counts.shape[0]):
        spanned = _spans_of(squares, cell, over)
        if found + spanned > out.shape[0]:
            longer = np.empty((2 * out.shape[0], 3))
            longer[:found] = out[:found]
            out = longer
        for k in range(spanned):
            out[found, 0] = ground.corner[0] + ground.cell * (cell // ground.shape[1] + 0.5)
            out[found, 1] = over[k]
            out[found, 2] = ground.corner[1] + ground.cell * (cell % ground.shape[1] + 0.5)
            found += 1
    return out[:found].copy()


@helper
def _spans_of(squares: _Squares, cell: int, over: Floats) -> int:
    """Write the heights at which gaps are spanned over a square to `over` (_MOST,); how many there are."""
    ground, spanned = squares.ground, 0
    widest = int(WIDEST / ground.cell + 1e-9) + 1
    for axis in range(_AXES.shape[0]):
        across, along = _AXES[axis]
        reach = int(widest / np.hypot(across, along))
        for a in range(1, reach):
            for b in range(1, reach - a + 1):
                one = _square_at(ground, cell, -a * across, -a * along)
                other = _square_at(ground, cell, b * across, b * along)
                if one >= 0 and other >= 0:
                    spanned = _span_between(squares, cell, (one, a), (other, b), over, spanned)
    return spanned


@inner_exact_kernel
def _span_between(
    squares: _Squares, cell: int, one: tuple[int, int], other: tuple[int, int], over: Floats, spanned: int
) -> int:
    """Add the heights at which a square is spanned from `one` beside it to the `other`, each so many squares away.

    Those of them are left out at which there is ground, or which are known: the first `spanned` of `over`. How many are
    known then.
    """
    ground, counts, heights = squares
    (first, a), (second, b) = one, other
    for i in range(counts[first]):
        for j in range(counts[second]):
            rise = heights[second, j] - heights[first, i]
            height = heights[first, i] + rise * a / (a + b)
            known = _is_near(heights[cell], counts[cell], height, ground.step)
            known = known and (a + b > 2 or _is_covered(ground, cell, height))
            known = known or _is_near(over, spanned, height, ground.step)
            if abs(rise) <= ground.step and not known and spanned < _MOST:
                over[spanned] = height
                spanned += 1
    return spanned


@inner_exact_kernel
def _square_at(ground: Ground, cell: int, rows: int, columns: int) -> int:
    """The number of a square so many rows and columns on; -1 beyond the grid."""
    wide, deep = ground.shape
    i, j = cell // deep + rows, cell % deep + columns
    return i * deep + j if 0 <= i < wide and 0 <= j < deep else -1


@helper
def _is_covered(ground: Ground, cell: int, height: float) -> bool:
    """Whether there is ground about a height all over a square: one looks where that is not known."""
    for e in range(ground.even_starts[cell], ground.even_starts[cell + 1]):
        if abs(ground.evens[e] - height) <= ground.step:
            return True
    x, z = ground.corner[0] + ground.cell * (cell // ground.shape[1]), ground.corner[1]
    z += ground.cell * (cell % ground.shape[1])
    return is_whole(ground, (x, z), height, ground.step)


@inner_exact_kernel
def _is_near(heights: Floats, count: int, height: float, step: float) -> bool:
    """Whether one of the first `count` heights is no more than a step from another."""
    found = False
    for i in range(count):
        found = found or abs(heights[i] - height) <= step
    return found
