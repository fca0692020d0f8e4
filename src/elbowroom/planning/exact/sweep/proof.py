"""Whether a limb's motion in a key interval is free of everything, at every moment: proven by `halving`.

A pair is one of its capsules and all that stands near. How far the capsule moves in a part of the interval is what
carries it, and its levers times what its joints do.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.pose.pelvis import place_pelvis_into
from elbowroom.body.root import RISES
from elbowroom.jit import exact_kernel, helper, plain
from elbowroom.planning.exact.lattice.postures import BLOCK, Postures
from elbowroom.planning.exact.memory.cache_index import admit, find
from elbowroom.planning.exact.sweep.motion_bounds import (
    SWEEP,
    Ends,
    KinematicChain,
    LimbSweeps,
    configurations_at,
    moves_between,
)
from elbowroom.planning.exact.sweep.scratch import Scratch, held_against
from elbowroom.planning.halving import ENOUGH, begun, due, settle
from elbowroom.planning.model.frames import compose_into
from elbowroom.planning.model.levers import MOVES
from elbowroom.planning.model.limb import carry_frames, pose_into
from elbowroom.planning.root.path import interpolate_between, rates_at
from elbowroom.world.obstacles.blocks import COMFORT, least_of
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.rows import around

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_LOOKS = plain(SWEEP)  # parts of a key interval
_HALVINGS = plain(4)  # of these
_UNPOSED = plain(False)
_UNKNOWN = -np.inf
_NONE = plain(0)  # at first


class Carrier(NamedTuple):
    """What carries a limb through a key interval: a root way, or a waist's way on one."""

    number: int
    places: Floats  # (SWEEP+1, 3)
    turns: Floats  # (SWEEP+1, 4)
    sway: Floats  # (SWEEP,) metres
    states: Floats  # the root way's key
    heights: Floats  # (SWEEP+1, 3) the root way's places
    waist: Floats  # the waist's way's key; not used where the limb is the waist


class MovedLimb(NamedTuple):
    """A limb, and how far its joints and those below it can move it."""

    postures: Postures
    levers: Floats  # (C, 3) as `levers_of`
    chain: KinematicChain


@exact_kernel
def _samples(
    scratch: Scratch,
    postures: Postures,
    configurations: Floats,
    posed: bool,
    places: Floats,
    turns: Floats,
    obstacles: Nearby,
    out: Floats32,
) -> int:
    """Clearances (C, 16) of a motion's capsules, up to `COMFORT` or more; returns the capsules that were checked.

    Configurations (N, d) are looked at, in the frames (N, 3), (N, 4); if they are `posed`, their capsules are in the
    room.
    """
    for c in range(out.shape[0]):
        row = out[c]
        for i in range(np.uint64(BLOCK)):
            row[i] = COMFORT
    near, count = around(obstacles, places[0], postures.reach + 0.5, scratch.near), configurations.shape[0]
    if near == 0:
        return 0
    if not posed:
        pose_into(postures.limb, scratch.limb, configurations, count, _NONE, scratch.segments)
    return int(held_against(scratch, postures.limb.radii, near, count, places[0], places, turns, out))


@helper
def _frames_between(
    scratch: Scratch, chain: KinematicChain, on_root: bool, carrier: Carrier, waist: Ends, count: int
) -> None:
    """The carrier's frames at the first `count` of the room's parts of an interval, into the room.

    The pelvis' height is read between the looks; it bends by less than `ENOUGH` counts in there.
    """
    states, heights, places, shares = carrier.states, carrier.heights, scratch.places, scratch.shares
    interval, begin, end = states[0], states[1 : 1 + RISES], states[1 + RISES : 1 + 2 * RISES]
    rates = rates_at(begin, end)
    for n in range(count):
        interpolate_between(begin, end, rates, shares[n], interval, scratch.states[n])
    place_pelvis_into(chain.hips, scratch.states, scratch.level, count, places, scratch.turns)
    for n in range(count):
        sample = min(int(shares[n] * SWEEP), SWEEP - 1)
        part = shares[n] * SWEEP - sample
        places[n, 1] = heights[sample, 1] + part * (heights[sample + 1, 1] - heights[sample, 1])
    if not on_root:
        carry_frames(chain.waist, scratch.stem, configurations_at(waist, interval, shares[:count]), count)
        compose_into(places, scratch.turns, scratch.stem.places, scratch.stem.turns, count, places, scratch.turns)


@helper
def _gaps_of(clearances: Floats32, out: Floats32) -> None:
    """Clearances (C, 16) as the gaps `out` (N, C) of looks."""
    for n in range(out.shape[0]):
        for c in range(out.shape[1]):
            out[n, c] = clearances[c, n]


