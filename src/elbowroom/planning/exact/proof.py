"""Whether a limb's motion in a key interval is free of everything, at every moment and not only where it was looked at.

Let c and c' be a capsule's clearances at two looks, and L a length such that no point of its axis moves farther between
them. A point of the axis that has moved by s since the first look has yet to move L - s at most until the second; the
distance from a set changes by no more than the point moves. So its clearance is at least c - s and at least
c' - (L - s), and therefore never less than (c + c' - L) / 2. Where that is not enough the part is halved.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.posing import place_pelvis
from elbowroom.jit import exact_inner_kernel, exact_kernel, inlined
from elbowroom.planning.exact.clearances import (
    COMFORT,
    boxes_around,
    capsule_clearances,
    place_capsules,
    relative_to,
)
from elbowroom.planning.exact.postures import BLOCK, Postures
from elbowroom.planning.exact.slots import admit, find
from elbowroom.planning.exact.ways import (
    SWEEP,
    Chain,
    Ends,
    LimbWays,
    carry,
    configurations_at,
    moves_between,
)
from elbowroom.planning.frames import compose
from elbowroom.planning.limb import Limb, carried_frames, pose
from elbowroom.planning.root_path import interpolate_root

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

HALVINGS = 4
ENOUGH = 4e-4  # metres: proven clearance that counts as free; more than rounding, and than the bob's bend between looks
_FAR = np.float32(1e3)
_UNKNOWN = -np.inf


class Carrier(NamedTuple):
    """What carries a limb through a key interval: a root way, or a waist's way on one."""

    number: int
    places: Floats  # (SWEEP+1, 3)
    turns: Floats  # (SWEEP+1, 4)
    sway: Floats  # (SWEEP,) metres
    states: Floats  # (16,) the root way's key
    heights: Floats  # (SWEEP+1, 3) the root way's places
    waist: Floats  # the waist's way's key; not used where the limb is the waist


@exact_inner_kernel
def _looks(
    postures: Postures,
    configurations: Floats,
    places: Floats,
    turns: Floats,
    boxes: Floats,
    out: Floats32,
) -> int:
    """Clearances (C, 16) of a motion's capsules, up to `COMFORT` or more; returns the capsules that were checked."""
    limb, reach = postures.limb, postures.reach
    out[:] = COMFORT
    origin, near = places[0], np.empty_like(boxes)
    count = boxes_around(boxes, origin, reach + 0.5, near)
    if count == 0:
        return 0
    at = np.empty_like(places)
    relative_to(origin, near, count, places, at)
    segments, radii = pose(limb, configurations), limb.radii
    lanes = np.empty((segments.shape[0], 7, BLOCK), np.float32)
    place_capsules(segments, radii, at, turns, lanes)
    return int(capsule_clearances(lanes, near, count, out))


@exact_inner_kernel
def _between(before: Floats32, after: Floats32, sway: float, moved: Floats, share: float, levers: Floats) -> float:
    """The bound on the clearance between two looks that found `before` (C,) and `after` (C,).

    They are `share` of a part of the interval apart, in which points are carried by `sway` and joints move by `moved`.
    """
    least = np.inf
    for c in range(levers.shape[0]):
        length = share * sway
        for k in range(3):
            length += levers[c, k] * (share * moved[k])
        least = min(least, 0.5 * (before[c] + after[c] - length))
    return least


@exact_inner_kernel
def _frames_between(
    hips: Floats, waist: Limb, is_waist: bool, states: Floats, heights: Floats, waists: Ends, shares: Floats
) -> tuple[Floats, Floats]:
    """The carrier's frames (N, 3), (N, 4) at parts of an interval; `hips` and `waist` are those of the chain.

    The pelvis' height is read between the looks; it bends by less than `ENOUGH` counts in there.
    """
    count, interval = shares.shape[0], states[0]
    between = np.empty((count, 7))
    for n in range(count):
        state = interpolate_root(states[1:8], states[8:15], shares[n], interval)
        for i in range(7):
            between[n, i] = state[i]
    places, turns = place_pelvis(hips, between, np.zeros((count, 2)))
    for n in range(count):
        look = min(int(shares[n] * SWEEP), SWEEP - 1)
        part = shares[n] * SWEEP - look
        places[n, 1] = heights[look, 1] + part * (heights[look + 1, 1] - heights[look, 1])
    if is_waist:
        return places, turns
    inner, inner_turns = carried_frames(waist, configurations_at(waists, interval, shares))
    frames: tuple[Floats, Floats] = compose(places, turns, inner, inner_turns)
    return frames


class _Parts(NamedTuple):
    """Parts of an interval that are not proven yet, in two sets that take turns."""

    at: Floats  # (2, N) where they begin
    look: Longs  # (2, N) the look before them
    ends: Floats32  # (2, N, 2, C) clearances at both their ends


@inlined
def _enter(parts: _Parts, now: int, n: int, at: float, look: int, before: Floats32, after: Floats32) -> None:
    parts.at[now, n], parts.look[now, n] = at, look
    ends = parts.ends[now, n]
    for c in range(before.shape[0]):
        ends[0, c], ends[1, c] = before[c], after[c]


