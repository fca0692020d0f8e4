"""The cheapest way through a time lattice: dynamic programming, each (posture, key time) settled once.

The nodes of a depth are the V postures of a group, W with the lanes that fill up the last block, and OWN postures of
that key time alone: the goal itself, what the last plan had there, and the like. A step leads from a node to a free
node of the next depth at most `step` radians away. A node costs its own price, a step costs w |d - g|^2: the squared
change of the deviation from the goal, d being the way of the posture and g that of the goal. So a group that follows
its goal pays nothing, and evading begins and ends gently.

Written out, |b - a - g|^2 = |b - a|^2 + 2 a.g + |g|^2 - 2 b.g: the first part is a table that never changes, the others
belong to the source or to the target alone. What is left of a row is the (min, +) product of a vector with a constant
matrix, in which every target is a lane.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, exact_lean_kernel, inlined

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Ints = NDArray[np.int32]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

OWN = 4  # postures of a key time alone
GOAL, KEPT, HOLD, BACK = range(
    OWN
)  # the goal, what the last plan had, the start, on the way from the start to the goal
_ROUNDING = 1.0 + 1e-6
_SLACK = 1e-3  # squared radians: more than the rounding of a sum
_INFINITE = np.float32(np.inf)
_FIRST = 0  # lane, depth
_GLANCE = 0.25  # squared radians: how much dearer than the least prices a way may be at a glance


class Lattice(NamedTuple):
    """One group's problem along one root path. Nodes 0..W-1 are the postures, W..W+OWN-1 those of a key time alone."""

    postures: Floats  # (V, d) radians
    columns: Floats32  # (d, W) the same by components, the last repeated
    moves: Floats32  # (V, W) squared length of each step, infinite where there is none
    spans: Longs  # (V, 2) the lanes of `moves` beyond which all of a posture's steps are infinite
    own: Floats  # (n+1, OWN, d); in row 0 HOLD is the start
    goals: Floats  # (n+1, d)
    price: Floats32  # (n+1, W+OWN) of each node; infinite where it is not free; row 0 is not used
    masks: Longs  # (n,) which of `closed` holds for an interval; -1: all its steps are open
    closed: Bools  # (M, W+OWN, W+OWN) which steps are closed
    kept: Longs  # (n+1,) the nodes that the last plan had
    step: float  # radians
    weight: float  # w


class Work(NamedTuple):
    """What is known of the cheapest ways."""

    costs: Floats32  # (n+1, W+OWN) of the cheapest way from the start to each node
    parents: Ints  # (n+1, W+OWN) the node before it on that way
    left: Floats32  # (n+1, W+OWN) of the cheapest way from each node on to the end
    squares: Floats32  # (n+1, OWN, W) squared distances of a key time's own postures from the others
    most: Floats  # (2,) dearer ways were left out; what it would be after more than a glance
    least: Floats  # (n+1,) what a way on from each depth costs at least
    base: Floats32  # (W+OWN,) scratch, as is what follows
    slopes: Floats32  # (W+OWN,)
    closed: Bools  # (W,)
    origins: Ints  # (W+OWN,)
    few: Floats  # (2, OWN)


def new_work(depths: int, nodes: int) -> Work:
    """Room for a lattice with `depths` rows of `nodes` nodes."""
    return Work(
        np.empty((depths, nodes), np.float32),
        np.empty((depths, nodes), np.int32),
        np.empty((depths, nodes), np.float32),
        np.empty((depths, OWN, nodes - OWN), np.float32),
        np.zeros(2),
        np.zeros(depths),
        np.empty(nodes, np.float32),
        np.empty(nodes, np.float32),
        np.empty(nodes - OWN, np.bool_),
        np.empty(nodes, np.int32),
        np.empty((2, OWN)),
    )


@exact_lean_kernel
def component_of(lattice: Lattice, depth: int, node: int, i: int) -> float:
    """One component of the configuration of a node."""
    width = lattice.moves.shape[1]
    return float(lattice.postures[node, i] if node < width else lattice.own[depth, node - width, i])


@exact_lean_kernel
def squares_from(columns: Floats32, posture: Floats, out: Floats32) -> None:
    """The squared distances (W,) of the postures from one (d,)."""
    out[:] = 0.0
    for i in range(posture.shape[0]):
        column, place = columns[i], np.float32(posture[i])
        for v in range(np.uint64(out.shape[0])):
            out[v] += (column[v] - place) * (column[v] - place)


