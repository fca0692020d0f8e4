"""What the cheapest path through a time lattice to each node costs: dynamic programming, each node settled once.

An edge from a to b costs w |b - a - g|^2 (`lattice`), and that is w (|b - a|^2 + 2 a.g + |g|^2 - 2 b.g): the first part
is a table that never changes, the others belong to the source or to the target alone. What is left of a row is the
(min, +) product of a vector with a constant matrix, in which every target is a lane.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, inner_exact_kernel, plain
from elbowroom.planning.exact.lattice.lattice import (
    EXTRA,
    HOLD,
    Lattice,
    Work,
    extra_edge_square,
    least_in,
    measure_extras,
    slopes_of,
)
from elbowroom.planning.exact.lattice.paths import cost_of_previous, cost_through_extras

Floats32 = NDArray[np.float32]
Ints = NDArray[np.int32]
Bools = NDArray[np.bool_]

_SLACK = 1e-3  # squared radians: more than the rounding of a sum
_INFINITE = np.float32(np.inf)
_FIRST = plain(0)  # lane, depth
_NARROW = 0.25  # squared radians: how much dearer than the least node costs a path may be in a narrow search


@inner_exact_kernel
def _relax(out: Floats32, origins: Ints, base: float, row: Floats32, weight: float, source: int) -> None:
    """out[b] = min(out[b], base + weight row[b]), with its origin; lanes are targets."""
    start, factor, origin = np.float32(base), np.float32(weight), np.int32(source)
    for b in range(np.uint64(out.shape[0])):
        cost = start + factor * row[b]
        better = cost < out[b]
        out[b] = cost if better else out[b]
        origins[b] = origin if better else origins[b]


@inner_exact_kernel
def _relax_open(
    out: Floats32, origins: Ints, base: float, row: Floats32, weight: float, source: int, closed: Bools
) -> None:
    """`_relax` where some edges are `closed` (N,)."""
    start, factor, origin = np.float32(base), np.float32(weight), np.int32(source)
    for b in range(np.uint64(out.shape[0])):
        cost = _INFINITE if closed[b] else start + factor * row[b]
        better = cost < out[b]
        out[b] = cost if better else out[b]
        origins[b] = origin if better else origins[b]


@helper
def _settle(lattice: Lattice, work: Work, depth: int, most: float) -> int:
    """Settle the nodes at `depth + 1` from those at `depth` that cost no more than `most`.

    Returns how many nodes there have a path.
    """
    moves, spans = lattice.postures.moves, lattice.postures.spans
    size, width = moves.shape
    out, origins = work.costs[depth + 1], work.parents[depth + 1]
    targets, target_origins = out[:width], origins[:width]
    out[:] = _INFINITE
    base, limit = work.base, np.float32(most)
    square, known = np.float32(slopes_of(lattice, depth, depth, base)), work.costs[depth]
    for node in range(np.uint64(width + EXTRA)):
        base[node] = known[node] + base[node] + square if known[node] <= limit else _INFINITE
    mask = lattice.masks[depth]
    closed = lattice.closed[mask]
    for node in range(width + EXTRA):
        if base[node] == _INFINITE:
            continue
        row = moves[node] if node < size else work.squares[depth, node - width]
        low, high = (spans[node, 0], spans[node, 1]) if node < size else (_FIRST, width)
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
    for f in range(EXTRA):
        if lattice.cost[depth + 1, width + f] < _INFINITE:
            out[width + f], origins[width + f] = _settle_extra(lattice, work, depth, f, base)
    slopes_of(lattice, depth, depth + 1, base)
    added, count = lattice.cost[depth + 1], 0
    for node in range(np.uint64(width + EXTRA)):
        out[node] += added[node] - base[node]
        count += out[node] < _INFINITE
    return count


@helper
def _settle_extra(lattice: Lattice, work: Work, depth: int, f: int, base: Floats32) -> tuple[Any, int]:
    """The least cost of reaching extra node `f` of the next depth, without its own, and the node before it."""
    width, weight = lattice.postures.moves.shape[1], np.float32(lattice.weight)
    best, origin, row = _INFINITE, -1, work.squares[depth + 1, f]
    mask = lattice.masks[depth]
    closed = lattice.closed[mask]
    for node in range(width + EXTRA):
        if base[node] >= best or (mask >= 0 and closed[node, width + f]):
            continue
        square = row[node] if node < width else np.float32(extra_edge_square(lattice, depth, node - width, f))
        cost = base[node] + weight * square
        if cost < best:
            best, origin = cost, node
    return best, origin


@inner_exact_kernel
def _settle_from(lattice: Lattice, work: Work, begin: int, most: float) -> tuple[int, int]:
    """Settle the lattice from depth `begin` on, without nodes through which no path costs at most `most`.

    Returns the greatest depth that is reached and the number of nodes that have a path.
    """
    work.most[0] = most
    if begin == 0:
        work.costs[0] = _INFINITE
        work.costs[0, lattice.postures.moves.shape[1] + HOLD] = 0.0
    reached, nodes = begin, 0
    for depth in range(begin, lattice.goals.shape[0] - 1):
        count = _settle(lattice, work, depth, most - work.least[depth])
        if count == 0:
            break
        reached, nodes = depth + 1, nodes + count
    return reached, nodes


@exact_kernel
def cheapest_path(lattice: Lattice, work: Work, begin: int, narrow: bool) -> tuple[int, int]:
    """Settle the lattice from depth `begin` on: 0 at first, later the least depth after which something grew dearer.

    That must have been reached before.

    Returns the greatest depth that is reached and the number of nodes that have a path. Nodes from which even the least
    node costs of the depths to come add up to more than a known path costs are left out. A `narrow` search first allows
    little more than these least costs: a path that it finds is the cheapest, and most nodes are left out; `widen`
    settles them later.
    """
    depths, least, nodes = lattice.goals.shape[0], work.least, 0
    if begin == 0:
        measure_extras(lattice, work)
    most = min(cost_through_extras(lattice), cost_of_previous(lattice)) + _SLACK
    least[depths - 1] = 0.0
    for depth in range(depths - 2, -1, -1):
        cost = least_in(lattice.cost[depth + 1])
        least[depth] = least[depth + 1] + (cost if cost < _INFINITE else 0.0)
    if most > work.most[0]:
        begin = 0  # what was left out may be needed
    work.most[1] = most
    if narrow and least[0] + _NARROW < most:
        reached, nodes = _settle_from(lattice, work, _FIRST, least[0] + _NARROW)
        if reached == depths - 1 and least_in(work.costs[reached]) + _SLACK < least[0] + _NARROW:
            return reached, nodes
    reached, count = _settle_from(lattice, work, begin, most)
    return reached, nodes + count


@inner_exact_kernel
def widen(lattice: Lattice, work: Work) -> int:
    """Settle also what a narrow search left out, if it was one; the number of nodes that have a path."""
    if work.most[0] == work.most[1]:
        return 0
    _, nodes = _settle_from(lattice, work, _FIRST, work.most[1])
    return nodes


@exact_kernel
def settle_backward(lattice: Lattice, work: Work, until: int, most: float) -> None:
    """The costs `onward` of the nodes at the depths from the last down to `until`.

    Nodes that no path of at most the cost `most` leads through are left out.
    """
    moves, spans, weight = lattice.postures.moves, lattice.postures.spans, lattice.weight
    size, width = moves.shape
    base, slopes, origins, column, limit = work.base, work.slopes, work.origins, work.closed, np.float32(most)
    work.onward[lattice.goals.shape[0] - 1] = 0.0
    for depth in range(lattice.goals.shape[0] - 2, until - 1, -1):
        out, after, known = work.onward[depth], work.onward[depth + 1], work.costs[depth + 1]
        targets, added, mask = out[:width], lattice.cost[depth + 1], lattice.masks[depth]
        closed = lattice.closed[mask]
        out[:] = _INFINITE
        square = np.float32(slopes_of(lattice, depth, depth + 1, slopes))
        for node in range(np.uint64(width + EXTRA)):
            base[node] = after[node] + added[node] - slopes[node] + square
            base[node] = base[node] if known[node] + after[node] <= limit else _INFINITE
        for node in range(width + EXTRA):
            if base[node] == _INFINITE:
                continue
            row = moves[node] if node < size else work.squares[depth + 1, node - width]
            low, high = (spans[node, 0], spans[node, 1]) if node < size else (_FIRST, width)
            if mask >= 0:
                for source in range(low, high):
                    column[source] = closed[source, node]
                near = column[low:high]
                _relax_open(targets[low:high], origins[low:high], base[node], row[low:high], weight, node, near)
            else:
                _relax(targets[low:high], origins[low:high], base[node], row[low:high], weight, node)
            for e in range(EXTRA):
                if work.costs[depth, width + e] < _INFINITE and not (mask >= 0 and closed[width + e, node]):
                    length = work.squares[depth, e, node]
                    length = length if node < size else np.float32(extra_edge_square(lattice, depth, e, node - width))
                    cost = np.float32(base[node] + weight * length)
                    out[width + e] = min(out[width + e], cost)
        slopes_of(lattice, depth, depth, slopes)
        for node in range(np.uint64(width + EXTRA)):
            out[node] += slopes[node]
