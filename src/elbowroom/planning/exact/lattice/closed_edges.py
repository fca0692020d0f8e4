"""Steps that were found to touch, kept from plan to plan."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.lattice.lattice import EXTRA
from elbowroom.planning.exact.memory.cache_index import CacheIndex, admit, begin_round, find, new_cache_index

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]


class ClosedEdges(NamedTuple):
    """Steps that were found to touch, by interval; the key is that of its table. So no plan has to find them again."""

    entries: CacheIndex
    closed: Bools  # (M, W+OWN, W+OWN) which steps are closed
    seen: Bools  # (M, W+OWN, W+OWN) steps that were looked at
    slack: Floats  # (M,) squared radians: how much dearer ways were looked at


def new_closed_edges(count: int, size: int, nodes: int) -> ClosedEdges:
    """Room for `count` intervals of a group with `size` components and rows of `nodes` nodes."""
    square = (count, nodes, nodes)
    return ClosedEdges(
        new_cache_index(count, 1 + 2 * size), np.zeros(square, np.bool_), np.zeros(square, np.bool_), np.zeros(count)
    )


@exact_kernel
def known_closed_edges(masks: ClosedEdges, keys: Floats, previous: Longs) -> Longs:
    """The masks (n,) of intervals with these keys (n, K), -1 where there is none.

    What it says of postures that belonged to the last plan's key times alone is forgotten, and so is what it says of
    the steps between the nodes `kept` (n+1,) of the last plan: they may be closed for being near to others only.
    """
    begin_round(masks.entries)
    out = np.empty(keys.shape[0], np.int64)
    for k in range(keys.shape[0]):
        at = find(masks.entries, keys[k])
        out[k] = at
        if at >= 0:
            closed, seen = masks.closed[at], masks.seen[at]
            nodes = closed.shape[0]
            for e in range(nodes - EXTRA + 1, nodes):
                for node in range(nodes):
                    closed[e, node], closed[node, e] = False, False
                    seen[e, node], seen[node, e] = False, False
            closed[previous[k], previous[k + 1]] = False
    return out


@exact_kernel
def admit_closed_edges(masks: ClosedEdges, key: Floats) -> int:
    """The mask of an interval under `key` (K,), with all steps open."""
    at = admit(masks.entries, key)
    masks.closed[at], masks.seen[at], masks.slack[at] = False, False, 0.0
    return int(at)


@exact_kernel
def reopen(masks: ClosedEdges, at: int) -> None:
    """Open all steps of a mask, if it is one."""
    if at >= 0:
        masks.closed[at], masks.seen[at], masks.slack[at] = False, False, 0.0


@exact_kernel
def closed_edge_keys(ids: Longs, goals: Floats) -> Floats:
    """The keys (n, 1 + 2 d): number of the carrier's way, goals at both ends."""
    horizon, size = goals.shape[0] - 1, goals.shape[1]
    keys = np.empty((horizon, 1 + 2 * size))
    for k in range(horizon):
        keys[k, 0] = ids[k]
        for i in range(size):
            keys[k, 1 + i], keys[k, 1 + size + i] = goals[k, i], goals[k + 1, i]
    return keys
