"""How frames and limbs go through one key interval, and how far any point of them can get between two looks.

A **root way** is the pelvis frame at the looks, SWEEP parts of the interval; a **limb way** is what a limb does there.
`sway` is a length: no point that is carried, within `span` of the frame, moves farther in that part. What a limb adds
is its levers times its moves: what its components change at most in that part. Rates are bounded over a part from those
at its ends: a cubic's rate is a parabola, which leaves the chord of its ends by at most |jerk| h^2 / 8.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.cycle import walk_into
from elbowroom.body.gait.stride import quickness
from elbowroom.body.pose.kinematics import BodyModel
from elbowroom.body.pose.pelvis import place_pelvis_into
from elbowroom.body.root import HEIGHT, RISES, ROOT_STATE
from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel, helper, inner_exact_kernel
from elbowroom.planning.exact.memory.cache_index import CacheIndex, admit, begin_round, find, new_cache_index
from elbowroom.planning.model.levers import MOVES, ROTATION, lifts_of
from elbowroom.planning.model.limb import Limb
from elbowroom.planning.root.path import interpolate_between, rates_at

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]
Ends = tuple[Floats, Floats, Floats, Floats]  # posture, velocity, posture, velocity: of a key interval

SWEEP = 12  # parts of a key interval between two looks
_KNOWN = RISES  # numbers of a root state that its way depends on
_BOB = 0.05  # metres: the amplitude of the hips' bob on a standard leg is smaller


@by_reference
class KinematicChain(NamedTuple):
    """What carries the limbs: legs, hips and spine."""

    legs: Floats  # (2, 11) of the gait
    scale: float
    hips: Floats  # (3,) in the root frame
    half_leg: float  # metres, the unit of the lowering
    waist: Limb
    span: float  # metres: no point of the upper body gets farther from the root's axis
    lever: float  # metres: what a rad/s of bend and twist adds at most to the speed of an arm's points, in m/s
    lift: float  # metres: what a unit of lowering moves everything


@by_reference
class RootSweeps(NamedTuple):
    """Pelvis frames in the world at the looks of key intervals; the key is the interval and both root states."""

    entries: CacheIndex
    places: Floats  # (S, SWEEP+1, 3)
    turns: Floats  # (S, SWEEP+1, 4)
    sway: Floats  # (S, SWEEP) metres


@by_reference
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
        new_cache_index(count, 2 + 2 * _KNOWN),
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
    lever = ROTATION * sum(
        float(share) * (_stretch(model.offsets, spine[i + 1 :]) + reach) for i, share in enumerate(shares)
    )
    span = float(np.hypot(*model.offsets[0, [0, 2]])) + stem + reach
    gait, lift = model.gait, float(lifts_of(model, np.array([stem + reach]))[0])
    return KinematicChain(gait.legs, gait.scale, model.offsets[0].copy(), gait.half_leg, waist, span, lever, lift)


def _stretch(offsets: Floats, joints: NDArray[np.int64]) -> float:
    return sum(float(np.linalg.norm(offsets[joint])) for joint in joints)


@inner_exact_kernel
def _jerk(a: float, slope_a: float, b: float, slope_b: float, interval: float) -> float:
    """The third derivative of the cubic with these values and slopes at its ends."""
    return (12.0 * (a - b) + 6.0 * interval * (slope_a + slope_b)) / interval**3


class RootScratch(NamedTuple):
    """Room to find the way of a root in."""

    key: Floats  # (2 + 2 _KNOWN,)
    states: Floats  # (SWEEP+1, 7)
    sinks: Floats  # (SWEEP+1, 2) as in `hips_sinks`
    drops: Floats  # (SWEEP+1,)
    foot: Floats  # (6,)
    feet: Floats  # (0, 2, 6) nobody asks for them


@exact_kernel
def root_sweeps(ways: RootSweeps, chain: KinematicChain, states: Floats, interval: float, stamps: Floats) -> Longs:
    """The slots (n,) of the root ways between states (n+1, 7); stamps (n,) tell apart what moves meanwhile.

    They are those of a new plan: none of them is overwritten before the next call.
    """
    begin_round(ways.entries)
    scratch = RootScratch(
        np.zeros(2 + 2 * _KNOWN),
        np.empty((SWEEP + 1, ROOT_STATE)),
        np.zeros((SWEEP + 1, 2)),
        np.empty(SWEEP + 1),
        np.empty(6),
        np.empty((0, 2, 6)),
    )
    out = np.empty(stamps.shape[0], np.int64)
    for k in range(out.shape[0]):
        out[k] = _root_sweep(ways, chain, states[k], states[k + 1], interval, stamps[k], scratch)
    return out


@helper
def _root_sweep(
    ways: RootSweeps, chain: KinematicChain, a: Floats, b: Floats, interval: float, stamp: float, scratch: RootScratch
) -> int:
    """The slot of the root way from state `a` to `b`."""
    key, states = scratch.key, scratch.states
    key[0], key[-1] = interval, stamp
    for i in range(min(_KNOWN, a.shape[0])):
        key[1 + i], key[1 + _KNOWN + i] = a[i], b[i]
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
def _bend(a: Floats, b: Floats, interval: float) -> float:
    """The greatest acceleration of the height on the way from state `a` to `b`."""
    if a.shape[0] <= HEIGHT:
        return 0.0
    rise, first, last = (b[HEIGHT] - a[HEIGHT]) / interval, a[HEIGHT + 1], b[HEIGHT + 1]
    return float(max(abs(6.0 * rise - 4.0 * first - 2.0 * last), abs(6.0 * rise - 2.0 * first - 4.0 * last)) / interval)


@helper
def _root_sway(chain: KinematicChain, states: Floats, places: Floats, interval: float, sway: Floats) -> None:
    a, b = states[0], states[SWEEP]
    part = interval / SWEEP
    ax, az, bx, bz, first, last = rates_at(a, b)
    jerk_x, jerk_z = _jerk(a[0], ax, b[0], bx, interval), _jerk(a[1], az, b[1], bz, interval)
    jerk, jerk_turn = np.hypot(jerk_x, jerk_z), _jerk(a[2], a[5], b[2], b[5], interval)
    stride = quickness(chain.scale) * max(first, last)
    bob = _BOB * chain.scale * (4.0 * np.pi * stride) ** 2 + _bend(a, b, interval)
    speed = np.hypot(a[3], a[4])
    for i in range(SWEEP):
        one, two = states[i], states[i + 1]
        before, speed = speed, np.hypot(two[3], two[4])
        ground = max(before, speed) + jerk * part**2 / 8.0
        turn = max(abs(one[5]), abs(two[5])) + abs(jerk_turn) * part**2 / 8.0
        lift = abs(places[i + 1, 1] - places[i, 1]) / part + 0.5 * bob * part
        sway[i] = part * (ground + turn * chain.span + lift)


@exact_kernel
def configurations_at(ends: Ends, interval: float, shares: Floats) -> Floats:
    """Configurations (N, d) of a limb at parts (N,) of a key interval.

    `ends` are posture, velocity, posture, velocity at the interval's ends.
    """
    q, m, p, n = ends
    out = np.empty((shares.shape[0], q.shape[0]))
    for i in range(shares.shape[0]):
        u = shares[i]
        rest = 1.0 - u
        for j in range(q.shape[0]):
            out[i, j] = rest * rest * ((1.0 + 2.0 * u) * q[j] + u * m[j] * interval) + u * u * (
                (3.0 - 2.0 * u) * p[j] - rest * n[j] * interval
            )
    return out


@exact_kernel
def moves_between(ends: Ends, interval: float, count: int) -> Floats:
    """What a limb's components move at most in each of `count` equal parts of a key interval, (count, 3).

    The first two count together; then the third, the fourth.
    """
    q, m, p, n = ends
    size, part, moved = q.shape[0], interval / count, np.empty((count, MOVES))
    rates, jerks = np.zeros((count + 1, 4)), np.zeros(4)
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
    return moved


@exact_kernel
def stride_moves(a: Floats, b: Floats, interval: float, count: int) -> Floats:
    """What a root's stride changes at most in each of `count` equal parts of a key interval, (count, 3).

    Its velocity over the ground in its own axes (m/s), its turning rate (rad/s), its phase.
    """
    moved, part = np.empty((count, MOVES)), interval / count
    ax, az, bx, bz, first, last = rates_at(a, b)
    jerk_x, jerk_z = _jerk(a[0], ax, b[0], bx, interval), _jerk(a[1], az, b[1], bz, interval)
    jerk_turn, bend = _jerk(a[2], a[5], b[2], b[5], interval), part * part / 8.0
    x, z, turn = (bx - ax) / interval, (bz - az) / interval, (b[5] - a[5]) / interval
    speed, acceleration, spin, twist, done = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(count + 1):
        t = i * part
        off = t - 0.5 * interval  # a cubic's second derivative is its mean in the middle
        before, pushed, span, wound, passed = speed, acceleration, spin, twist, done
        speed = np.hypot(ax + t * (x + 0.5 * jerk_x * (t - interval)), az + t * (z + 0.5 * jerk_z * (t - interval)))
        acceleration = np.hypot(x + jerk_x * off, z + jerk_z * off)
        spin, twist = abs(a[5] + t * (turn + 0.5 * jerk_turn * (t - interval))), abs(turn + jerk_turn * off)
        done = i / count
        if first + last > 0.0:
            done = done * (2.0 * first + (last - first) * done) / (first + last)
        if i > 0:
            ground = max(speed, before) + np.hypot(jerk_x, jerk_z) * bend
            turning = max(spin, span) + abs(jerk_turn) * bend
            moved[i - 1, 0] = part * (max(acceleration, pushed) + ground * turning)
            moved[i - 1, 1] = part * max(twist, wound)
            moved[i - 1, 2] = abs(b[6] - a[6]) * (done - passed)
    return moved
