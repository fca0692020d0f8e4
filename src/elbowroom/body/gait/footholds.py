"""Feet that stand where they came down, whatever the root does: a state of the feet that goes on from frame to frame.

The walking cycle of `gait` is a function of the root's state, so its feet slide whenever velocities change. Here each
foot has a state of its own: where it is, flat, in the root's frame, and how it is pitched and lifted. One that stands
stays where it is in the world. When the cycle wants it to swing it goes, without a jump of its place or its velocity,
to where it will be under the root in the middle of its stance, as the root is planned; it lands where it is then. At an
even walk that is the cycle. Who has come to rest puts the feet beside each other, one step after the other, and so
steps who turns in place.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.cycle import GaitShape, Stride, home_of, stride_of
from elbowroom.body.gait.foot_state import (
    LIFT,
    LIFT_RATE,
    PITCH,
    SWING,
    VELOCITY,
    YAW,
    X,
    Z,
    carry,
    is_flat,
    land,
    position,
    rests,
    tilt,
)
from elbowroom.body.gait.own_steps import CYCLE, OwnSteps, own_detour, own_home, own_roll, own_stride_at
from elbowroom.body.gait.roll import least_lift, straight_part
from elbowroom.body.root import FOOT, ROOT_STATE, WITH_FEET
from elbowroom.jit import exact_kernel, helper, inner_exact_kernel, kernel, plain

Floats = NDArray[np.float64]


_LEFT, _RIGHT = plain(0), plain(1)

NO_FARTHER = np.zeros(2)
UNKNOWN = np.empty((0, 1 + ROOT_STATE))  # nothing is known of where the root will come
_HIP, _THIGH, _SHIN = 0, 8, 9  # columns of `GaitShape.legs`
_CLOSED, _TURNED = 0.012, 0.05  # metres of a standard leg, radians: feet so near their place need no step
_FAR, _TWISTED = 0.75, 0.9  # of a leg, radians: a standing foot farther off has to follow soon
_SWINGS = (0.20, 0.36, 0.80)  # seconds of a standard leg's swing: at least, to come to rest, at most
_TURNING = 0.25  # metres of a standard leg: so much way over the ground is a radian
_OVER = 0.005  # of the cycle, by which a foot may stand longer than in an even walk
_LATE = 0.75  # of the cycle's swing: who has not lifted a foot by then leaves it
_APART, _LONG = 0.13, 0.35  # metres of a standard leg: so far a foot keeps beside the other, if no farther ahead of it
_TOES_IN = 0.4  # radians: toes of one foot point no farther across the other
_HASTE = 2.0  # times as fast as else a foot of a recorded walk is lifted
_FASTEST = 5.0  # m/s of a foot on a standard leg over the ground, where the root stands
_NEARLY = 0.12  # metres: so near it lands
_DOWN = 0.14  # of a swing aside or round: so long it is over its place, and only comes down
_SLOWLY, _RISEN = 0.1, 0.15  # of how fast a foot is lifted, as it leaves the ground; of its swing until all of it
_ALMOST = 0.999  # of a swing is all of it
_BOUND, _BINDING = 0.75, 0.1  # of a swing: from then on a foot goes on to where it goes, more and more
_THERE, _LATE_SPEED = 0.004, 1.0  # metres from its place; m/s by which it goes on to another one; of a standard leg
_MORE = 0.15  # m/s by which a stance may be longer than that of an even walk


class Stepper(NamedTuple):
    """Whose feet step."""

    legs: Floats  # as in `GaitShape`
    scale: float
    own: OwnSteps


@kernel
def _beside(legs: Floats, scale: float, root: Floats, out: Floats) -> None:
    stride = stride_of(scale, 0.0, 0.0, 0.0)
    out[:] = 0.0
    for i in range(ROOT_STATE):
        out[i] = root[i]
    for side in range(2):
        at = ROOT_STATE + FOOT * side
        out[at + X], out[at + Z] = home_of(legs, stride, side)


@inner_exact_kernel
def _away(foot: Floats, place: tuple[float, float, float], scale: float) -> float:
    """How far a foot is from a place (x, z, yaw): above 1 it is worth a step."""
    apart = np.hypot(foot[X] - place[0], foot[Z] - place[1]) / (_CLOSED * scale)
    return float(max(apart, abs(foot[YAW] - place[2]) / _TURNED))


@inner_exact_kernel
def _overtaken(legs: Floats, side: int, foot: Floats) -> bool:
    """Whether a foot is so far from its hip, or so twisted, that it has to follow."""
    far = np.hypot(foot[X] - legs[side, _HIP], foot[Z] - legs[side, _HIP + 2])
    return bool(far > _FAR * (legs[side, _THIGH] + legs[side, _SHIN]) or abs(foot[YAW]) > _TWISTED)


@inner_exact_kernel
def _passed(own: OwnSteps, legs: Floats, stride: Stride, side: int, foot: Floats) -> float:
    """How long ago the root passed by a standing foot, seconds: half its stance later the cycle lifts it."""
    x, z, _ = own_home(own, legs, stride, side)
    wide = (_TURNING * stride.scale) ** 2
    way = (x - foot[X]) * stride.lateral + (z - foot[Z]) * stride.forward - wide * foot[YAW] * stride.turn
    return float(way / max(stride.speed * stride.speed + wide * stride.turn * stride.turn, 1e-12))


@inner_exact_kernel
def _urge(
    own: OwnSteps,
    legs: Floats,
    stride: Stride,
    side: int,
    root: Floats,
    foot: Floats,
    goal: tuple[float, float, float],
) -> float:
    """How much a standing foot is due to be lifted; 0: it is not. The cycle would have it come down at a `goal` now."""
    if _overtaken(legs, side, foot):
        return 1e3 + float(np.hypot(foot[X] - legs[side, _HIP], foot[Z] - legs[side, _HIP + 2]))
    if rests(root):
        x, z = home_of(legs, stride, side)
        away = _away(foot, (x, z, 0.0), stride.scale)
        return away if away > 1.0 else 0.0
    u, late = position(root[6], side), _LATE * (1.0 - stride.duty)
    due = stride.duty <= u <= stride.duty + late
    over = _passed(own, legs, stride, side, foot) / stride.period - (0.5 * stride.duty + _OVER)
    if not due and over <= 0.0:
        return 0.0
    away = _away(foot, goal, stride.scale)
    return away if away > 2.0 else 0.0


@helper
def _time_left(
    own: OwnSteps, legs: Floats, stride: Stride, side: int, root: Floats, foot: Floats, twin: Floats, dt: float
) -> float:
    """Seconds until a swinging foot lands, `dt` seconds after it was as it is told; its twin stands or swings."""
    size, rest = np.sqrt(stride.scale), 1.0 - foot[SWING]
    least, most = rest * _SWINGS[0] * size, rest * _SWINGS[2] * size
    u = position(root[6], side)
    if rests(root):
        return float(rest * _SWINGS[1] * size - dt)
    left = (1.0 - u) * stride.period if u >= 0.5 * stride.duty else rest * _SWINGS[1] * size - dt
    if twin[SWING] <= 0.0:
        left = min(left, 0.5 * stride.duty * stride.period - _passed(own, legs, stride, 1 - side, twin))
        if _overtaken(legs, 1 - side, twin):
            left = 0.0
    return float(min(max(left, least - dt), most - dt))


@inner_exact_kernel
def _root_later(root: Floats, coming: Floats, after: float, out: Floats) -> None:
    """Where the root will be `after` seconds from now, to `out` (7,).

    Straight from `root` (7,) through the `coming` (m, 8), seconds from now and root states; beyond, it keeps its
    velocities.
    """
    since, last = 0.0, coming.shape[0]
    for i in range(ROOT_STATE):
        out[i] = root[i]
    for n in range(last):
        if since >= after:
            break
        share = min((after - since) / max(coming[n, 0] - since, 1e-9), 1.0)
        for i in range(ROOT_STATE):
            out[i] += share * (coming[n, 1 + i] - out[i])
        since = min(coming[n, 0], after)
    left = after - since
    c, s = np.cos(out[2] + 0.5 * out[5] * left), np.sin(out[2] + 0.5 * out[5] * left)
    out[0] += left * (out[4] * c + out[3] * s)
    out[1] += left * (out[3] * c - out[4] * s)
    out[2] += left * out[5]


@inner_exact_kernel
def _goal(
    own: OwnSteps, legs: Floats, scale: float, side: int, root: Floats, coming: Floats, left: float, later: Floats
) -> tuple[float, float, float]:
    """Where a foot has to land in `left` seconds, or had to if that is negative, seen from the root.

    Under the root in the middle of its stance, and no farther from the root than in an even walk. `later` (7,) is
    scratch.
    """
    _root_later(root, coming, left, later)
    stride = own_stride_at(own, scale, later)
    half = 0.0 if rests(later) else 0.5 * stride.duty * stride.period
    x, z, heading, most = later[0], later[1], later[2], half * (stride.speed + _MORE * scale)
    _root_later(root, coming, left + half, later)
    far = np.hypot(later[0] - x, later[1] - z)
    part = min(1.0, most / max(far, 1e-9))
    later[0], later[1] = x + part * (later[0] - x), z + part * (later[1] - z)
    later[2] = heading + min(max(later[2] - heading, -_TWISTED), _TWISTED)
    c, s, dx, dz = np.cos(root[2]), np.sin(root[2]), later[0] - root[0], later[1] - root[1]
    left, ahead, turned = dx * c - dz * s, dx * s + dz * c, later[2] - root[2]
    x, z, yaw = own_home(own, legs, stride, side)
    c, s = np.cos(turned), np.sin(turned)
    return left + x * c + z * s, ahead - x * s + z * c, turned + yaw


@inner_exact_kernel
def _beside_twin(side: int, x: float, z: float, turned: float, scale: float) -> tuple[float, float]:
    """A place (x, z) from the standing twin, moved to the own side if need be, in axes `turned` to the left."""
    c, s, outward = np.cos(turned), np.sin(turned), 1.0 if side == 0 else -1.0
    aside, along = outward * (x * c - z * s), x * s + z * c
    aside = max(aside, _APART * scale * (1.0 - min((along / (_LONG * scale)) ** 2, 1.0)))
    aside *= outward
    return aside * c + along * s, -aside * s + along * c


@inner_exact_kernel
def _kept_apart(side: int, goal: tuple[float, float, float], twin: Floats, scale: float) -> tuple[float, float, float]:
    """A place (x, z, yaw) moved to the own side of the standing twin, and turned away from it, if need be."""
    outward = 1.0 if side == 0 else -1.0
    x, z = _beside_twin(side, goal[0] - twin[X], goal[1] - twin[Z], goal[2], scale)
    yaw = twin[YAW] + outward * max(outward * (goal[2] - twin[YAW]), -_TOES_IN)
    return x + twin[X], z + twin[Z], yaw


@helper
def _farther(goal: tuple[float, float, float], ahead: float) -> tuple[float, float, float]:
    """A place (x, z, yaw) farther ahead."""
    x, z, yaw = goal
    return x + ahead * np.sin(yaw), z + ahead * np.cos(yaw), yaw


@helper
def _way_over(stride: Stride) -> float:
    """The part of a swing in which a foot goes over the ground: in steps aside and round it only comes down then."""
    return 1.0 - _DOWN * (1.0 - straight_part(stride))


@helper
def _bound_for(
    own: OwnSteps, stride: Stride, side: int, foot: Floats, goal: tuple[float, float, float], left: float
) -> tuple[float, float, float]:
    """Where a swinging foot lands in `left` seconds that should at a place (x, z, yaw): one that nearly has, where it
    was going to, but for hardly a step's worth."""
    share = min(max((foot[SWING] - _BOUND) / _BINDING, 0.0), 1.0)
    if share <= 0.0:
        return goal
    way = _way_over(stride)
    part, left = min(foot[SWING] / way, 1.0), left * max(way - foot[SWING], 0.0) / max(1.0 - foot[SWING], 1.0 - _ALMOST)
    ahead = left * (1.0 + 2.0 * part) / (6.0 * part)  # what is left of an even swing, at the speed that it has by then
    aside = own_detour(own, stride, side, part)
    x, z, yaw = (
        foot[X] - aside[0] + ahead * foot[VELOCITY] - goal[0],
        foot[Z] - aside[1] + ahead * foot[VELOCITY + 1] - goal[1],
        foot[YAW] - aside[2] + ahead * foot[VELOCITY + 2] - goal[2],
    )
    beside = max(np.hypot(x, z) / (_CLOSED * stride.scale), abs(yaw) / _TURNED)
    share *= min(max(beside - 1.0, 0.0), 1.0) if part < 1.0 else 1.0
    return goal[0] + share * x, goal[1] + share * z, goal[2] + share * yaw


