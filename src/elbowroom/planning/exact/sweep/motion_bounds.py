"""How frames and limbs go through one key interval, and how far any point of them can get between two looks.

A **root way** is the pelvis frame at the looks, SWEEP parts of the interval; a **limb way** is what a limb does there.
`sway` is a length: no point that is carried, within `span` of the frame, moves farther in that part.

Points on rigid links: a point at distance r from the axis of a joint that turns at the rate w moves at most at r w;
speeds of joints along a chain add up; a frame's own speed is added. Rates are bounded over a part from those at its
ends: a cubic's rate is a parabola, which leaves the chord of its ends by at most |jerk| h^2 / 8.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait import hips_sinks, quickness, walk_into
from elbowroom.body.kinematics import BodyModel
from elbowroom.body.posing import place_pelvis_into
from elbowroom.jit import exact_kernel, helper
from elbowroom.planning.exact.memory.cache_index import CacheIndex, admit, find, new_cache_index
from elbowroom.planning.model.frames import compose_into
from elbowroom.planning.model.limb import Limb, LimbScratch
from elbowroom.planning.root.path import interpolate_between, rates_at

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]
Ends = tuple[Floats, Floats, Floats, Floats]  # posture, velocity, posture, velocity: of a key interval

SWEEP = 12  # parts of a key interval between two looks
_BOB = 0.05  # metres: the amplitude of the hips' bob on a standard leg is smaller
_ROTATION = 1.15  # a rotation vector of up to 1.7 rad changes at most so much faster than the rotation turns


class KinematicChain(NamedTuple):
    """What carries the limbs: legs, hips and spine."""

    legs: Floats  # (2, 10) of the gait
    scale: float
    hips: Floats  # (3,) in the root frame
    half_leg: float  # metres, the unit of the lowering
    waist: Limb
    span: float  # metres: no point of the upper body gets farther from the root's axis
    lever: float  # metres: what a rad/s of bend and twist adds at most to the speed of an arm's points, in m/s
    lift: float  # metres: what a unit of lowering moves everything


class RootSweeps(NamedTuple):
    """Pelvis frames in the world at the looks of key intervals; the key is the interval and both root states."""

    entries: CacheIndex
    places: Floats  # (S, SWEEP+1, 3)
    turns: Floats  # (S, SWEEP+1, 4)
    sway: Floats  # (S, SWEEP) metres


class LimbSweeps(NamedTuple):
    """What limbs did in key intervals; the key is the carrier's way, then posture and velocity at both ends."""

    entries: CacheIndex
    least: Floats  # (S,) clearance at the looks
    proven: Floats  # (S,) clearance between them; -inf where it was not looked into
    places: Floats  # (S, SWEEP+1, 3) of the chest in the world, for the waist; else none
    turns: Floats  # (S, SWEEP+1, 4)
    sway: Floats  # (S, SWEEP) metres, of what the chest carries


def new_root_sweeps(count: int) -> RootSweeps:
    """Room for the ways of `count` key intervals."""
    return RootSweeps(
        new_cache_index(count, 16),
        np.empty((count, SWEEP + 1, 3)),
        np.empty((count, SWEEP + 1, 4)),
        np.empty((count, SWEEP)),
    )


def new_limb_sweeps(count: int, size: int, *, carries: bool) -> LimbSweeps:
    """Room for `count` ways of a limb with `size` components."""
    frames = count if carries else 0
    return LimbSweeps(
        new_cache_index(count, 1 + 4 * size),
        np.empty(count),
        np.empty(count),
        np.empty((frames, SWEEP + 1, 3)),
        np.empty((frames, SWEEP + 1, 4)),
        np.empty((frames, SWEEP)),
    )


def chain_of(model: BodyModel, waist: Limb, reach: float) -> KinematicChain:
    """The chain of a body of which nothing that hangs on the waist gets farther than `reach` from the chest frame."""
    column = waist.chain.column
    spine, shares = column.joints[column.shares > 0.0], column.shares[column.shares > 0.0]
    stem = _stretch(model.offsets, spine)
    lever = _ROTATION * sum(
        float(share) * (_stretch(model.offsets, spine[i + 1 :]) + reach) for i, share in enumerate(shares)
    )
    span = float(np.hypot(*model.offsets[0, [0, 2]])) + stem + reach
    gait = model.gait
    return KinematicChain(
        gait.legs, gait.scale, model.offsets[0].copy(), gait.half_leg, waist, span, lever, _lift(model)
    )


def _lift(model: BodyModel) -> float:
    """How far the hips move, down and back, for a unit of lowering, metres."""
    return float(np.linalg.norm(hips_sinks(model.gait.half_leg, np.zeros(1), np.ones(1))))