@exact_lean_kernel
def _measure(lattice: Lattice, work: Work) -> None:
    """Distances of each key time's own postures from all others; too long a step is infinite."""
    size, width = lattice.postures.shape[0], lattice.moves.shape[1]
    longest = np.float32(lattice.step * lattice.step * _ROUNDING)
    for depth in range(lattice.own.shape[0]):
        for e in range(OWN):
            if lattice.price[depth, width + e] == _INFINITE and (depth > 0 or e != HOLD):
                continue
            row = work.squares[depth, e]
            squares_from(lattice.columns, lattice.own[depth, e], row)
            for v in range(np.uint64(width)):
                row[v] = row[v] if row[v] <= longest else _INFINITE
            row[size:] = _INFINITE


@exact_lean_kernel
def _own_move(lattice: Lattice, depth: int, e: int, f: int) -> float:
    """The squared length of the step between own postures of two successive depths; infinite if it is too long."""
    total = 0.0
    for i in range(lattice.own.shape[2]):
        total += (lattice.own[depth + 1, f, i] - lattice.own[depth, e, i]) ** 2
    return total if total <= lattice.step * lattice.step * _ROUNDING else np.inf


@exact_lean_kernel
def _relax(out: Floats32, origins: Ints, base: float, row: Floats32, weight: float, source: int) -> None:
    """out[b] = min(out[b], base + weight row[b]), with its origin; lanes are targets."""
    start, factor, origin = np.float32(base), np.float32(weight), np.int32(source)
    for b in range(np.uint64(out.shape[0])):
        cost = start + factor * row[b]
        better = cost < out[b]
        out[b] = cost if better else out[b]
        origins[b] = origin if better else origins[b]


@exact_lean_kernel
def _relax_open(
    out: Floats32, origins: Ints, base: float, row: Floats32, weight: float, source: int, closed: Bools
) -> None:
    """`_relax` where some steps are closed."""
    start, factor, origin = np.float32(base), np.float32(weight), np.int32(source)
    for b in range(np.uint64(out.shape[0])):
        cost = _INFINITE if closed[b] else start + factor * row[b]
        better = cost < out[b]
        out[b] = cost if better else out[b]
        origins[b] = origin if better else origins[b]


@exact_lean_kernel
def slopes_of(lattice: Lattice, depth: int, row: int, out: Floats32) -> float:
    """2 w q.g into `out` (W+OWN,) for the nodes q of `row`; returns w |g|^2; g is the goal's way from `depth` on."""
    width, weight = lattice.moves.shape[1], lattice.weight
    square, known = 0.0, out[:width]
    out[:] = 0.0
    for i in range(lattice.goals.shape[1]):
        way = lattice.goals[depth + 1, i] - lattice.goals[depth, i]
        square += weight * way * way
        if way == 0.0:
            continue
        factor, column = np.float32(2.0 * weight * way), lattice.columns[i]
        for v in range(np.uint64(width)):
            known[v] += factor * column[v]
        for e in range(OWN):
            out[width + e] += factor * np.float32(lattice.own[row, e, i])
    return square


@inlined
def _settle(lattice: Lattice, work: Work, depth: int, most: float) -> int:
    """The costs of the nodes at `depth + 1` from those at `depth`, as far as they are no more than `most`; how many
    nodes have a way."""
    size, width = lattice.postures.shape[0], lattice.moves.shape[1]
    out, origins = work.costs[depth + 1], work.parents[depth + 1]
    targets, target_origins = out[:width], origins[:width]
    out[:] = _INFINITE
    base, limit = work.base, np.float32(most)
    square, known = np.float32(slopes_of(lattice, depth, depth, base)), work.costs[depth]
    for node in range(np.uint64(width + OWN)):
        base[node] = known[node] + base[node] + square if known[node] <= limit else _INFINITE
    mask = lattice.masks[depth]
    closed = lattice.closed[mask]
    for node in range(width + OWN):
        if base[node] == _INFINITE:
            continue
        row = lattice.moves[node] if node < size else work.squares[depth, node - width]
        low, high = (lattice.spans[node, 0], lattice.spans[node, 1]) if node < size else (_FIRST, width)
        if mask >= 0:
            _relax_open(
                targets[low:high],
                target_origins[low:high],
                base[node],
                row[low:high],
                lattice.weight,
                node,
                closed[node, low:high],
            )
        else:
            _relax(targets[low:high], target_origins[low:high], base[node], row[low:high], lattice.weight, node)
    for f in range(OWN):
        if lattice.price[depth + 1, width + f] < _INFINITE:
            out[width + f], origins[width + f] = _settle_own(lattice, work, depth, f, base)
    slopes_of(lattice, depth, depth + 1, base)
    price, count = lattice.price[depth + 1], 0
    for node in range(np.uint64(width + OWN)):
        out[node] += price[node] - base[node]
        count += out[node] < _INFINITE
    return count


