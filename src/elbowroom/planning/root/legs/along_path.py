"""How near legs and pelvis come to what stands along a root path: each key interval, and a stop from its end.

Nothing that is asked for is left out, and little is posed. From one moment to another at which legs have room no part
of them goes farther than the root's speed allows: where that is less than the room, they are free all the way, else
the moment in the middle is looked at too. It ends with the first interval that is not free.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel, helper, inner_exact_kernel
from elbowroom.planning.root.legs.hull import StrideHull, to_check
from elbowroom.planning.root.legs.neighbours import Neighbours
from elbowroom.planning.root.legs.room_of_legs import Legs, room_at
from elbowroom.planning.root.motion import MotionBounds, dense_states, stopping_states

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

_SWING = 4.0  # times as fast as the root goes no part of a leg moves
_SPAN = 6  # samples from one to the next that is looked at first
UNKNOWN: Any = np.float32(np.nan)  # room that was not looked at
_ENDLESS: Any = np.float32(np.inf)


@by_reference
class Looks(NamedTuple):
    """How the paths of one body are looked at."""

    legs: Legs
    hull: StrideHull
    bounds: MotionBounds
    skin: float  # metres of room that may be asked for, at most
    spacing: float  # seconds between samples, at most


@exact_kernel
def free_part(
    how: Looks, among: Neighbours, states: Floats, interval: float, skin: float, known: Floats32
) -> tuple[int, int]:
    """The number of leading key intervals of a path (n+1, 7) with `skin` metres of room, as the stop from each end has.

    And that of the states that legs were posed in. `known` (2, n) is the least room in key intervals and in stops, or
    `UNKNOWN`: what was looked at is written there.
    """
    bounds, kept, posed, before = how.bounds, states.shape[0] - 1, 0, UNKNOWN
    moving, stopping = to_check(
        states, interval, bounds.braking, bounds.turn_acceleration, how.skin, how.hull, among.ground
    )
    step, one = how.spacing * _fastest(states, how.legs.reach), np.ones(1, np.bool_)
    for k in range(kept):
        looked = moving[k] and np.isnan(known[0, k])
        if looked:
            rows, _ = dense_states(states[k : k + 2], interval, how.spacing, one)
            known[0, k], last, count = _least_room(how, among, _with_first(states[k], rows), step, before)
            before, posed = last, posed + count
        else:
            before = UNKNOWN
        if moving[k] and known[0, k] < skin:
            kept = k
            break
    for k in range(kept):
        if stopping[k] and np.isnan(known[1, k]):
            rows, _ = stopping_states(states[k : k + 2], interval, bounds, how.spacing, one)
            known[1, k], _, count = _least_room(how, among, _with_first(states[k + 1], rows), step, UNKNOWN)
            posed += count
        if stopping[k] and known[1, k] < skin:
            kept = k
            break
    return kept, posed


@helper
def _fastest(states: Floats, reach: float) -> float:
    """How fast any part of the legs moves along a path, m/s, at most."""
    forward, lateral, turn = 0.0, 0.0, 0.0
    for n in range(states.shape[0]):
        forward, lateral = max(forward, abs(states[n, 3])), max(lateral, abs(states[n, 4]))
        turn = max(turn, abs(states[n, 5]))
    return _SWING * (forward + lateral) + reach * turn


@inner_exact_kernel
def _with_first(first: Floats, rows: Floats) -> Floats:
    """A state (7,) and those that follow it (M, 7)."""
    joined = np.empty((rows.shape[0] + 1, rows.shape[1]))
    joined[0], joined[1:] = first, rows
    return joined


@inner_exact_kernel
def _least_room(how: Looks, among: Neighbours, rows: Floats, step: float, before: float) -> tuple[float, float, int]:
    """The least room in states (M+1, 7) but the first, that in the last of them, and how many of them were posed.

    From one to the next no part of a leg goes farther than `step` metres; `before` is the room in the first, if that is
    known.
    """
    last, posed = rows.shape[0] - 1, 0
    room, at = np.full(last + 1, UNKNOWN), np.empty(last + 1, np.int64)
    begin, end, spans, fresh = np.empty(last + 1, np.int64), np.empty(last + 1, np.int64), 0, 0
    room[0] = before
    for i in range(0, last, _SPAN):
        begin[spans], end[spans] = i, min(i + _SPAN, last)
        spans += 1
    if np.isnan(before):
        at[0], fresh = 0, 1
    for i in range(spans):
        at[fresh] = end[i]
        fresh += 1
    reached, least = step * _SPAN, _ENDLESS
    while fresh > 0:
        _look(how, among, rows, at[:fresh], how.skin + reached, room)
        posed += fresh
        for i in range(fresh):
            least = min(least, room[at[i]]) if at[i] > 0 else least
        spans, fresh = _narrowed(room, begin, end, spans, step, how.skin, at)
        reached *= 0.5
    return least, room[last], posed


@helper
def _look(how: Looks, among: Neighbours, rows: Floats, at: Longs, farthest: float, room: Floats32) -> None:
    """Write the room in some states to `room` (M+1,)."""
    found = room_at(how.legs, among, rows[at], how.skin, farthest)
    for i in range(at.shape[0]):
        room[at[i]] = found[i]


@helper
def _narrowed(
    room: Floats32, begin: Longs, end: Longs, spans: int, step: float, skin: float, at: Longs
) -> tuple[int, int]:
    """Cut those spans in two in which less than the skin may be left; how many spans there are then, and middles `at`.

    The room at both ends, less what may be moved in between, bounds it: `planning.halving` has the proof.
    """
    cut = 0
    for i in range(spans):
        a, b = begin[i], end[i]
        if b - a > 1 and 0.5 * (room[a] + room[b] - step * (b - a)) < skin:
            begin[cut], end[cut], at[cut] = a, b, (a + b) // 2
            cut += 1
    for i in range(cut - 1, -1, -1):
        a, b = begin[i], end[i]
        begin[2 * i], end[2 * i], begin[2 * i + 1], end[2 * i + 1] = a, at[i], at[i], b
    return 2 * cut, cut