def _stretch(offsets: Floats, joints: NDArray[np.int64]) -> float:
    return sum(float(np.linalg.norm(offsets[joint])) for joint in joints)


def levers_of(model: BodyModel, limb: Limb) -> Floats:
    """Bounds (C, 3) on the speed of any point of a capsule's axis in the carrier's frame, m/s for each unit of rate.

    The columns belong to the rate of the first two components together, of the third and of the fourth. Waist: bend
    and twist turn each spine joint by its part, neck and head back by theirs; the third lowers all. Arm: the
    swing turns it about the shoulder, the third component about the upper arm's own axis, the fourth about the elbow.
    """
    return _arm_levers(model, limb) if limb.chain.is_arm else _column_levers(model, limb)


def _column_levers(model: BodyModel, limb: Limb) -> Floats:
    chain = limb.chain
    levers = np.zeros((len(chain.joints), 3))
    levers[:, 1] = _lift(model) if chain.carries else 0.0
    turning = dict(zip(chain.column.joints.tolist(), np.abs(chain.column.shares).tolist(), strict=True))
    for c, joint in enumerate(chain.joints):
        ends = chain.ends[c].reshape(2, 3)
        far, speed, at = float(np.linalg.norm(ends, axis=1).max()), 0.0, int(joint)
        while at != chain.start:
            speed += turning.get(at, 0.0) * far
            far += float(np.linalg.norm(model.offsets[at]))
            at = int(model.parents[at])
        levers[c, 0] = _ROTATION * speed
    return levers


def _arm_levers(model: BodyModel, limb: Limb) -> Floats:
    chain = limb.chain
    levers = np.zeros((len(chain.joints), 3))
    shoulder, elbow = int(chain.arm.joints[0]), int(chain.arm.joints[1])
    forearm = model.offsets[elbow]
    for c, joint in enumerate(chain.joints):
        ends = chain.ends[c].reshape(2, 3)
        far, at = float(np.linalg.norm(ends, axis=1).max()), int(joint)
        if at == shoulder:
            levers[c] = far, float(np.hypot(ends[:, 1], ends[:, 2]).max()), 0.0
            continue
        while at != elbow:
            far += float(np.linalg.norm(model.offsets[at]))
            at = int(model.parents[at])
        levers[c] = np.linalg.norm(forearm) + far, np.hypot(forearm[1], forearm[2]) + far, far
    return levers


@exact_kernel
def _jerk(a: float, slope_a: float, b: float, slope_b: float, interval: float) -> float:
    """The third derivative of the cubic with these values and slopes at its ends."""
    return (12.0 * (a - b) + 6.0 * interval * (slope_a + slope_b)) / interval**3


class RootScratch(NamedTuple):
    """Room to find the way of a root in."""

    key: Floats  # (16,)
    states: Floats  # (SWEEP+1, 7)
    sinks: Floats  # (SWEEP+1, 2) as in `hips_sinks`
    drops: Floats  # (SWEEP+1,)
    foot: Floats  # (6,)
    feet: Floats  # (0, 2, 6) nobody asks for them


@exact_kernel
def root_sweeps(ways: RootSweeps, chain: KinematicChain, states: Floats, interval: float, stamps: Floats) -> Longs:
    """The slots (n,) of the root ways between states (n+1, 7); stamps (n,) tell apart what moves meanwhile."""
    scratch = RootScratch(
        np.empty(16),
        np.empty((SWEEP + 1, 7)),
        np.zeros((SWEEP + 1, 2)),
        np.empty(SWEEP + 1),
        np.empty(6),
        np.empty((0, 2, 6)),
    )
    out = np.empty(stamps.shape[0], np.int64)
    for k in range(out.shape[0]):
        out[k] = _root_sweep(ways, chain, states[k], states[k + 1], interval, stamps[k], scratch)
    return out


@exact_kernel
def _root_sweep(
    ways: RootSweeps, chain: KinematicChain, a: Floats, b: Floats, interval: float, stamp: float, scratch: RootScratch
) -> int:
    """The slot of the root way from state `a` to `b`."""
    key, states = scratch.key, scratch.states
    key[0], key[15] = interval, stamp
    for i in range(7):
        key[1 + i], key[8 + i] = a[i], b[i]
    known = find(ways.entries, key)
    if known >= 0:
        return int(known)
    at, rates = admit(ways.entries, key), rates_at(a, b)
    for i in range(SWEEP + 1):
        interpolate_between(a, b, rates, i / SWEEP, interval, states[i])
    walk_into(chain.legs, chain.scale, states, scratch.feet, scratch.drops, scratch.foot)
    for i in range(SWEEP + 1):
        scratch.sinks[i, 0] = scratch.drops[i]
    place_pelvis_into(chain.hips, states, scratch.sinks, SWEEP + 1, ways.places[at], ways.turns[at])
    _root_sway(chain, states, ways.places[at], interval, ways.sway[at])
    return int(at)


