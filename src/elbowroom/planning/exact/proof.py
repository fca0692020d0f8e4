"""Whether a limb's motion in a key interval is free of everything, at every moment and not only where it was looked at.

Let c and c' be a capsule's clearances at two looks, and L a length such that no point of its axis moves farther between
them. A point of the axis that has moved by s since the first look has yet to move L - s at most until the second; the
distance from a set changes by no more than the point moves. So its clearance is at least c - s and at least
c' - (L - s), and therefore never less than (c + c' - L) / 2. Where that is not enough the part is looked at in FINE.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.clearances import COMFORT, boxes_around, capsule_clearances, place_capsules
from elbowroom.planning.exact.postures import BLOCK, Postures
from elbowroom.planning.exact.slots import admit, find
from elbowroom.planning.exact.ways import (
    SWEEP,
    Chain,
    LimbWays,
    RootWays,
    carry,
    pelvis_at,
    rates_between,
    states_between,
)
from elbowroom.planning.limb import pose

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Ends = tuple[Floats, Floats, Floats, Floats]

FINE = 8
ENOUGH = 1e-4  # metres: proven clearance that counts as free, more than single precision rounds
_FAR = np.float32(1e3)
_UNKNOWN = -np.inf


@exact_kernel
def _looks(
    postures: Postures,
    configurations: Floats,
    places: Floats,
    turns: Floats,
    boxes: Floats,
    out: Floats32,
) -> int:
    """Clearances (C, 16) of a motion's capsules, up to `COMFORT` or more; returns the capsules that were checked."""
    out[:] = COMFORT
    origin = places[0].copy()
    near = np.empty_like(boxes)
    count = boxes_around(boxes, origin, postures.reach + 0.5, near)
    if count == 0:
        return 0
    near[:count, :3] -= origin
    segments = pose(postures.limb, configurations)
    lanes = np.empty((segments.shape[0], 7, BLOCK), np.float32)
    place_capsules(segments, postures.limb.radii, places - origin, turns, lanes)
    return int(capsule_clearances(lanes, near, count, out))


@exact_kernel
def _between(out: Floats32, i: int, sway: float, moved: Floats, levers: Floats) -> float:
    """The bound on the clearance between looks i and i+1."""
    least = np.inf
    for c in range(levers.shape[0]):
        length = sway
        for k in range(3):
            length += levers[c, k] * moved[k]
        least = min(least, 0.5 * (out[c, i] + out[c, i + 1] - length))
    return least


@exact_kernel
def _fine_frames(
    chain: Chain, roots: RootWays, root: int, waist: Ends, is_waist: bool, first: float, last: float, sway: float
) -> tuple[Floats, Floats]:
    """The carrier's frames (FINE+1, 3), (FINE+1, 4) within a part of an interval."""
    key = roots.slots.keys[root]
    states = states_between(key[1:8], key[8:15], key[0], first, last, FINE)
    places, turns = pelvis_at(chain, states)
    if is_waist:
        return places, turns
    waists, moved = rates_between(waist, key[0], first, last, FINE)
    places, turns, _ = carry(chain, waists, moved, places, turns, np.full(FINE, sway))
    return places, turns


@exact_kernel
def limb_way(
    ways: LimbWays,
    postures: Postures,
    levers: Floats,
    chain: Chain,
    roots: RootWays,
    root: int,
    carriers: LimbWays,
    carrier: int,
    ends: Ends,
    boxes: Floats,
    wanted: float,
) -> tuple[int, int]:
    """The slot of a limb's way through an interval, and the capsules that had to be checked for it.

    It goes from posture to posture with the velocities `ends` on the way `root` and, for an arm, the waist's way
    `carrier` among `carriers`. Where less than the `wanted` clearance is found at the looks, what lies between them is
    not looked into.
    """
    is_waist, size = postures.limb.is_waist, ends[0].shape[0]
    key = np.empty(1 + 4 * size)
    key[0] = roots.slots.ids[root] if is_waist else carriers.slots.ids[carrier]
    for i in range(4):
        key[1 + i * size : 1 + (i + 1) * size] = ends[i]
    at = find(ways.slots, key)
    if at >= 0 and (ways.proven[at] > _UNKNOWN or ways.least[at] < wanted):
        return int(at), 0
    if at < 0:
        at = admit(ways.slots, key)
    interval = roots.slots.keys[root, 0]
    configurations, moved = rates_between(ends, interval, 0.0, 1.0, SWEEP)
    places = roots.places[root] if is_waist else carriers.places[carrier]
    turns = roots.turns[root] if is_waist else carriers.turns[carrier]
    sway = roots.sway[root] if is_waist else carriers.sway[carrier]
    if is_waist:
        ways.places[at], ways.turns[at], ways.sway[at] = carry(chain, configurations, moved, places, turns, sway)
    out = np.empty((levers.shape[0], BLOCK), np.float32)
    checks = _looks(postures, configurations, places, turns, boxes, out)
    ways.least[at], ways.proven[at] = out.min(), _UNKNOWN
    if out.min() < wanted:
        return int(at), checks
    waist = ends if is_waist else _ends_of(carriers, carrier)
    proven, fine = np.inf, np.empty_like(out)
    for i in range(SWEEP):
        low = _between(out, i, sway[i], moved[i], levers)
        if low < ENOUGH:
            first, last = i / SWEEP, (i + 1) / SWEEP
            frames, frame_turns = _fine_frames(chain, roots, root, waist, is_waist, first, last, sway[i])
            finer, steps = rates_between(ends, interval, first, last, FINE)
            checks += _looks(postures, finer, frames, frame_turns, boxes, fine)
            low = np.inf
            for k in range(FINE):
                low = min(low, _between(fine, k, sway[i] / FINE, steps[k], levers))
        proven = min(proven, low)
        if proven < ENOUGH:
            break
    ways.proven[at] = proven
    return int(at), checks


@exact_kernel
def _ends_of(ways: LimbWays, at: int) -> Ends:
    """Posture, velocity, posture, velocity of a way that is known."""
    key = ways.slots.keys[at]
    size = (key.shape[0] - 1) // 4
    return key[1 : 1 + size], key[1 + size : 1 + 2 * size], key[1 + 2 * size : 1 + 3 * size], key[1 + 3 * size :]
