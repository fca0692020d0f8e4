"""How far it is to a place from everywhere near the way: Dijkstra's search (Numer. Math. 1, 1959) from that place.

Costs are metres, dearer where there is little room, and where one has to duck. Who is led off the way by what
stands or moves is still told where to go on.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, plain
from elbowroom.planning.heap import pop, push

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Points = NDArray[np.int32]

_EMPTY = plain(0)  # size of a heap
_BETTER = 1e-9  # metres by which a cost must be less to count
_STRAIGHT = 8  # of the moves that lead to a neighbour; the others pass between two
_MOVES = np.array(
    [
        *([1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [1, -1], [-1, 1], [-1, -1]),
        *([2, 1], [2, -1], [-2, 1], [-2, -1], [1, 2], [1, -2], [-1, 2], [-1, -2]),
    ]
)


class Prices(NamedTuple):
    """What a metre costs."""

    slim: float  # metres of room without which there is no way
    roomy: float = 0.42  # metres of room that cost nothing extra
    tight: float = 4.0  # extra for each metre that is walked where there is only `slim`
    headroom: float = 0.15  # metres to what hangs low: with less one ducks
    ducked: float = 2.0  # extra for each metre that is walked so


class Field(NamedTuple):
    """Costs to a place from the points of a map."""

    cost: Floats  # (nz, nx) metres; infinite where there is no way or nobody looked
    onward: Points  # (nz, nx) the point to go on to, row by row; -1 at the place itself and where there is no way


@exact_kernel
def price_at(room: Floats32, above: Floats32, prices: Prices, i: int, j: int) -> float:
    """What a metre costs at a point; infinite where there is no way."""
    here = room[i, j]
    if here < prices.slim:
        return np.inf
    narrow = min(max((prices.roomy - here) / (prices.roomy - prices.slim), 0.0), 1.0)
    ducked = prices.ducked if above[i, j] < prices.headroom else 0.0
    return float(1.0 + prices.tight * narrow * narrow + ducked)


@exact_kernel
def field_to(
    room: Floats32, above: Floats32, cell: float, prices: Prices, goal: int, start: int, beyond: float
) -> Field:
    """The costs to the point `goal` (row by row) of all that cost no more than `start` does, and `beyond` metres."""
    rows, columns = room.shape
    cost, onward = np.full(rows * columns, np.inf), np.full(rows * columns, -1, np.int32)
    done = np.zeros(rows * columns, np.bool_)
    keys, nodes = np.empty(4 * rows * columns + 64), np.empty(4 * rows * columns + 64, np.int64)
    size, most = push(keys, nodes, _EMPTY, 0.0, goal), np.inf
    cost[goal] = 0.0
    while size > 0:
        node, reached = nodes[0], keys[0]
        size = pop(keys, nodes, size)
        if done[node]:
            continue
        if reached > most:
            break
        done[node] = True
        if node == start:
            most = reached + beyond
        i, j = node // columns, node % columns
        own = price_at(room, above, prices, i, j)
        for m in range(_MOVES.shape[0]):
            a, b = i + _MOVES[m, 0], j + _MOVES[m, 1]
            if not (0 <= a < rows and 0 <= b < columns) or done[a * columns + b]:
                continue
            mean = 0.5 * (own + price_at(room, above, prices, a, b))
            if m >= _STRAIGHT:
                mean = max(mean, _between(room, above, prices, i, j, m))
            total = reached + mean * cell * np.hypot(_MOVES[m, 0], _MOVES[m, 1])
            if total < cost[a * columns + b] - _BETTER and size < keys.shape[0]:
                cost[a * columns + b], onward[a * columns + b] = total, node
                size = push(keys, nodes, size, total, a * columns + b)
    for node in range(rows * columns):
        if not done[node]:
            cost[node], onward[node] = np.inf, -1
    return Field(cost.reshape(room.shape), onward.reshape(room.shape))


@exact_kernel
def _between(room: Floats32, above: Floats32, prices: Prices, i: int, j: int, m: int) -> float:
    """The dearer of the two points that a move passes between."""
    a, b = _MOVES[m, 0], _MOVES[m, 1]
    half_a, half_b = int(a / 2), int(b / 2)
    first = price_at(room, above, prices, i + half_a, j + half_b)
    return max(first, price_at(room, above, prices, i + a - half_a, j + b - half_b))


@exact_kernel
def aim_from(
    field: Field, room: Floats32, above: Floats32, cell: float, prices: Prices, i: float, j: float, far: float
) -> int:
    """The point (row by row) to walk straight to from a place in the grid: the farthest on the way within sight.

    In sight is what lies within `far` metres along the way, and to which the straight line costs no more than the
    way does. -1 where no way is known.
    """
    rows, columns = room.shape
    node = min(max(round(i), 0), rows - 1) * columns + min(max(round(j), 0), columns - 1)
    cost, onward = field.cost.reshape(-1), field.onward.reshape(-1)
    if not np.isfinite(cost[node]):
        return -1
    first, aim, walked = cost[node], node, 0.0
    while onward[node] >= 0 and walked < far:
        after = onward[node]
        walked += cell * np.hypot(after // columns - node // columns, after % columns - node % columns)
        node = after
        if (
            straight_cost(room, above, cell, prices, (i, j), (node // columns, node % columns))
            <= first - cost[node] + cell
        ):
            aim = node
    return int(aim)


@exact_kernel
def straight_cost(
    room: Floats32, above: Floats32, cell: float, prices: Prices, start: tuple[float, float], end: tuple[int, int]
) -> float:
    """What the straight way between two places in the grid costs."""
    di, dj = end[0] - start[0], end[1] - start[1]
    length = np.hypot(di, dj)
    steps = max(int(np.ceil(length)), 1)
    total = 0.0
    for k in range(1, steps + 1):
        t = k / steps
        i = min(max(round(start[0] + t * di), 0), room.shape[0] - 1)
        j = min(max(round(start[1] + t * dj), 0), room.shape[1] - 1)
        total += price_at(room, above, prices, i, j)
    return float(total * cell * length / steps)