@helper
def _root_sway(chain: KinematicChain, states: Floats, places: Floats, interval: float, sway: Floats) -> None:
    a, b = states[0], states[SWEEP]
    part = interval / SWEEP
    ax, az, bx, bz, first, last = rates_at(a, b)
    jerk_x, jerk_z = _jerk(a[0], ax, b[0], bx, interval), _jerk(a[1], az, b[1], bz, interval)
    jerk, jerk_turn = np.hypot(jerk_x, jerk_z), _jerk(a[2], a[5], b[2], b[5], interval)
    stride = quickness(chain.scale) * max(first, last)
    bob = _BOB * chain.scale * (4.0 * np.pi * stride) ** 2
    speed = np.hypot(a[3], a[4])
    for i in range(SWEEP):
        one, two = states[i], states[i + 1]
        before, speed = speed, np.hypot(two[3], two[4])
        ground = max(before, speed) + jerk * part**2 / 8.0
        turn = max(abs(one[5]), abs(two[5])) + abs(jerk_turn) * part**2 / 8.0
        lift = abs(places[i + 1, 1] - places[i, 1]) / part + 0.5 * bob * part
        sway[i] = part * (ground + turn * chain.span + lift)


@exact_kernel
def configurations_into(ends: Ends, interval: float, shares: Floats, count: int, out: Floats) -> None:
    """`configurations_at` for the first `count` parts, written to `out` (N, d)."""
    q, m, p, n = ends
    for i in range(count):
        u = shares[i]
        rest = 1.0 - u
        for j in range(q.shape[0]):
            out[i, j] = rest * rest * ((1.0 + 2.0 * u) * q[j] + u * m[j] * interval) + u * u * (
                (3.0 - 2.0 * u) * p[j] - rest * n[j] * interval
            )


@exact_kernel
def configurations_at(ends: Ends, interval: float, shares: Floats) -> Floats:
    """Configurations (N, d) of a limb at parts (N,) of a key interval.

    `ends` are posture, velocity, posture, velocity at the interval's ends.
    """
    out = np.empty((shares.shape[0], ends[0].shape[0]))
    configurations_into(ends, interval, shares, shares.shape[0], out)
    return out


@exact_kernel
def moves_into(ends: Ends, interval: float, count: int, rates: Floats, moved: Floats) -> None:
    """`moves_between`, written to `moved` (count, 3); `rates` (count+2, 4) is scratch."""
    q, m, p, n = ends
    size, part, jerks = q.shape[0], interval / count, rates[count + 1]
    rates[:] = 0.0
    for j in range(size):
        jerks[j] = _jerk(q[j], m[j], p[j], n[j], interval)
        for i in range(count + 1):
            u = i / count
            rest = 1.0 - u
            rates[i, j] = (
                6.0 * u * rest * (p[j] - q[j]) / interval + rest * (rest - 2.0 * u) * m[j] + u * (u - 2.0 * rest) * n[j]
            )
    bend = part * part / 8.0
    before, jerk = np.hypot(rates[0, 0], rates[0, 1]), np.hypot(jerks[0], jerks[1])
    for i in range(count):
        after = np.hypot(rates[i + 1, 0], rates[i + 1, 1])
        moved[i, 0] = part * (max(before, after) + jerk * bend)
        before = after
        for j in range(2, 4):
            moved[i, j - 1] = part * (max(abs(rates[i, j]), abs(rates[i + 1, j])) + abs(jerks[j]) * bend)


@exact_kernel
def moves_between(ends: Ends, interval: float, count: int) -> Floats:
    """What a limb's components move at most in each of `count` equal parts of a key interval, (count, 3).

    The first two count together; then the third, the fourth.
    """
    moved = np.empty((count, 3))
    moves_into(ends, interval, count, np.empty((count + 2, 4)), moved)
    return moved


@exact_kernel
def carry(
    chain: KinematicChain,
    waist: LimbScratch,
    moved: Floats,
    places: Floats,
    turns: Floats,
    sway: Floats,
    chest: Floats,
    chest_turns: Floats,
    chest_sway: Floats,
) -> None:
    """The chest's frames in the world and its sway, for a posed `waist` on pelvis frames (N, 3), (N, 4) and their sway.

    They are written to `chest` (N, 3), `chest_turns` (N, 4) and `chest_sway` (N-1,).
    """
    compose_into(places, turns, waist.places, waist.turns, places.shape[0], chest, chest_turns)
    for i in range(sway.shape[0]):
        chest_sway[i] = sway[i] + chain.lever * moved[i, 0] + chain.lift * moved[i, 1]