@exact_lean_kernel
def _settle_own(lattice: Lattice, work: Work, depth: int, f: int, base: Floats32) -> tuple[Any, int]:
    """The least cost of a step to an own posture of the next depth, and where it comes from."""
    width, weight = lattice.moves.shape[1], np.float32(lattice.weight)
    best, origin, row = _INFINITE, -1, work.squares[depth + 1, f]
    mask = lattice.masks[depth]
    closed = lattice.closed[mask]
    for node in range(width + OWN):
        if base[node] >= best or (mask >= 0 and closed[node, width + f]):
            continue
        move = row[node] if node < width else np.float32(_own_move(lattice, depth, node - width, f))
        cost = base[node] + weight * move
        if cost < best:
            best, origin = cost, node
    return best, origin


@exact_lean_kernel
def _own_way(lattice: Lattice, few: Floats) -> float:
    """The cost of the cheapest way through key times' own postures alone: no cheapest way costs more.

    `few` (2, OWN) is scratch.
    """
    width, last = lattice.moves.shape[1], lattice.goals.shape[0] - 1
    for e in range(OWN):
        few[0, e] = 0.0 if e == HOLD else np.inf
    for depth in range(last):
        known, found = few[depth % 2], few[1 - depth % 2]
        found[:] = np.inf
        for f in range(OWN):
            price = lattice.price[depth + 1, width + f]
            if price == _INFINITE:
                continue
            for e in range(OWN):
                if known[e] < np.inf:
                    found[f] = min(found[f], known[e] + price + step_cost(lattice, depth, width + e, width + f))
    least = np.inf
    for e in range(OWN):
        least = min(least, few[last % 2, e])
    return least


@exact_lean_kernel
def _kept_way(lattice: Lattice) -> float:
    """The cost of the last plan's way, infinite where it is not free."""
    total, before = 0.0, lattice.moves.shape[1] + HOLD
    for depth in range(lattice.goals.shape[0] - 1):
        node = lattice.kept[depth + 1]
        total += lattice.price[depth + 1, node] + step_cost(lattice, depth, before, node)
        if total == np.inf:
            break
        before = node
    return total


@exact_lean_kernel
def step_cost(lattice: Lattice, depth: int, source: int, target: int) -> float:
    """What a step from a node at `depth` to one of the next costs; infinite if there is none."""
    size = lattice.postures.shape[0]
    mask = lattice.masks[depth]
    if mask >= 0 and lattice.closed[mask, source, target]:
        return np.inf
    moved, changed = 0.0, 0.0
    for i in range(lattice.goals.shape[1]):
        step = component_of(lattice, depth + 1, target, i) - component_of(lattice, depth, source, i)
        moved += step * step
        changed += (step - lattice.goals[depth + 1, i] + lattice.goals[depth, i]) ** 2
    listed = source >= size or target >= size or lattice.moves[source, target] < _INFINITE
    return lattice.weight * changed if listed and moved <= lattice.step * lattice.step * _ROUNDING else np.inf


@exact_lean_kernel
def least_in(row: Floats32) -> Any:
    """The least of many numbers."""
    least = row[0]
    for i in range(1, row.shape[0]):
        least = min(least, row[i])
    return least


@exact_lean_kernel
def place_of_least(row: Floats32) -> int:
    """Where the least of many numbers is; the first of them."""
    place = 0
    for i in range(1, row.shape[0]):
        if row[i] < row[place]:
            place = i
    return place


@exact_lean_kernel
def _settle_from(lattice: Lattice, work: Work, begin: int, most: float) -> tuple[int, int]:
    """Settle the lattice from depth `begin` on, without nodes through which no way costs at most `most`.

    Returns the greatest depth that has a way and the number of nodes that have one.
    """
    work.most[0] = most
    if begin == 0:
        work.costs[0] = _INFINITE
        work.costs[0, lattice.moves.shape[1] + HOLD] = 0.0
    reached, nodes = begin, 0
    for depth in range(begin, lattice.goals.shape[0] - 1):
        count = _settle(lattice, work, depth, most - work.least[depth])
        if count == 0:
            break
        reached, nodes = depth + 1, nodes + count
    return reached, nodes


