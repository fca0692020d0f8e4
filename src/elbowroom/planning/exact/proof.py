"""Whether a limb's motion in a key interval is free of everything, at every moment and not only where it was looked at.

Let c and c' be a capsule's clearances at two looks, and L a length such that no point of its axis moves farther between
them. A point of the axis that has moved by s since the first look has yet to move L - s at most until the second; the
distance from a set changes by no more than the point moves. So its clearance is at least c - s and at least
c' - (L - s), and therefore never less than (c + c' - L) / 2. Where that is not enough the part is halved.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.posing import place_pelvis
from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.clearances import COMFORT, boxes_around, capsule_clearances, place_capsules
from elbowroom.planning.exact.postures import BLOCK, Postures
from elbowroom.planning.exact.slots import admit, find
from elbowroom.planning.exact.ways import (
    SWEEP,
    Chain,
    Ends,
    LimbWays,
    RootWays,
    carry,
    configurations_at,
    moves_between,
)
from elbowroom.planning.frames import compose
from elbowroom.planning.limb import carried_frames, pose
from elbowroom.planning.root_path import interpolate_root

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

HALVINGS = 4
ENOUGH = 4e-4  # metres: proven clearance that counts as free; more than rounding, and than the bob's bend between looks
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
def _between(before: Floats32, after: Floats32, sway: float, moved: Floats, levers: Floats) -> float:
    """The bound on the clearance between two looks that found `before` (C,) and `after` (C,)."""
    least = np.inf
    for c in range(levers.shape[0]):
        length = sway
        for k in range(3):
            length += levers[c, k] * moved[k]
        least = min(least, 0.5 * (before[c] + after[c] - length))
    return least


@exact_kernel
def _frame_between(
    chain: Chain, roots: RootWays, root: int, waist: Ends, is_waist: bool, shares: Floats
) -> tuple[Floats, Floats]:
    """The carrier's frames (N, 3), (N, 4) at parts of an interval.

    The pelvis' height is read between the looks; it bends by less than `ENOUGH` counts in there.
    """
    key = roots.slots.keys[root]
    count, interval = shares.shape[0], key[0]
    states = np.empty((count, 7))
    for n in range(count):
        states[n] = interpolate_root(key[1:8], key[8:15], shares[n], interval)
    places, turns = place_pelvis(chain.hips, states, np.zeros((count, 2)))
    for n in range(count):
        look = min(int(shares[n] * SWEEP), SWEEP - 1)
        part, heights = shares[n] * SWEEP - look, roots.places[root, look : look + 2, 1]
        places[n, 1] = heights[0] + part * (heights[1] - heights[0])
    if is_waist:
        return places, turns
    waists = configurations_at(waist, interval, shares)
    inner, inner_turns = carried_frames(chain.waist, waists)
    frames: tuple[Floats, Floats] = compose(places, turns, inner, inner_turns)
    return frames


@exact_kernel
def _refined(
    postures: Postures,
    levers: Floats,
    chain: Chain,
    roots: RootWays,
    root: int,
    waist: Ends,
    ends: Ends,
    boxes: Floats,
    coarse: Floats32,
    sway: Floats,
    moved: Floats,
) -> tuple[float, int]:
    """The proven clearance of a motion whose looks found `coarse` (C, 16), and the capsules checked.

    Parts for which the bound is not enough are halved, up to `HALVINGS` times, sixteen looks at once.
    """
    is_waist, interval, count = postures.limb.is_waist, roots.slots.keys[root, 0], levers.shape[0]
    room = SWEEP << HALVINGS
    part, parent = np.empty((2, room)), np.empty((2, room), np.int64)
    known = np.empty((2, room, 2, count), np.float32)
    open_parts, proven, checks, now = 0, np.inf, 0, 0
    for i in range(SWEEP):
        low = _between(coarse[:, i], coarse[:, i + 1], sway[i], moved[i], levers)
        if low < ENOUGH:
            part[0, open_parts], parent[0, open_parts] = i / SWEEP, i
            known[0, open_parts, 0], known[0, open_parts, 1] = coarse[:, i], coarse[:, i + 1]
            open_parts += 1
        else:
            proven = min(proven, low)
    out, share = np.empty((count, BLOCK), np.float32), 1.0
    for _ in range(HALVINGS):
        share *= 0.5
        left = 0
        for begin in range(0, open_parts, BLOCK):
            batch = min(BLOCK, open_parts - begin)
            shares = part[now, begin : begin + batch] + share / SWEEP
            places, turns = _frame_between(chain, roots, root, waist, is_waist, shares)
            checks += _looks(postures, configurations_at(ends, interval, shares), places, turns, boxes, out)
            for n in range(batch):
                one, i = begin + n, parent[now, begin + n]
                for half in range(2):
                    before = known[now, one, 0] if half == 0 else out[:, n]
                    after = out[:, n] if half == 0 else known[now, one, 1]
                    low = _between(before, after, share * sway[i], share * moved[i], levers)
                    if low >= ENOUGH:
                        proven = min(proven, low)
                        continue
                    then = 1 - now
                    part[then, left], parent[then, left] = part[now, one] + half * share / SWEEP, i
                    known[then, left, 0], known[then, left, 1] = before, after
                    left += 1
        open_parts, now = left, 1 - now
        if open_parts == 0:
            return proven, checks
    return 0.0, checks


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
    configurations = configurations_at(ends, interval, np.arange(SWEEP + 1.0) / SWEEP)
    moved = moves_between(ends, interval, SWEEP)
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
    ways.proven[at], count = _refined(
        postures, levers, chain, roots, root, waist, ends, boxes, out, sway, moved
    )  # fmt: skip
    return int(at), checks + count


@exact_kernel
def _ends_of(ways: LimbWays, at: int) -> Ends:
    """Posture, velocity, posture, velocity of a way that is known."""
    key = ways.slots.keys[at]
    size = (key.shape[0] - 1) // 4
    return key[1 : 1 + size], key[1 + size : 1 + 2 * size], key[1 + 2 * size : 1 + 3 * size], key[1 + 3 * size :]