@helper
def _proven(
    scratch: Scratch, limb: MovedLimb, carrier: Carrier, ends: Ends, moved: Floats, obstacles: Nearby
) -> tuple[float, int]:
    """The proven clearance of a motion whose looks found what is in the room, and the capsules checked."""
    postures, levers, chain = limb
    interval, shares, count, checks = carrier.states[0], scratch.shares, levers.shape[0], 0
    size = (carrier.waist.shape[0] - 1) // 4
    waist = _quarters(carrier.waist, size)
    gaps, lengths = np.empty((SWEEP + 1, count), np.float32), np.empty((SWEEP, count))
    _gaps_of(scratch.coarse, gaps)
    for i in range(SWEEP):
        for c in range(count):
            lengths[i, c] = carrier.sway[i]
            for k in range(MOVES):
                lengths[i, c] += levers[c, k] * moved[i, k]
    proof = begun(gaps, lengths, _LOOKS, ENOUGH, _HALVINGS)
    parts, found = np.empty(BLOCK, np.int64), np.empty((BLOCK, count), np.float32)
    wanted = due(proof, parts, shares)
    while wanted > 0:
        for n in range(wanted):
            shares[n] = (parts[n] + shares[n]) / SWEEP
        _frames_between(scratch, chain, postures.limb.chain.carries, carrier, waist, wanted)
        shown = configurations_at(ends, interval, shares[:wanted])
        checks += _samples(scratch, postures, shown, _UNPOSED, scratch.places, scratch.turns, obstacles, scratch.found)
        _gaps_of(scratch.found, found)
        settle(proof, found, wanted)
        wanted = due(proof, parts, shares)
    return proof.least.min(), checks


@helper
def _quarters(key: Floats, size: int) -> Ends:
    """Posture and velocity at both ends, as the key of a limb's way has them."""
    return key[1 : 1 + size], key[1 + size : 1 + 2 * size], key[1 + 2 * size : 1 + 3 * size], key[1 + 3 * size :]


@helper
def _set_key(number: int, ends: Ends, key: Floats) -> None:
    """Of a limb's way with the velocities and postures `ends` on the carrier's way `number`."""
    first, velocity, last, next_velocity = ends
    size = first.shape[0]
    key[0] = number
    for i in range(size):
        key[1 + i], key[1 + size + i] = first[i], velocity[i]
        key[1 + 2 * size + i], key[1 + 3 * size + i] = last[i], next_velocity[i]


@helper
def _carry(scratch: Scratch, limb: MovedLimb, carrier: Carrier, moved: Floats, ways: LimbSweeps, at: int) -> None:
    """The chest's frames in the world and its sway, for the posed waist in the room, into the slot `at` of its ways."""
    inner, sway = scratch.limb, ways.sway[at]
    compose_into(carrier.places, carrier.turns, inner.places, inner.turns, SWEEP + 1, ways.places[at], ways.turns[at])
    for i in range(SWEEP):
        sway[i] = carrier.sway[i] + limb.chain.lever * moved[i, 0] + limb.chain.lift * moved[i, 1]


@exact_kernel
def limb_sweep(
    scratch: Scratch,
    ways: LimbSweeps,
    limb: MovedLimb,
    carrier: Carrier,
    ends: Ends,
    obstacles: Nearby,
    wanted: float,
) -> tuple[int, int]:
    """The slot of a limb's way through an interval, and the capsules that had to be checked for it.

    It goes from posture to posture with the velocities `ends`, on what carries it. Where less than the `wanted`
    clearance is found at the looks, what lies between them is not looked into.
    """
    _set_key(carrier.number, ends, scratch.key)
    at = find(ways.entries, scratch.key)
    if at >= 0 and (ways.proven[at] > _UNKNOWN or ways.least[at] < wanted):
        return int(at), 0
    if at < 0:
        at = admit(ways.entries, scratch.key)
    postures, on_root, interval, count = limb.postures, limb.postures.limb.chain.carries, carrier.states[0], SWEEP + 1
    for i in range(count):
        scratch.shares[i] = i / SWEEP
    shown, moved = configurations_at(ends, interval, scratch.shares[:count]), moves_between(ends, interval, _LOOKS)
    if on_root:
        pose_into(postures.limb, scratch.limb, shown, count, _NONE, scratch.segments)
        _carry(scratch, limb, carrier, moved, ways, at)
    checks = _samples(scratch, postures, shown, on_root, carrier.places, carrier.turns, obstacles, scratch.coarse)
    ways.least[at], ways.proven[at] = least_of(scratch.coarse, scratch.checks.apart), _UNKNOWN
    if ways.least[at] < wanted:
        return int(at), checks
    ways.proven[at], more = _proven(scratch, limb, carrier, ends, moved, obstacles)
    return int(at), checks + more