@inlined
def _refined(
    postures: Postures,
    levers: Floats,
    chain: Chain,
    carrier: Carrier,
    waist: Ends,
    ends: Ends,
    boxes: Floats,
    coarse: Floats32,
    moved: Floats,
) -> tuple[float, int]:
    """The proven clearance of a motion whose looks found `coarse` (C, 16), and the capsules checked.

    Parts for which the bound is not enough are halved, up to `HALVINGS` times, sixteen looks at once.
    """
    hips, stem, states, heights, sway = chain.hips, chain.waist, carrier.states, carrier.heights, carrier.sway
    is_waist, interval, count = postures.limb.is_waist, states[0], levers.shape[0]
    room, columns = SWEEP << HALVINGS, coarse.T
    parts = _Parts(np.empty((2, room)), np.empty((2, room), np.int64), np.empty((2, room, 2, count), np.float32))
    open_parts, proven, checks, now = 0, np.inf, 0, 0
    for i in range(SWEEP):
        low = _between(columns[i], columns[i + 1], sway[i], moved[i], 1.0, levers)
        if low < ENOUGH:
            _enter(parts, now, open_parts, i / SWEEP, i, columns[i], columns[i + 1])
            open_parts += 1
        else:
            proven = min(proven, low)
    out, share = np.empty((count, BLOCK), np.float32), 1.0
    found = out.T
    for _ in range(HALVINGS):
        share *= 0.5
        left = 0
        for begin in range(0, open_parts, BLOCK):
            batch = min(BLOCK, open_parts - begin)
            shares = np.empty(batch)
            for n in range(batch):
                shares[n] = parts.at[now, begin + n] + share / SWEEP
            places, turns = _frames_between(hips, stem, is_waist, states, heights, waist, shares)
            checks += _looks(postures, configurations_at(ends, interval, shares), places, turns, boxes, out)
            for n in range(batch):
                one, i = parts.ends[now, begin + n], parts.look[now, begin + n]
                for half in range(2):
                    before = one[0] if half == 0 else found[n]
                    after = found[n] if half == 0 else one[1]
                    low = _between(before, after, sway[i], moved[i], share, levers)
                    if low >= ENOUGH:
                        proven = min(proven, low)
                        continue
                    at = parts.at[now, begin + n] + half * share / SWEEP
                    _enter(parts, 1 - now, left, at, i, before, after)
                    left += 1
        open_parts, now = left, 1 - now
        if open_parts == 0:
            return proven, checks
    return 0.0, checks


@exact_inner_kernel
def _key(number: int, ends: Ends) -> Floats:
    """Of a limb's way with the velocities and postures `ends` on the carrier's way `number`."""
    first, velocity, last, next_velocity = ends
    size = first.shape[0]
    key = np.empty(1 + 4 * size)
    key[0] = number
    for i in range(size):
        key[1 + i], key[1 + size + i] = first[i], velocity[i]
        key[1 + 2 * size + i], key[1 + 3 * size + i] = last[i], next_velocity[i]
    return key


@exact_inner_kernel
def _ends_of(key: Floats) -> Ends:
    """Posture, velocity, posture, velocity of the way under a key."""
    size = (key.shape[0] - 1) // 4
    return key[1 : 1 + size], key[1 + size : 1 + 2 * size], key[1 + 2 * size : 1 + 3 * size], key[1 + 3 * size :]


@exact_kernel
def limb_way(
    ways: LimbWays,
    postures: Postures,
    levers: Floats,
    chain: Chain,
    carrier: Carrier,
    ends: Ends,
    boxes: Floats,
    wanted: float,
) -> tuple[int, int]:
    """The slot of a limb's way through an interval, and the capsules that had to be checked for it.

    It goes from posture to posture with the velocities `ends`, on what carries it. Where less than the `wanted`
    clearance is found at the looks, what lies between them is not looked into.
    """
    key = _key(carrier.number, ends)
    at = find(ways.slots, key)
    if at >= 0 and (ways.proven[at] > _UNKNOWN or ways.least[at] < wanted):
        return int(at), 0
    if at < 0:
        at = admit(ways.slots, key)
    is_waist, interval = postures.limb.is_waist, carrier.states[0]
    places, turns = carrier.places, carrier.turns
    shares = np.empty(SWEEP + 1)
    for i in range(SWEEP + 1):
        shares[i] = i / SWEEP
    configurations = configurations_at(ends, interval, shares)
    moved = moves_between(ends, interval, SWEEP)
    if is_waist:
        carry(chain, configurations, moved, places, turns, carrier.sway, ways.places[at], ways.turns[at], ways.sway[at])
    out = np.empty((levers.shape[0], BLOCK), np.float32)
    checks = _looks(postures, configurations, places, turns, boxes, out)
    least = out.min()
    ways.least[at], ways.proven[at] = least, _UNKNOWN
    if least < wanted:
        return int(at), checks
    waist = ends if is_waist else _ends_of(carrier.waist)
    ways.proven[at], count = _refined(postures, levers, chain, carrier, waist, ends, boxes, out, moved)
    return int(at), checks + count