@helper
def _towards(foot: Floats, i: int, goal: float, part: float, time: float) -> None:
    """Move one number of a foot the `part` of the way to a goal where it will rest in `time` seconds: a cubic."""
    rest, start, slope = 1.0 - part, foot[i], foot[VELOCITY + i] * time
    foot[i] = rest * rest * ((1.0 + 2.0 * part) * start + part * slope) + part * part * (3.0 - 2.0 * part) * goal
    change = 6.0 * part * rest * (goal - start) + rest * (rest - 2.0 * part) * slope
    foot[VELOCITY + i] = change / time


@helper
def _time_needed(stride: Stride, foot: Floats, goal: tuple[float, float, float]) -> float:
    """Seconds that a swinging foot takes at least to where it lands; none where it is nearly there."""
    way = np.hypot(goal[0] - foot[X], goal[1] - foot[Z])
    if way < _NEARLY * stride.scale:
        return 0.0
    return float(1.5 * way / (_FASTEST * np.sqrt(stride.scale) + 2.2 * stride.speed))


@helper
def _time_over_ground(
    stride: Stride, goal: tuple[float, float, float], times: tuple[float, float], foot: Floats
) -> float:
    """Seconds in which a swinging foot goes over its place; none where it is there.

    `times` are the seconds until it lands, and until it should be over that place. It takes more of them where that has
    changed since.
    """
    (lands, over), wide = times, _TURNING * stride.scale
    way = np.hypot(goal[0] - foot[X], goal[1] - foot[Z]) + wide * abs(goal[2] - foot[YAW])
    if over <= 0.0 and way < _THERE * stride.scale:
        return 0.0
    return float(min(max(over, 1.5 * way / (_LATE_SPEED * np.sqrt(stride.scale))), lands))


