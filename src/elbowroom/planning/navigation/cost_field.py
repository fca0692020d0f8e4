"""How far it is to a place from everywhere near the way: Dijkstra's search (Numer. Math. 1, 1959) from that place.

Costs are metres, dearer where there is little room, where it is steep, and where one has to duck. Who is led off the
way by what stands or moves is still told where to go on.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference
from elbowroom.jit import brief_exact_kernel, exact_kernel, helper, inner_exact_kernel, plain
from elbowroom.planning.grid_moves import MOVES, STRAIGHT
from elbowroom.planning.heap import pop, push
from elbowroom.planning.navigation.surfaces import Surfaces, beside, onto
from elbowroom.world.ground.ground import EVEN_STAIR

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Points = NDArray[np.int32]

_EMPTY = plain(0)  # size of a heap
_ON_STAIR = 0.3  # metres that are looked ahead on what is steeper than an even stair
_BETTER = 1e-9  # metres by which a cost must be less to count


class MetrePrices(NamedTuple):
    """What a metre costs."""

    slim: float  # metres of room without which there is no way
    roomy: float = 0.42  # metres of room that cost nothing extra
    tight: float = 4.0  # extra for each metre that is walked where there is only `slim`
    headroom: float = 0.15  # metres to what hangs low: with less one ducks
    ducked: float = 2.0  # extra for each metre that is walked so
    stair: float = EVEN_STAIR  # metres up or down in a metre that cost nothing extra: an even stair's
    steep: float = 12.0  # extra for each metre that is walked where it is steeper by one: on the outside of a spiral


class CostField(NamedTuple):
    """Costs to a place from the N places of a map."""

    cost: Floats  # (N,) metres; infinite where there is no way or nobody looked
    onward: Points  # (N,) the place to go on to; -1 at the place itself and where there is no way


@by_reference
class Costly(NamedTuple):
    """Places, the room at each, and what a metre costs."""

    surfaces: Surfaces
    room: Floats32  # (N,) metres
    above: Floats32  # (N,) metres
    steep: Floats32  # (N,) metres up or down in a metre
    prices: MetrePrices


@inner_exact_kernel
def price_at(costly: Costly, n: int) -> float:
    """What a metre costs at a place; infinite where there is no way."""
    here, prices = costly.room[n], costly.prices
    if here < prices.slim:
        return np.inf
    narrow = min(max((prices.roomy - here) / (prices.roomy - prices.slim), 0.0), 1.0)
    ducked = prices.ducked if costly.above[n] < prices.headroom else 0.0
    steeper = max(costly.steep[n] - prices.stair, 0.0)
    return float(1.0 + prices.tight * narrow * narrow + prices.steep * steeper * steeper + ducked)


@exact_kernel
def field_to(costly: Costly, goal: int, start: int, beyond: float) -> CostField:
    """The costs to the place `goal` of all that cost no more than `start` does, and `beyond` metres."""
    surfaces, count = costly.surfaces, costly.room.shape[0]
    cost, onward = np.full(count, np.inf), np.full(count, -1, np.int32)
    done = np.zeros(count, np.bool_)
    keys, nodes = np.empty(4 * count + 64), np.empty(4 * count + 64, np.int64)
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
        own = price_at(costly, node)
        for m in range(MOVES.shape[0]):
            after = beside(surfaces, node, MOVES[m, 0], MOVES[m, 1])
            if after < 0 or done[after]:
                continue
            mean = 0.5 * (own + price_at(costly, after))
            if m >= STRAIGHT:
                mean = max(mean, _between(costly, node, m))
            total = reached + mean * surfaces.cell * np.hypot(MOVES[m, 0], MOVES[m, 1])
            if total < cost[after] - _BETTER and size < keys.shape[0]:
                cost[after], onward[after] = total, node
                size = push(keys, nodes, size, total, after)
    for node in range(count):
        if not done[node]:
            cost[node], onward[node] = np.inf, -1
    return CostField(cost, onward)


@helper
def _between(costly: Costly, node: int, m: int) -> float:
    """The dearer of the two places that a move passes between."""
    a, b = MOVES[m, 0], MOVES[m, 1]
    half_a, half_b = int(a / 2), int(b / 2)
    first = beside(costly.surfaces, node, half_a, half_b)
    other = beside(costly.surfaces, node, a - half_a, b - half_b)
    if min(first, other) < 0:
        return np.inf
    return max(price_at(costly, first), price_at(costly, other))


@brief_exact_kernel
def aim_from(field: CostField, costly: Costly, node: int, i: float, j: float, far: float) -> int:
    """The place to walk straight to from `node`, next to row `i` and column `j`: the farthest on the way within sight.

    In sight is what lies within `far` metres along the way, and to which the straight line costs no more than the
    way does. On a steep stair the next place always is, and one looks no farther than a pace, so that corners follow
    the treads. -1 where no way is known.
    """
    cost, onward, surfaces = field.cost, field.onward, costly.surfaces
    if not np.isfinite(cost[node]):
        return -1
    height, first, begin, aim, walked = surfaces.heights[node], cost[node], node, node, 0.0
    while onward[node] >= 0 and walked < far:
        after = onward[node]
        here, there, columns = surfaces.points[node], surfaces.points[after], surfaces.columns
        walked += surfaces.cell * np.hypot(there // columns - here // columns, there % columns - here % columns)
        node = after
        steep, dear = costly.steep[node] > costly.prices.stair, first - cost[node] + surfaces.cell
        if (steep and aim == begin) or straight_cost(costly, (i, j), height, node) <= dear:
            aim = node
        if steep and walked >= _ON_STAIR:
            break
    return int(aim)


@exact_kernel
def straight_cost(costly: Costly, start: tuple[float, float], height: float, end: int) -> float:
    """What the straight way costs from a row and column at a height to a place; infinite where it leads elsewhere."""
    surfaces = costly.surfaces
    columns = surfaces.columns
    rows = (surfaces.starts.shape[0] - 1) // columns
    di, dj = surfaces.points[end] // columns - start[0], surfaces.points[end] % columns - start[1]
    length = np.hypot(di, dj)
    steps = max(int(np.ceil(length)), 1)
    total, node = 0.0, -1
    for k in range(1, steps + 1):
        t = k / steps
        i = min(max(round(start[0] + t * di), 0), rows - 1)
        j = min(max(round(start[1] + t * dj), 0), columns - 1)
        node = onto(surfaces, int(i) * columns + int(j), height)
        if node < 0:
            return np.inf
        height = surfaces.heights[node]
        total += price_at(costly, node)
    return float(total * surfaces.cell * length / steps) if node == end else np.inf
