"""How near legs and pelvis come to what stands along a root path: each key interval, and a stop from its end.

Nothing that is asked for is left out, and little is posed. From one moment to another at which legs have room no part
of them goes farther than the root's speed allows: where that is less than the room, they are free all the way, else
the moment in the middle is looked at too. It ends with the first interval that is not free.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel, helper
from elbowroom.planning.root.legs.hull import StrideHull, to_check
from elbowroom.planning.root.legs.neighbours import Neighbours
from elbowroom.planning.root.legs.room_of_legs import Legs, room_at
from elbowroom.planning.root.motion import MotionBounds, dense_states, stopping_states

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

_SWING = 4.0  # times as fast as the root goes no part of a leg moves
_TOGETHER = 4  # key intervals, or stops, that are looked at together: most of the cost is not in the states
_STOPS, _IN_NONE = 1, -1
_SPAN = 6  # samples from one to the next that is looked at first
UNKNOWN: Any = np.float32(np.nan)  # room that was not looked at
_ENDLESS: Any = np.float32(np.inf)


@by_reference
class PathLooks(NamedTuple):
    """How the paths of one body are looked at."""

    legs: Legs
    hull: StrideHull
    bounds: MotionBounds
    skin: float  # metres of room that may be asked for, at most
    spacing: float  # seconds between samples, at most


@exact_kernel
def free_part(
    how: PathLooks, among: Neighbours, states: Floats, interval: float, skin: float, known: Floats32
) -> tuple[int, int]:
    """The number of leading key intervals of a path (n+1, 7) with `skin` metres of room, as the stop from each end has.

    And that of the states that legs were posed in. `known` (2, n) is the least room in key intervals and in stops, or
    `UNKNOWN`: what was looked at is written there.
    """
    bounds, free, posed = how.bounds, states.shape[0] - 1, 0
    moving, stopping = to_check(
        states, interval, bounds.braking, bounds.turn_acceleration, how.skin, how.hull, among.boxes
    )
    step = how.spacing * _fastest(states, how.legs.reach)
    for kind, asked in enumerate((moving, stopping)):
        k, before = 0, UNKNOWN
        while k < free:
            last = _together(asked, known[kind], k, free)
            if last > k:
                rows, owner = _shown(how, states[k : last + 1], interval, kind == _STOPS)
                room = np.full(rows.shape[0], UNKNOWN)
                room[0] = before
                posed += _least_rooms(how, among, rows, owner, (step, skin), room, known[kind, k:last])
                before = UNKNOWN if kind == _STOPS else room[-1]
            else:
                last, before = k + 1, UNKNOWN
            while k < last and not (asked[k] and known[kind, k] < skin):
                k += 1
            free = k if k < last else free
    return free, posed


@helper
def _together(asked: Bools, known: Floats32, first: int, end: int) -> int:
    """Up to where parts of a path are looked at together, from one of them on; as far as that where it is not."""
    last = first
    while last < end and last - first < _TOGETHER and asked[last] and np.isnan(known[last]):
        last += 1
    return last


@helper
def _shown(how: PathLooks, states: Floats, interval: float, stops: bool) -> tuple[Floats, Longs]:
    """The states (M, 7) that are shown in key intervals, or in stops from their ends, and in which of them (M,).

    A way on which one goes from state to state begins with one that is in none, -1.
    """
    count = states.shape[0] - 1
    every = np.ones(count, np.bool_)
    if stops:
        shown, keys = stopping_states(states, interval, how.bounds, how.spacing, every)
    else:
        shown, keys = dense_states(states, interval, how.spacing, every)
    ways = count if stops else 1
    rows, owner, used = np.empty((shown.shape[0] + ways, states.shape[1])), np.empty(shown.shape[0] + ways, np.int64), 0
    for way in range(ways):
        rows[used], owner[used] = states[way + 1] if stops else states[0], _IN_NONE
        used += 1
        for n in range(shown.shape[0]):
            if not stops or keys[n] == way + 1:
                rows[used], owner[used] = shown[n], keys[n] - 1
                used += 1
    return rows, owner


@helper
def _fastest(states: Floats, reach: float) -> float:
    """How fast any part of the legs moves along a path, m/s, at most."""
    forward, lateral, turn = 0.0, 0.0, 0.0
    for n in range(states.shape[0]):
        forward, lateral = max(forward, abs(states[n, 3])), max(lateral, abs(states[n, 4]))
        turn = max(turn, abs(states[n, 5]))
    return _SWING * (forward + lateral) + reach * turn


@helper
def _least_rooms(
    how: PathLooks,
    among: Neighbours,
    rows: Floats,
    owner: Longs,
    asked: tuple[float, float],
    room: Floats32,
    least: Floats32,
) -> int:
    """Write the least room in each of some parts of a path, `least` (n,), up to the first that has less than is asked.

    They are shown in states (M, 7), as `_shown` has them. `asked` are the metres that a part of a leg goes from one to
    the next, at most, and those of room. What is in them, `room` (M,), is written where it is looked at, and not looked
    at where it is known. Returns how many states were posed.
    """
    count, posed, (step, skin) = rows.shape[0], 0, asked
    begin, end, at = np.empty(count, np.int64), np.empty(count, np.int64), np.empty(count, np.int64)
    spans, fresh, found = 0, 0, np.full(least.shape[0], _ENDLESS)
    for i in range(count):
        if owner[i] == _IN_NONE:
            first = i
        ends = i + 1 == count or owner[i + 1] != owner[i]
        if owner[i] != _IN_NONE and (ends or i - first == _SPAN):
            begin[spans], end[spans] = first, i
            spans, first = spans + 1, i
        if np.isnan(room[i]) and (owner[i] == _IN_NONE or first == i):
            at[fresh] = i
            fresh += 1
    reached, blocked = step * _SPAN, least.shape[0]
    while fresh > 0:
        _look(how, among, rows, at[:fresh], how.skin + reached, room)
        posed += fresh
        for i in range(fresh):
            part = owner[at[i]]
            if part != _IN_NONE:
                found[part] = min(found[part], room[at[i]])
                blocked = min(blocked, part) if found[part] < skin else blocked
        spans, fresh = _narrowed(room, begin, end, spans, step, how.skin, at)
        while fresh > 0 and owner[at[fresh - 1]] > blocked:
            spans, fresh = spans - 2, fresh - 1
        reached *= 0.5
    least[: blocked + 1] = found[: blocked + 1]
    return posed


@helper
def _look(how: PathLooks, among: Neighbours, rows: Floats, at: Longs, farthest: float, room: Floats32) -> None:
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