@exact_kernel
def cheapest_way(lattice: Lattice, work: Work, begin: int, glance: bool) -> tuple[int, int]:
    """Settle the lattice from depth `begin` on, 0 at first; later the least depth at which steps were closed.

    Returns the greatest depth that has a way and the number of nodes that have one. Nodes from which even the least
    prices of the depths to come would cost more than a way that is known are left out. At a `glance` ways are looked
    for first that cost little more than these prices: what is found there is the cheapest, and most nodes are left out;
    `widen` makes up for it.
    """
    depths, least, nodes = lattice.goals.shape[0], work.least, 0
    if begin == 0:
        _measure(lattice, work)
    most = min(_own_way(lattice, work.few), _kept_way(lattice)) + _SLACK
    least[depths - 1] = 0.0
    for depth in range(depths - 2, -1, -1):
        price = least_in(lattice.price[depth + 1])
        least[depth] = least[depth + 1] + (price if price < _INFINITE else 0.0)
    if most > work.most[0]:
        begin = 0  # what was left out may be needed
    work.most[1] = most
    if glance and least[0] + _GLANCE < most:
        reached, nodes = _settle_from(lattice, work, int(_FIRST), least[0] + _GLANCE)
        if reached == depths - 1 and least_in(work.costs[reached]) + _SLACK < least[0] + _GLANCE:
            return reached, nodes
    reached, count = _settle_from(lattice, work, begin, most)
    return reached, nodes + count


@exact_lean_kernel
def widen(lattice: Lattice, work: Work) -> int:
    """Settle also what was left out at a glance, if it was one; the number of nodes that have a way."""
    if work.most[0] == work.most[1]:
        return 0
    _, nodes = _settle_from(lattice, work, int(_FIRST), work.most[1])
    return nodes


@exact_kernel
def traced(lattice: Lattice, work: Work, reached: int) -> Longs:
    """The nodes (reached+1,) of the cheapest way to that depth; the first is HOLD, the start."""
    way = np.empty(reached + 1, np.int64)
    way[reached] = place_of_least(work.costs[reached])
    for depth in range(reached, 0, -1):
        way[depth - 1] = work.parents[depth, way[depth]]
    way[0] = lattice.moves.shape[1] + HOLD
    return way


@exact_lean_kernel
def set_keys(lattice: Lattice, way: Longs, keys: Floats) -> None:
    """The postures of a way's nodes into the first rows of `keys` (n+1, d)."""
    for t in range(way.shape[0]):
        for i in range(keys.shape[1]):
            keys[t, i] = component_of(lattice, t, way[t], i)


@exact_kernel
def settle_backward(lattice: Lattice, work: Work, until: int, most: float) -> None:
    """The costs `left` of the nodes at the depths from the last down to `until`.

    Nodes that no way of at most the cost `most` leads through are left out.
    """
    size, width, weight = lattice.postures.shape[0], lattice.moves.shape[1], lattice.weight
    base, slopes, origins, column, limit = work.base, work.slopes, work.origins, work.closed, np.float32(most)
    work.left[lattice.goals.shape[0] - 1] = 0.0
    for depth in range(lattice.goals.shape[0] - 2, until - 1, -1):
        out, after, known = work.left[depth], work.left[depth + 1], work.costs[depth + 1]
        targets, price, mask = out[:width], lattice.price[depth + 1], lattice.masks[depth]
        closed = lattice.closed[mask]
        out[:] = _INFINITE
        square = np.float32(slopes_of(lattice, depth, depth + 1, slopes))
        for node in range(np.uint64(width + OWN)):
            base[node] = after[node] + price[node] - slopes[node] + square
            base[node] = base[node] if known[node] + after[node] <= limit else _INFINITE
        for node in range(width + OWN):
            if base[node] == _INFINITE:
                continue
            row = lattice.moves[node] if node < size else work.squares[depth + 1, node - width]
            low, high = (lattice.spans[node, 0], lattice.spans[node, 1]) if node < size else (_FIRST, width)
            if mask >= 0:
                for source in range(low, high):
                    column[source] = closed[source, node]
                near = column[low:high]
                _relax_open(targets[low:high], origins[low:high], base[node], row[low:high], weight, node, near)
            else:
                _relax(targets[low:high], origins[low:high], base[node], row[low:high], weight, node)
            for e in range(OWN):
                if work.costs[depth, width + e] < _INFINITE and not (mask >= 0 and closed[width + e, node]):
                    move = work.squares[depth, e, node] if node < size else _own_move(lattice, depth, e, node - width)
                    cost = np.float32(base[node] + weight * move)
                    out[width + e] = min(out[width + e], cost)
        slopes_of(lattice, depth, depth, slopes)
        for node in range(np.uint64(width + OWN)):
            out[node] += slopes[node]
