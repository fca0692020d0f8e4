"""Triangles that lie near each other, brought together; points that are the same, found."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]


def clusters_of(corners: Floats, whose: Longs, fewest: int, most: int, widest: float) -> Longs:
    """The number of the cluster of each triangle (T,), of those with `corners` (T, 3, 3); numbers have no gaps.

    All of a cluster belong to the same, as `whose` (T,) tells. It has at most `fewest` triangles; or at most `most`, if
    it lies in a box of the size `widest`. What is larger is halved, at the median of the middles of its triangles
    along the axis where they spread most; all clusters of one size in one go.
    """
    low, high = corners.min(axis=1), corners.max(axis=1)
    middles, found = 0.5 * (low + high), np.empty(len(corners), np.int64)
    members, node, closed = np.arange(len(corners)), whose, 0
    while len(members):
        order = np.argsort(node, kind="stable")
        members, node = members[order], np.unique(node[order], return_inverse=True)[1]
        counts = np.bincount(node)
        starts = np.cumsum(counts) - counts
        size = np.maximum.reduceat(high[members], starts) - np.minimum.reduceat(low[members], starts)
        done = (counts <= fewest) | ((counts <= most) & (size.max(axis=1) <= widest))
        found[members[done[node]]] = (closed + np.cumsum(done) - 1)[node[done[node]]]
        closed += int(done.sum())
        spread = np.maximum.reduceat(middles[members], starts) - np.minimum.reduceat(middles[members], starts)
        along = middles[members, spread.argmax(axis=1)[node]]
        half = (counts // 2 + fewest - 1) // fewest * fewest  # whole clusters
        right = np.empty(len(members), np.bool_)
        right[np.lexsort((along, node))] = np.arange(len(members)) - starts[node] >= half[node]
        members, node = members[~done[node]], (2 * node + right)[~done[node]]
    return found


def distinct_rows(rows: Floats | Longs) -> tuple[Longs, Longs]:
    """The place of one of each distinct row of (N, 3), and for each row the number of its like among them (N,)."""
    key = np.zeros(len(rows), np.int64)
    for column in rows.T:
        values, number = np.unique(column, return_inverse=True)
        key = key * len(values) + number
    _, first, like = np.unique(key, return_index=True, return_inverse=True)
    return first, like
