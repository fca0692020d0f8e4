"""Whether a shown motion runs into the avatar's own body, at any moment.

It is sampled as closely as need be (`own_samples`). An interval that was sampled for an earlier plan is known by its
content. It is one compiled call.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL
from elbowroom.body.kinematics import BodyModel
from elbowroom.body.whole_body import whole_body
from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.memory.row_contents import CONTENT, is_natural, set_bits, set_contents
from elbowroom.planning.exact.memory.row_index import RowIndex, admit, forget, new_row_index, place_of
from elbowroom.planning.exact.sweep.own_samples import OwnParts, least_gaps
from elbowroom.planning.model.self_pairs import SelfPairs
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

_UNSEEN = 2e-4  # metres by which parts may come nearer between two of the last samples
_AFAR = 2.0  # times as much is left far ahead: what was free from afar stays free when it is near
_SOON = 4  # key intervals ahead until which a motion is near
ROOM = 512  # intervals that can be remembered; when half of them are, all are forgotten before the next plan


class Seen(NamedTuple):
    """Key intervals that were sampled, by the content of both their ends."""

    known: RowIndex
    groups: Indices  # (S,) the number of the group that comes nearest to what it must keep clear of, and
    gaps: Floats  # (S,) its gap, metres


def own_parts(model: BodyModel, pairs: SelfPairs) -> OwnParts:
    """The parts of a body that must not run into each other."""
    return OwnParts(whole_body(model), pairs.first, pairs.second, pairs.kinds, pairs.limits)


class OwnMotion:
    """One avatar's motion among its own parts, and the key intervals of it that were sampled."""

    def __init__(self, parts: OwnParts) -> None:
        self._parts = parts
        known = new_row_index(ROOM, 2 * (CONTENT + 2 * LOCAL))
        self._seen = Seen(known, np.empty(ROOM, np.int64), np.empty(ROOM))

    def contacts(self, path: RootPath, keys: Floats, rates: Floats, goals: Floats, ahead: int) -> Indices:
        """The group, by its number in `CHILDREN`, that runs into the body in each interval (n,) of a motion, or -1.

        `keys` (n+1, 11) and `rates` (n+1, 11) are the upper body and its velocity at the key times, the first of which
        is `ahead` key intervals from now. Where both ends of an interval are as the `goals` (n+1, 11) have them, it
        does not touch. A gap less than what no sample shows touches too, and farther ahead one of twice that.
        """
        return _contacts(self._parts, self._seen, path.states, keys, rates, goals, path.interval, ahead)


@exact_kernel
def _contacts(
    parts: OwnParts, seen: Seen, states: Floats, keys: Floats, rates: Floats, goals: Floats,
    interval: float, ahead: int,
) -> Indices:  # fmt: skip
    """See `OwnMotion.contacts`."""
    it, out = seen, np.empty(keys.shape[0] - 1, np.int64)
    out[:] = -1
    chosen = _beside(keys, goals)
    if not chosen.shape[0]:
        return out
    width = CONTENT + 2 * LOCAL
    names = np.empty(keys.shape[0] * width, np.int64)
    contents = names.reshape(keys.shape[0], width)
    set_contents(states, keys, contents)
    for t in range(keys.shape[0]):
        set_bits(rates[t], contents[t, CONTENT + LOCAL :])
    if 2 * it.known.taken[0] > it.gaps.shape[0]:
        forget(it.known)
    missing, count = np.empty(chosen.shape[0], np.int64), 0
    for k in chosen:
        place = place_of(it.known, names[k * width : (k + 2) * width])
        if place < 0:
            missing[count] = k
            count += 1
        elif _touches(it.gaps[place], ahead + k):
            out[k] = it.groups[place]
    if not count:
        return out
    gaps = least_gaps(parts, states, keys, rates, interval, missing[:count])
    for i in range(count):
        k, nearest = missing[i], 0
        for g in range(1, gaps.shape[0]):
            nearest = g if gaps[g, i] < gaps[nearest, i] else nearest
        place = admit(it.known, names[k * width : (k + 2) * width])
        it.groups[place], it.gaps[place] = nearest, gaps[nearest, i]
        if _touches(it.gaps[place], ahead + k):
            out[k] = nearest
    return out


@exact_kernel
def _beside(keys: Floats, goals: Floats) -> Indices:
    """The intervals (K,) at whose ends the upper body (n+1, 11) is not as the goals (n+1, 11) have it."""
    chosen, count, natural = np.empty(keys.shape[0] - 1, np.int64), 0, is_natural(keys[0], goals[0])
    for k in range(chosen.shape[0]):
        before, natural = natural, is_natural(keys[k + 1], goals[k + 1])
        if not (before and natural):
            chosen[count] = k
            count += 1
    return chosen[:count]


@exact_kernel
def _touches(gap: float, ahead: int) -> bool:
    """Whether a gap of parts is too little, so many key intervals ahead."""
    return bool(gap < _UNSEEN * (1.0 if ahead < _SOON else _AFAR))
