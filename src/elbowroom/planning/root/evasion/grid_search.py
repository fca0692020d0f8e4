"""The cheapest path through a grid of places and turns, row by row, and how it is evened out.

Dynamic programming: the rows are settled one after the other, each cell once.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

_SWEEPS = 12  # of evening out
_LEAVING = 3  # rows near the start that need no more room than the start has


class GridPrices(NamedTuple):
    """What the search needs of the settings, in grid units."""

    margin: float
    swerving: float
    comfort: float
    beside: float  # for the squared number of columns
    leftward: float  # for the number of columns to the left
    shifting: float
    turning: float
    spot: float
    bodies: tuple[float, float, float]  # for a row, for each metre that legs, trunk, arms lack
    keeping: float
    ends: tuple[float, float]


@exact_kernel
def pulled_taut(clear: Floats32, shift: Floats32, path: Indices, begin: float, aside: float, slack: float) -> Floats:
    """The distances (m,) from the line of a path through cells, evened out as far as there is room beyond `slack`.

    `clear` (3, rows, columns, turns) and `shift` (rows, columns, turns) as in `Room`.
    """
    count = path.shape[0]
    middle, free, out = np.empty(count), np.empty(count), np.empty(count)
    for i in range(count):
        j, t = path[i, 0], path[i, 1]
        middle[i] = aside * (j - shift.shape[1] // 2) + shift[i, j, t]
        free[i] = max(min(clear[0, i, j, t], clear[1, i, j, t]) - slack, 0.0)
        out[i] = middle[i]
    out[0] = begin
    for _ in range(_SWEEPS):
        for i in range(1, count - 1):
            even = 0.5 * (out[i - 1] + out[i + 1])
            out[i] = min(max(even, middle[i] - free[i]), middle[i] + free[i])
    return out


@exact_kernel
def cheapest(
    clear: Floats32, standing: Floats, prices: GridPrices, begin: Indices, favoured: Indices
) -> tuple[Indices, float]:
    """Columns and turns (m, 2) of the cheapest path from the cell `begin` to the farthest row that can be reached.

    `standing` (turns,) is what a row costs in each turn; `favoured` (rows, 2) the cells that are liked.
    """
    rows, columns, turns = clear.shape[1], clear.shape[2], clear.shape[3]
    cost, parents = np.empty((rows, columns, turns)), np.empty((rows, columns, turns), np.int8)
    cost[:] = np.inf
    _turn_on_the_spot(clear[0, 0, begin[0]], prices, begin[1], cost[0, begin[0]])
    here, last = min(clear[0, 0, begin[0], begin[1]], prices.margin), 0
    while last + 1 < rows and _settle(clear, standing, prices, here, favoured, last + 1, cost, parents):
        last += 1
    least, end_j, end_t = np.inf, begin[0], begin[1]
    for j in range(columns):
        for t in range(turns):
            aside, turned = j - columns // 2, t - turns // 2
            total = cost[last, j, t] + prices.ends[0] * (aside * aside) + prices.ends[1] * (turned * turned)
            if total < least:
                least, end_j, end_t = total, j, t
    path = np.empty((last + 1, 2), np.int64)
    for i in range(last, -1, -1):
        path[i, 0], path[i, 1] = end_j, end_t
        move = parents[i, end_j, end_t]
        if i > 0:
            end_j, end_t = end_j - (move // 3 - 1), end_t - (move % 3 - 1)
    return path, least


@helper
def _turn_on_the_spot(clear: Floats32, prices: GridPrices, begin: int, cost: Floats) -> None:
    """What it costs (turns,) to begin in another turn than `begin`, where there is room for it."""
    cost[begin] = 0.0
    for side in (-1, 1):
        t = begin + side
        while 0 <= t < cost.shape[0] and clear[t] >= prices.margin + prices.swerving:
            cost[t] = cost[t - side] + prices.spot
            t += side


@helper
def _settle(
    clear: Floats32,
    standing: Floats,
    prices: GridPrices,
    here: float,
    favoured: Indices,
    i: int,
    cost: Floats,
    parents: NDArray[np.int8],
) -> bool:
    """Cost and parent of every cell of row `i`; whether any can be reached. `here` is asked for near the start."""
    reached, needed = False, here if i <= _LEAVING else prices.margin
    for j in range(clear.shape[2]):
        for t in range(clear.shape[3]):
            if clear[0, i, j, t] < needed:
                continue
            best, move = _best_move(clear, prices, i, j, t, cost)
            if best == np.inf:
                continue
            aside = j - clear.shape[2] // 2
            own = standing[t] + prices.beside * (aside * aside) + prices.leftward * max(aside, 0)
            for g in range(3):
                own += prices.bodies[g] * (prices.comfort - clear[g, i, j, t])
            if abs(favoured[i, 0] - j) <= 1 and abs(favoured[i, 1] - t) <= 1:
                own -= prices.keeping
            cost[i, j, t], parents[i, j, t] = best + own, move
            reached = True
    return reached


@helper
def _best_move(clear: Floats32, prices: GridPrices, i: int, j: int, t: int, cost: Floats) -> tuple[float, int]:
    """The cheapest path to a cell from the row before it, and by which of nine moves."""
    best, move = np.inf, 0
    for m in range(9):
        dj, dt = m // 3 - 1, m % 3 - 1
        if not (0 <= j - dj < clear.shape[2] and 0 <= t - dt < clear.shape[3]):
            continue
        narrow = min(clear[0, i, j, t], clear[0, i - 1, j - dj, t - dt])
        if dt != 0 and narrow < prices.margin + prices.swerving:
            continue
        total = cost[i - 1, j - dj, t - dt] + prices.shifting * dj * dj + prices.turning * dt * dt
        if total < best:
            best, move = total, m
    return best, move