@helper
def _kept(w: float) -> float:
    """How much is left, when `w` of its swing is over, of what a foot was pitched otherwise than in an even walk."""
    return float((1.0 - w) * (1.0 - w) * (1.0 + 2.0 * w))


@helper
def _swing(
    own: OwnSteps,
    stride: Stride,
    side: int,
    goal: tuple[float, float, float],
    times: tuple[float, float],
    foot: Floats,
    twin: Floats,
) -> float:
    """Let a foot swing for so many seconds, so that it lands so many after their end; the pitch that it wants.

    In steps aside and round it is over its place before it comes down: it would rub over the ground.
    """
    (dt, left), done = times, foot[SWING]
    after = done + (1.0 - done) * dt / (left + dt)
    way = _way_over(stride)
    over, there = min(done / way, 1.0), min(after / way, 1.0)
    before, then = own_detour(own, stride, side, over), own_detour(own, stride, side, there)
    for i in range(3):
        foot[i] -= before[i]
    time = _time_over_ground(stride, goal, (left + dt, (left + dt) * (way - done) / (1.0 - done)), foot)
    for i in range(3):
        if time > 0.0:
            _towards(foot, i, goal[i], min(dt / time, 1.0), time)
        else:
            foot[VELOCITY + i] = 0.0
        foot[i] += then[i]
    half = 0.5 * stride.duty * stride.period
    sag = min(max(0.5 * stride.forward * stride.turn * half * half, -0.1 * stride.scale), 0.1 * stride.scale)
    foot[X] -= sag * 16.0 * ((there * (1.0 - there)) ** 2 - (over * (1.0 - over)) ** 2)
    x, z = _beside_twin(side, foot[X] - twin[X], foot[Z] - twin[Z], 0.0, stride.scale)
    foot[X], foot[Z], foot[SWING] = twin[X] + x, twin[Z] + z, after
    rest = 1.0 - stride.duty
    left_off, _ = own_roll(own, stride, side, stride.duty + rest * done)
    pitch, lift = own_roll(own, stride, side, stride.duty + rest * after)
    pitch += (foot[PITCH] - left_off) * _kept(after) / max(_kept(done), _kept(_ALMOST))
    low = least_lift(stride, after)
    most = LIFT_RATE * dt * min(_SLOWLY + after / _RISEN, 1.0) * (1.0 if own.speed <= 0.0 else _HASTE)
    foot[LIFT] += min(max(max(lift, low) - foot[LIFT], -most), most)
    if left <= 0.0:
        land(foot)
    return float(pitch)


