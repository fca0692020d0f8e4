"""Where a way is gone backwards: down stairs that lead under something low, as down a ladder, and in under eaves.

Who goes up bends forward, and the head is past what hangs there before the hips come up to it. Who went down like that
would put the head down ahead of the feet, and under it; backwards it is the same as up. Who goes in to a place where
one stands bent, and a bent head would have no room ahead, goes in backwards too: then the head is where there is more
room, and the way out lies before one.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.navigation.way import Place, Way

Longs = NDArray[np.int64]
Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_STEEP = 0.1  # metres up or down in a metre: no stair is less steep
_IN_IT = 0.02  # metres: what comes nearer to a head is ducked under
_BESIDE = 0.4  # metres before a stair and after it, where one turns
_SHORT = 0.2  # metres of a stretch that are not worth a turn
_HEAD = 0.6  # metres that the head is ahead of the hips of who is bent low
_LAST = 0.3  # metres of a way that tell in which direction it ends


class Stretch(NamedTuple):
    """A part of a way that is gone in one manner."""

    backwards: bool
    way: Way  # to its end


def stretch_from(way: Way, place: Place, *, backwards: bool) -> Stretch:
    """The stretch of a way that begins at a place; one may already go `backwards`, and nobody turns where it is low."""
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


def _backwards(way: Way, nodes: Longs, walked: Floats, already: bool) -> Bools:
    """Whether one goes backwards at each of the nodes (N,) of a way, so many metres from its beginning (N,)."""
    heights, above = way.room.surfaces.heights[nodes], way.room.above[nodes]
    out, low = np.zeros(len(nodes), np.bool_), above < _IN_IT
    for begin, last in _runs(way.room.steep[nodes] > _STEEP):
        leads_down = heights[begin] - heights[last] > way.room.surfaces.step
        if (leads_down and low[begin : last + 1].any()) or (already and begin == 0):
            out |= _about(walked, begin, last)
    for begin, last in _runs(low):
        to_the_end = last == len(nodes) - 1
        if to_the_end and ((already and begin == 0) or not _has_room_ahead(way, nodes, walked)):
            out |= _about(walked, begin, last)
    return out


def _runs(there: Bools) -> list[tuple[int, int]]:
    """The first and the last node of each run of those (N,) of which something is so."""
    ends = np.diff(np.concatenate([[0], there.astype(np.int64), [0]]))
    return list(zip(np.flatnonzero(ends > 0).tolist(), (np.flatnonzero(ends < 0) - 1).tolist(), strict=True))


def _about(walked: Floats, begin: int, last: int) -> Bools:
    """The nodes (N,) from one to another, and those beside them where one turns."""
    about: Bools = (walked >= walked[begin] - _BESIDE) & (walked <= walked[last] + _BESIDE)
    return about


def _has_room_ahead(way: Way, nodes: Longs, walked: Floats) -> bool:
    """Whether one who comes to the end of a way bent low has room for the head ahead of it."""
    before = int(np.searchsorted(walked, walked[-1] - _LAST))
    (from_x, _, from_z), (x, height, z) = way.room.place(nodes[min(before, len(nodes) - 2)]), way.room.place(nodes[-1])
    length = math.hypot(x - from_x, z - from_z)
    for far in np.arange(way.room.cell, _HEAD, way.room.cell) / length:
        ahead = way.room.next_to(x + far * (x - from_x), z + far * (z - from_z), height)
        if ahead is None or way.room.room[ahead] < way.prices.slim:
            return False
    return True
