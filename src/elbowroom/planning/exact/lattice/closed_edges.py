"""Edges that searches have found to touch, or to lie close to such a one: paths do not use them any more."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import inner_exact_kernel

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]


class ClosedEdges(NamedTuple):
    """A table of edges for each key interval in which paths touched, M of them."""

    tables: Longs  # (n,) the number of each interval's table; -1: all its edges are open
    closed: Bools  # (M, W+E, W+E) which edges are closed
    seen: Bools  # (M, W+E, W+E) which edges were checked
    slack: Floats  # (M,) squared radians: how much dearer paths were checked


def new_closed_edges(intervals: int, nodes: int) -> ClosedEdges:
    """All edges open, in so many intervals between rows of `nodes` nodes."""
    none = 0, nodes, nodes
    return ClosedEdges(np.full(intervals, -1), np.zeros(none, np.bool_), np.zeros(none, np.bool_), np.zeros(0))


@inner_exact_kernel
def with_tables(edges: ClosedEdges, touches: Bools) -> ClosedEdges:
    """The same, and a table with all edges open for each interval that `touches` (n,) and has none yet."""
    used = 0
    for k in range(touches.shape[0]):
        used = max(used, edges.tables[k] + 1)
    needed, held = used, edges.slack.shape[0]
    for k in range(touches.shape[0]):
        if touches[k] and edges.tables[k] < 0:
            edges.tables[k] = needed
            needed += 1
    if needed <= held:
        return edges
    shape = (needed, edges.closed.shape[1], edges.closed.shape[2])
    more = ClosedEdges(edges.tables, np.zeros(shape, np.bool_), np.zeros(shape, np.bool_), np.zeros(needed))
    more.closed[:used], more.seen[:used], more.slack[:used] = edges.closed[:used], edges.seen[:used], edges.slack[:used]
    return more


@inner_exact_kernel
def reopen_first(edges: ClosedEdges) -> None:
    """Open all edges of the first interval."""
    at = edges.tables[0]
    if at >= 0:
        edges.closed[at], edges.seen[at], edges.slack[at] = False, False, 0.0