@helper
def _lifted_since(stride: Stride, side: int, root: Floats, dt: float) -> float:
    """Seconds, up to `dt`, since a foot was lifted that stood a frame ago."""
    since = (position(root[6], side) - stride.duty) * stride.period
    return float(since if 0.0 < since < dt and not rests(root) else dt)


@helper
def _landed_since(stride: Stride, side: int, root: Floats, dt: float) -> float:
    """Seconds, up to `dt`, since the cycle has landed a foot that swung a frame ago."""
    u = position(root[6], side)
    return float(min(u * stride.period, dt) if u < 0.5 * stride.duty and not rests(root) else 0.0)


@helper
def _pitch_in_stance(own: OwnSteps, legs: Floats, stride: Stride, side: int, foot: Floats) -> float:
    """How a standing foot wants to be pitched: by how far the root has passed it."""
    u = 0.5 * stride.duty + _passed(own, legs, stride, side, foot) / stride.period
    pitch, _ = own_roll(own, stride, side, min(max(u, 0.0), stride.duty * (1.0 - 1e-9)))
    return pitch


@exact_kernel
def step_feet(
    who: Stepper, before: Floats, root: Floats, dt: float, coming: Floats, farther: Floats, out: Floats
) -> None:
    """The feet `dt` seconds later: `out` (WITH_FEET,) is for `root` (7,) what `before` (WITH_FEET,) was then.

    They step to where the root is meant to come: `coming` (m, 8), seconds from now and root states; where nothing is
    known of that it keeps its velocities; and so many metres `farther` (2,) ahead. With `dt` 0 nothing moves over the
    ground, a swinging foot neither.
    """
    legs, scale, own = who
    carry(before, root, out)
    if dt <= 0.0:
        return
    stride = own_stride_at(own, scale, root)
    one, other = out[ROOT_STATE : ROOT_STATE + FOOT], out[ROOT_STATE + FOOT :]
    standing = one[SWING] <= 0.0 and other[SWING] <= 0.0
    lifted, later = -1, np.empty(ROOT_STATE)
    if standing:
        left = _urge(own, legs, stride, _LEFT, root, one, _goal(own, legs, scale, _LEFT, root, coming, 0.0, later))
        right = _urge(own, legs, stride, _RIGHT, root, other, _goal(own, legs, scale, _RIGHT, root, coming, 0.0, later))
        if max(left, right) > 0.0:
            lifted = 0 if left >= right else 1
    for side in range(2):
        (foot, twin), pitch = (one, other) if side == 0 else (other, one), 0.0
        if foot[SWING] > 0.0 or lifted == side:
            since = dt
            if lifted == side:
                since = _lifted_since(stride, side, root, dt)
                tilt(foot, _pitch_in_stance(own, legs, stride, side, foot), dt - since)
            left = max(_time_left(own, legs, stride, side, root, foot, twin, since), 0.0)
            lands = left if left > 0.0 else -_landed_since(stride, side, root, dt)
            under = _goal(own, legs, scale, side, root, coming, lands, later)
            goal = _kept_apart(side, _farther(under, farther[side]), twin, scale)
            goal = _bound_for(own, stride, side, foot, goal, since + left)
            needed = _time_needed(stride, foot, goal)
            if left < needed and not _overtaken(legs, 1 - side, twin):  # what it goes to has changed
                left, rest = needed, needed / (_SWINGS[1] * np.sqrt(scale))
                under = _goal(own, legs, scale, side, root, coming, left, later)
                goal = _kept_apart(side, _farther(under, farther[side]), twin, scale)
                foot[SWING] = min(foot[SWING], max(1.0 - rest, 0.2))
            pitch = _swing(own, stride, side, goal, (since, left), foot, twin)
        if foot[SWING] <= 0.0:
            pitch = _pitch_in_stance(own, legs, stride, side, foot)
        tilt(foot, pitch, dt)


