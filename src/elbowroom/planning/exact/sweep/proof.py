"""Whether a limb's motion in a key interval is free of everything, at every moment and not only where it was looked at.

Let c and c' be a capsule's clearances at two looks, and L a length such that no point of its axis moves farther between
them. A point of the axis that has moved by s since the first look has yet to move L - s at most until the second; the
distance from a set changes by no more than the point moves. So its clearance is at least c - s and at least
c' - (L - s), and therefore never less than (c + c' - L) / 2. Where that is not enough the part is halved.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.posing import place_pelvis_into
from elbowroom.jit import exact_kernel, helper, plain
from elbowroom.planning.exact.lattice.postures import BLOCK, Postures
from elbowroom.planning.exact.memory.cache_index import admit, find
from elbowroom.planning.exact.sweep.motion_bounds import (
    SWEEP,
    Ends,
    KinematicChain,
    LimbSweeps,
    carry,
    configurations_into,
    moves_into,
)
from elbowroom.planning.exact.sweep.scratch import HALVINGS, Parts, Scratch, held_against, new_scratch
from elbowroom.planning.model.frames import compose_into
from elbowroom.planning.model.limb import carry_frames, pose_into
from elbowroom.planning.root.path import interpolate_between, rates_at
from elbowroom.world.obstacles.blocks import COMFORT, least_of
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.rows import around

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

ENOUGH = 4e-4  # metres: proven clearance that counts as free; more than rounding, and than the bob's bend between looks
_UNKNOWN = -np.inf
_NONE = plain(0)  # at first


class Carrier(NamedTuple):
    """What carries a limb through a key interval: a root way, or a waist's way on one."""

    number: int
    places: Floats  # (SWEEP+1, 3)
    turns: Floats  # (SWEEP+1, 4)
    sway: Floats  # (SWEEP,) metres
    states: Floats  # (16,) the root way's key
    heights: Floats  # (SWEEP+1, 3) the root way's places
    waist: Floats  # the waist's way's key; not used where the limb is the waist


@exact_kernel
def _samples(
    scratch: Scratch,
    postures: Postures,
    posed: bool,
    count: int,
    places: Floats,
    turns: Floats,
    obstacles: Nearby,
    out: Floats32,
) -> int:
    """Clearances (C, 16) of a motion's capsules, up to `COMFORT` or more; returns the capsules that were checked.

    The first `count` configurations of the room are looked at, in the frames (N, 3), (N, 4); if they are `posed`, their
    capsules are in the room too.
    """
    for c in range(out.shape[0]):
        row = out[c]
        for i in range(np.uint64(BLOCK)):
            row[i] = COMFORT
    near = around(obstacles, places[0], postures.reach + 0.5, scratch.near)
    if near == 0:
        return 0
    if not posed:
        pose_into(postures.limb, scratch.limb, scratch.configurations, count, _NONE, scratch.segments)
    return int(held_against(scratch, postures.limb.radii, near, count, places[0], places, turns, out))


@exact_kernel
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


@helper
def _frames_between(
    scratch: Scratch, chain: KinematicChain, on_root: bool, carrier: Carrier, waist: Ends, count: int
) -> None:
    """The carrier's frames at the first `count` of the room's parts of an interval, into the room.

    The pelvis' height is read between the looks; it bends by less than `ENOUGH` counts in there.
    """
    states, heights, places, shares = carrier.states, carrier.heights, scratch.places, scratch.shares
    interval, begin, end = states[0], states[1:8], states[8:15]
    rates = rates_at(begin, end)
    for n in range(count):
        interpolate_between(begin, end, rates, shares[n], interval, scratch.states[n])
    place_pelvis_into(chain.hips, scratch.states, scratch.level, count, places, scratch.turns)
    for n in range(count):
        sample = min(int(shares[n] * SWEEP), SWEEP - 1)
        part = shares[n] * SWEEP - sample
        places[n, 1] = heights[sample, 1] + part * (heights[sample + 1, 1] - heights[sample, 1])
    if not on_root:
        configurations_into(waist, interval, shares, count, scratch.waists)
        carry_frames(chain.waist, scratch.stem, scratch.waists, count)
        compose_into(places, scratch.turns, scratch.stem.places, scratch.stem.turns, count, places, scratch.turns)


@exact_kernel
def _enter(parts: Parts, now: int, n: int, at: float, sample: int, before: Floats32, after: Floats32) -> None:
    """Note a part that is not proven yet."""
    parts.at[now, n], parts.sample[now, n] = at, sample
    ends = parts.ends[now, n]
    for c in range(before.shape[0]):
        ends[0, c], ends[1, c] = before[c], after[c]


