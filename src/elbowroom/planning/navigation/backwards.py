"""Where a way is gone backwards: down stairs that lead under something low, as down a ladder.

Who goes up bends forward, and the head is past what hangs there before the hips come up to it. Who went down like that
would put the head down ahead of the feet, and under it; backwards it is the same as up.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.navigation.way import Place, Way

Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

_STEEP = 0.1  # metres up or down in a metre: no stair is less steep
_IN_IT = 0.02  # metres: what comes nearer to a head is ducked under
_BESIDE = 0.4  # metres before a stair and after it, where one turns
_SHORT = 0.2  # metres of a stretch that are not worth a turn


class Stretch(NamedTuple):
    """A part of a way that is gone in one manner."""

    backwards: bool
    way: Way  # to its end


def stretch_from(way: Way, place: Place, *, backwards: bool) -> Stretch:
    """The stretch of a way that begins at a place; one may be on a stair that one goes down `backwards`."""
    nodes = way.onward(place)
    if len(nodes) < 2:
        return Stretch(False, way)
    walked = np.concatenate([[0.0], np.cumsum(way.room.lengths(nodes))])
    manner = _backwards(way, nodes, walked, backwards)
    turns = 1 + np.flatnonzero(manner[1:] != manner[:-1])
    first = 0
    if len(turns) and walked[turns[0]] < _SHORT:
        first, turns = turns[0], turns[1:]
    return Stretch(bool(manner[first]), way.until(int(nodes[turns[0]])) if len(turns) else way)


def _backwards(way: Way, nodes: Longs, walked: NDArray[np.float64], already: bool) -> Bools:
    """Whether one goes backwards at each of the nodes (N,) of a way."""
    heights, above = way.room.surfaces.heights[nodes], way.room.above[nodes]
    out = np.zeros(len(nodes), np.bool_)
    ends = np.diff(np.concatenate([[0], (way.room.steep[nodes] > _STEEP).astype(np.int64), [0]]))
    for begin, end in zip(np.flatnonzero(ends > 0), np.flatnonzero(ends < 0), strict=True):
        last = end - 1
        leads_down = heights[begin] - heights[last] > way.room.surfaces.step
        low = bool(above[begin:end].min() < _IN_IT)
        if (leads_down and low) or (already and begin == 0):
            out |= (walked >= walked[begin] - _BESIDE) & (walked <= walked[last] + _BESIDE)
    return out
