"""Paths through a time lattice: what those known beforehand cost, and the cheapest one, once it is settled."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, inner_exact_kernel
from elbowroom.planning.exact.lattice.lattice import EXTRA, HOLD, Lattice, Work, component_of, edge_cost, place_of_least

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_INFINITE = np.float32(np.inf)


@inner_exact_kernel
def cost_through_extras(lattice: Lattice) -> float:
    """The cost of the cheapest path through extra nodes alone: the cheapest of all costs no more."""
    width, last = lattice.postures.moves.shape[1], lattice.goals.shape[0] - 1
    few = np.empty((2, EXTRA))
    for e in range(EXTRA):
        few[0, e] = 0.0 if e == HOLD else np.inf
    for depth in range(last):
        known, found = few[depth % 2], few[1 - depth % 2]
        found[:] = np.inf
        for f in range(EXTRA):
            cost = lattice.cost[depth + 1, width + f]
            if cost == _INFINITE:
                continue
            for e in range(EXTRA):
                if known[e] < np.inf:
                    found[f] = min(found[f], known[e] + cost + edge_cost(lattice, depth, width + e, width + f))
    least = np.inf
    for e in range(EXTRA):
        least = min(least, few[last % 2, e])
    return least


@inner_exact_kernel
def cost_of_previous(lattice: Lattice) -> float:
    """The cost of the last plan's path, infinite where it is not free."""
    total, before = 0.0, lattice.postures.moves.shape[1] + HOLD
    for depth in range(lattice.goals.shape[0] - 1):
        node = lattice.previous[depth + 1]
        total += lattice.cost[depth + 1, node] + edge_cost(lattice, depth, before, node)
        if total == np.inf:
            break
        before = node
    return total


@exact_kernel
def traced(lattice: Lattice, work: Work, reached: int) -> Longs:
    """The nodes (reached+1,) of the cheapest path to that depth; the first is HOLD, the start."""
    nodes = np.empty(reached + 1, np.int64)
    nodes[reached] = place_of_least(work.costs[reached])
    for depth in range(reached, 0, -1):
        nodes[depth - 1] = work.parents[depth, nodes[depth]]
    nodes[0] = lattice.postures.moves.shape[1] + HOLD
    return nodes


@inner_exact_kernel
def keys_into(lattice: Lattice, nodes: Longs, keys: Floats) -> None:
    """The postures of a path's nodes (m+1,) into the first rows of `keys` (n+1, d)."""
    for t in range(nodes.shape[0]):
        for i in range(keys.shape[1]):
            keys[t, i] = component_of(lattice, t, nodes[t], i)