@inner_exact_kernel
def landing(
    who: Stepper, row: Floats, side: int, coming: Floats, farther: Floats, later: Floats
) -> tuple[float, float, float, float]:
    """Where a foot that swings in a row (WITH_FEET or more,) will land: x, z and yaw seen from the root; in how long.

    `coming` (m, 8), seconds from the row, and `farther` (2,) are as in `step_feet`; `later` (7,) is scratch.
    """
    legs, scale, own = who
    foot, twin = row[ROOT_STATE + FOOT * side :], row[ROOT_STATE + FOOT * (1 - side) :]
    stride = own_stride_at(own, scale, row)
    left = max(_time_left(own, legs, stride, side, row, foot, twin, 0.0), 0.0)
    under = _goal(own, legs, scale, side, row, coming, left, later)
    goal = _kept_apart(side, _farther(under, farther[side]), twin, scale)
    goal = _bound_for(own, stride, side, foot, goal, left)
    return goal[0], goal[1], goal[2], max(left, _time_needed(stride, foot, goal))


@kernel
def _settled(legs: Floats, scale: float, row: Floats) -> bool:
    stride, near = stride_of(scale, 0.0, 0.0, 0.0), True
    for side in range(2):
        foot = row[ROOT_STATE + FOOT * side : ROOT_STATE + FOOT * (side + 1)]
        x, z = home_of(legs, stride, side)
        still = foot[SWING] <= 0.0 and is_flat(foot)
        near = near and still and _away(foot, (x, z, 0.0), scale) <= 1.0
    return near


def beside(gait: GaitShape, root: Floats) -> Floats:
    """A root state (7,) with feet that stand beside each other under it: (WITH_FEET,)."""
    out = np.empty(WITH_FEET)
    _beside(gait.legs, gait.scale, root, out)
    return out


def onward(
    gait: GaitShape, before: Floats, root: Floats, dt: float, coming: Floats = UNKNOWN, own: OwnSteps = CYCLE
) -> Floats:
    """`root` (7 or more,) with the feet (WITH_FEET,) that follow on those of `before` within `dt` seconds.

    `coming` (m, 8) are seconds from now and root states that the root is meant to come to. Steps ahead are a walker's
    `own`.
    """
    out = np.empty(WITH_FEET)
    who = Stepper(gait.legs, gait.scale, own)
    step_feet(who, before, root[:ROOT_STATE].copy(), dt, coming, NO_FARTHER, out)
    return out


def settled(gait: GaitShape, row: Floats) -> bool:
    """Whether the feet of a row (WITH_FEET,) stand beside each other, so that who rests makes no step."""
    return bool(_settled(gait.legs, gait.scale, row))