@helper
def _refined(
    scratch: Scratch,
    postures: Postures,
    levers: Floats,
    chain: KinematicChain,
    carrier: Carrier,
    waist: Ends,
    ends: Ends,
    obstacles: Nearby,
) -> tuple[float, int]:
    """The proven clearance of a motion whose looks found what is in the room, and the capsules checked.

    Parts for which the bound is not enough are halved, up to `HALVINGS` times, sixteen looks at once.
    """
    on_root, interval, moved, sway = postures.limb.chain.carries, carrier.states[0], scratch.moves, carrier.sway
    columns, found, parts, shares = scratch.coarse.T, scratch.found.T, scratch.parts, scratch.shares
    open_parts, now, proven, checks, share = _NONE, _NONE, np.inf, 0, 1.0
    for i in range(SWEEP):
        low = _between(columns[i], columns[i + 1], sway[i], moved[i], 1.0, levers)
        if low < ENOUGH:
            _enter(parts, now, open_parts, i / SWEEP, i, columns[i], columns[i + 1])
            open_parts += 1
        else:
            proven = min(proven, low)
    for _ in range(HALVINGS):
        share *= 0.5
        left = _NONE
        for begin in range(0, open_parts, BLOCK):
            batch = min(BLOCK, open_parts - begin)
            for n in range(batch):
                shares[n] = parts.at[now, begin + n] + share / SWEEP
            _frames_between(scratch, chain, on_root, carrier, waist, batch)
            configurations_into(ends, interval, shares, batch, scratch.configurations)
            checks += _samples(scratch, postures, False, batch, scratch.places, scratch.turns, obstacles, scratch.found)
            for n in range(batch):
                one, i = parts.ends[now, begin + n], parts.sample[now, begin + n]
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


@exact_kernel
def _set_key(number: int, ends: Ends, key: Floats) -> None:
    """Of a limb's way with the velocities and postures `ends` on the carrier's way `number`."""
    first, velocity, last, next_velocity = ends
    size = first.shape[0]
    key[0] = number
    for i in range(size):
        key[1 + i], key[1 + size + i] = first[i], velocity[i]
        key[1 + 2 * size + i], key[1 + 3 * size + i] = last[i], next_velocity[i]


@exact_kernel
def limb_sweep_in(
    scratch: Scratch,
    ways: LimbSweeps,
    postures: Postures,
    levers: Floats,
    chain: KinematicChain,
    carrier: Carrier,
    ends: Ends,
    obstacles: Nearby,
    wanted: float,
) -> tuple[int, int]:
    """`limb_sweep` with room to work in."""
    _set_key(carrier.number, ends, scratch.key)
    at = find(ways.entries, scratch.key)
    if at >= 0 and (ways.proven[at] > _UNKNOWN or ways.least[at] < wanted):
        return int(at), 0
    if at < 0:
        at = admit(ways.entries, scratch.key)
    on_root, interval, count = postures.limb.chain.carries, carrier.states[0], SWEEP + 1
    places, turns = carrier.places, carrier.turns
    for i in range(count):
        scratch.shares[i] = i / SWEEP
    configurations_into(ends, interval, scratch.shares, count, scratch.configurations)
    moves_into(ends, interval, SWEEP, scratch.rates, scratch.moves)
    if on_root:
        pose_into(postures.limb, scratch.limb, scratch.configurations, count, _NONE, scratch.segments)
        carry(
            chain,
            scratch.limb,
            scratch.moves,
            places,
            turns,
            carrier.sway,
            ways.places[at],
            ways.turns[at],
            ways.sway[at],
        )
    checks = _samples(scratch, postures, on_root, count, places, turns, obstacles, scratch.coarse)
    least = least_of(scratch.coarse, scratch.checks.apart)
    ways.least[at], ways.proven[at] = least, _UNKNOWN
    if least < wanted:
        return int(at), checks
    key = carrier.waist
    size = (key.shape[0] - 1) // 4
    waist = key[1 : 1 + size], key[1 + size : 1 + 2 * size], key[1 + 2 * size : 1 + 3 * size], key[1 + 3 * size :]
    ways.proven[at], more = _refined(scratch, postures, levers, chain, carrier, waist, ends, obstacles)
    return int(at), checks + more


@exact_kernel
def limb_sweep(
    ways: LimbSweeps,
    postures: Postures,
    levers: Floats,
    chain: KinematicChain,
    carrier: Carrier,
    ends: Ends,
    obstacles: Nearby,
    wanted: float,
) -> tuple[int, int]:
    """The slot of a limb's way through an interval, and the capsules that had to be checked for it.

    It goes from posture to posture with the velocities `ends`, on what carries it. Where less than the `wanted`
    clearance is found at the looks, what lies between them is not looked into.
    """
    scratch = new_scratch(postures, chain.waist, obstacles)
    at, checks = limb_sweep_in(scratch, ways, postures, levers, chain, carrier, ends, obstacles, wanted)
    return at, checks
