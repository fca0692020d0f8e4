"""How a root can move: steps of constant acceleration from key frame to key frame, steered along a route or braked.

Within a key interval the ground acceleration and the heading's are constant. `interpolate_root` shows such a step
exactly, so every bound on speed and acceleration holds at all times and not only at key frames.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.stride import climbing_rate
from elbowroom.body.root import HEIGHT, RISES
from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel, helper, inner_exact_kernel, plain
from elbowroom.planning.root.path import interpolate_between, interpolate_root, rates_at
from elbowroom.world.ground.ground import PLAIN, Ground, eased_height

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Bools = NDArray[np.bool_]

_PHASE_STEPS = 6  # midpoints per key interval when the cadence is integrated
_FIRST = plain(0)
_STILL = 1e-9  # lengths and speeds that are divided by are at least this
_REST = 1e-6  # m/s and rad/s: what is slower stands
_SIDLE = 0.55  # radians: the greatest angle between the path and the body's front when walking forward
_ASIDE = 0.5 * math.pi  # radians: and where the path leads so far aside one goes on as one faces
_RESPONSE = 4.0  # 1/s: how fast a heading error is turned away
_AIM, _AIM_LATER = 0.3, 0.3  # metres along a route to the point that is aimed at, and seconds
_NARROW = 0.6  # of the speed: who has less is on a steep stair, and aims nearer
_GRADE_OVER = 0.12  # metres to either side between which the grade is taken
SLOWED, SLOWED_FROM = 0.15, 0.75  # metres to a slow place: slowed down; and where that begins
NONE_SLOW = np.empty((0, 3))  # slow places where none is
_NOWHERE, _AWAY = 0.02, 0.05  # metres, radians: who gets no farther stands


@by_reference
class MotionBounds(NamedTuple):
    """The bounds that the kernels need."""

    turn_rate: float
    acceleration: float
    braking: float
    turn_acceleration: float
    quickness: float = 1.0  # strides of the body for one of an average adult, see `body.gait.cycle`
    ground: Ground = PLAIN  # that the root follows


class Travel(NamedTuple):
    """How a route is walked."""

    speed: float  # wanted speed along the route, m/s
    facing: float  # heading to hold; of a body that `turns`, how far its front is from where it goes: backwards pi
    turns: bool  # whether the body turns to where it goes, or its back
    stops: bool  # whether it must stand at the route's end
    slow: Floats  # (K, 3) places x, z on which it is walked at a share of the speed
    near: float  # how near a point of the route is aimed at, a share of how near it is usual


@exact_kernel
def wrapped(angle: float) -> float:
    """The same angle in [-pi, pi)."""
    return angle - 2.0 * math.pi * math.floor((angle + math.pi) / (2.0 * math.pi))


@helper
def _finish_step(
    states: Floats, k: int, vx: float, vz: float, turn: float, interval: float, bounds: MotionBounds
) -> None:
    """Write state k+1: velocities change linearly from those of state k to (vx, vz) on the ground and `turn`."""
    a, b = states[k], states[k + 1]
    sine, cosine = np.sin(a[2]), np.cos(a[2])
    b[0] = a[0] + 0.5 * interval * (a[3] * sine + a[4] * cosine + vx)
    b[1] = a[1] + 0.5 * interval * (a[3] * cosine - a[4] * sine + vz)
    b[2] = a[2] + 0.5 * interval * (a[5] + turn)
    sine, cosine = np.sin(b[2]), np.cos(b[2])
    b[3], b[4], b[5] = vx * sine + vz * cosine, vx * cosine - vz * sine, turn
    b[6:] = a[6:]
    if b.shape[0] > HEIGHT:
        _follow_ground(a, b, vx, vz, bounds.ground)
    strides, rates, between = 0.0, rates_at(a, b), np.empty(a.shape[0])
    for i in range(_PHASE_STEPS):
        interpolate_between(a, b, rates, (i + 0.5) / _PHASE_STEPS, interval, between)
        climb = between[HEIGHT + 1] if b.shape[0] > HEIGHT else 0.0
        strides += climbing_rate(between[3], between[4], between[5], climb)
    b[6] = a[6] + bounds.quickness * strides * interval / _PHASE_STEPS


@helper
def _follow_ground(a: Floats, b: Floats, vx: float, vz: float, ground: Ground) -> None:
    """Height and climb of state `b`, which moves with the velocity (vx, vz) over the ground; `a` is the one before."""
    b[RISES:] = 0.0
    b[HEIGHT], b[HEIGHT + 1] = 0.0, 0.0
    if ground.plain:
        return
    b[HEIGHT] = eased_height(ground, (a[0], a[HEIGHT], a[1]), b[0], b[1])
    speed = np.sqrt(vx * vx + vz * vz)
    if speed > _REST:
        here, dx, dz = (b[0], b[HEIGHT], b[1]), _GRADE_OVER * vx / speed, _GRADE_OVER * vz / speed
        ahead, behind = (
            eased_height(ground, here, b[0] + dx, b[1] + dz),
            eased_height(ground, here, b[0] - dx, b[1] - dz),
        )
        b[HEIGHT + 1] = speed * (ahead - behind) / (2.0 * _GRADE_OVER)


@inner_exact_kernel
def limited_step(
    states: Floats, k: int, vx: float, vz: float, turn: float, interval: float, bounds: MotionBounds
) -> None:
    """Step towards the wanted velocities as far as the accelerations allow."""
    a = states[k]
    sine, cosine = np.sin(a[2]), np.cos(a[2])
    ux, uz = a[3] * sine + a[4] * cosine, a[3] * cosine - a[4] * sine
    slows = vx * vx + vz * vz < ux * ux + uz * uz
    most = (bounds.braking if slows else bounds.acceleration) * interval
    dx, dz = vx - ux, vz - uz
    change = np.sqrt(dx * dx + dz * dz)
    part = min(1.0, most / max(change, _STILL))
    swing = bounds.turn_acceleration * interval
    rate = a[5] + min(max(turn - a[5], -swing), swing)
    _finish_step(states, k, ux + part * dx, uz + part * dz, rate, interval, bounds)


@helper
def turn_towards(state: Floats, heading: float, interval: float, bounds: MotionBounds) -> float:
    """Heading rate at the end of the next step that brings the body round to `heading` without overshoot."""
    error = wrapped(heading - state[2])
    gain = min(_RESPONSE, 1.0 / interval)
    rate: float = gain * (error - 0.5 * state[5] * interval) / (1.0 + 0.5 * gain * interval)
    return min(max(rate, -bounds.turn_rate), bounds.turn_rate)


@exact_kernel
def brake(states: Floats, first: int, interval: float, bounds: MotionBounds) -> None:
    """Fill the states after `first` by slowing down to a stand as fast as allowed."""
    for k in range(first, states.shape[0] - 1):
        limited_step(states, k, 0.0, 0.0, 0.0, interval, bounds)


@exact_kernel
def steer(states: Floats, wanted: Floats, interval: float, bounds: MotionBounds) -> None:
    """Fill the states by holding `wanted` (3,): velocity forward and to the left in the body's axes, heading rate."""
    for k in range(states.shape[0] - 1):
        swing = bounds.turn_acceleration * interval
        rate = states[k, 5] + min(max(wanted[2] - states[k, 5], -swing), swing)
        heading = states[k, 2] + 0.5 * interval * (states[k, 5] + rate)
        sine, cosine = np.sin(heading), np.cos(heading)
        vx, vz = wanted[0] * sine + wanted[1] * cosine, wanted[0] * cosine - wanted[1] * sine
        limited_step(states, k, vx, vz, wanted[2], interval, bounds)


@exact_kernel
def go_as(states: Floats, told: Floats, interval: float, bounds: MotionBounds) -> None:
    """Fill the states with steps that reach the velocities of those `told` (n+1, 7), whatever lies between.

    Seen from other key times than its own the velocities of a path bend between them, and its accelerations are those
    of both sides together; steps that reach the same velocities keep the bounds, and end about where the path does.
    """
    for k in range(states.shape[0] - 1):
        goal = told[k + 1]
        sine, cosine = np.sin(goal[2]), np.cos(goal[2])
        vx, vz = goal[3] * sine + goal[4] * cosine, goal[3] * cosine - goal[4] * sine
        limited_step(states, k, vx, vz, goal[5], interval, bounds)


@helper
def _aim(route: Floats, x: float, z: float, look_ahead: float) -> tuple[float, float, float]:
    """The point `look_ahead` metres along the route after the point nearest to (x, z), and what is left of it."""
    best, leg, part = np.inf, 0, 0.0
    for i in range(route.shape[0] - 1):
        dx, dz = route[i + 1, 0] - route[i, 0], route[i + 1, 1] - route[i, 1]
        length = max(dx * dx + dz * dz, _STILL)
        t = min(max(((x - route[i, 0]) * dx + (z - route[i, 1]) * dz) / length, 0.0), 1.0)
        distance = (route[i, 0] + t * dx - x) ** 2 + (route[i, 1] + t * dz - z) ** 2
        if distance < best:
            best, leg, part = distance, i, t
    left, ahead = 0.0, look_ahead
    aim_x, aim_z = route[-1, 0], route[-1, 1]
    found = False
    for i in range(leg, route.shape[0] - 1):
        dx, dz = route[i + 1, 0] - route[i, 0], route[i + 1, 1] - route[i, 1]
        start = part if i == leg else 0.0
        length = np.sqrt(dx * dx + dz * dz)
        rest = (1.0 - start) * length
        if not found and rest >= ahead:
            t = start + ahead / max(length, _STILL)
            aim_x, aim_z, found = route[i, 0] + t * dx, route[i, 1] + t * dz, True
        ahead -= rest
        left += rest
    return aim_x, aim_z, left


@helper
def _share_at(slow: Floats, state: Floats, interval: float) -> float:
    """The share of the wanted speed that slow places (K, 3) leave where a root state (7,) will be in a key interval."""
    sine, cosine, share = np.sin(state[2]), np.cos(state[2]), 1.0
    x = state[0] + interval * (state[3] * sine + state[4] * cosine)
    z = state[1] + interval * (state[3] * cosine - state[4] * sine)
    for n in range(slow.shape[0]):
        away = np.hypot(slow[n, 0] - x, slow[n, 1] - z)
        part = min(max((away - SLOWED) / (SLOWED_FROM - SLOWED), 0.0), 1.0)
        least = slow[n, 2] * slow[n, 2]
        share = min(share, np.sqrt(least + (1.0 - least) * part))  # slowing down evenly
    return share


@helper
def _sidled(error: float) -> float:
    """How far from the front one goes whose way leads `error` radians aside of it: who has to turn far turns first."""
    size = abs(error)
    aside = size if size < _SIDLE else _SIDLE * max(_ASIDE - size, 0.0) / (_ASIDE - _SIDLE)
    return aside if error > 0.0 else -aside


@exact_kernel
def follow(states: Floats, route: Floats, travel: Travel, interval: float, bounds: MotionBounds) -> None:
    """Fill the states by walking along `route` (m, 2), corner points x, z on the ground."""
    for k in range(states.shape[0] - 1):
        x, z, heading = states[k, 0], states[k, 1], states[k, 2]
        share = _share_at(travel.slow, states[k], interval)
        near = travel.near * min(share / _NARROW, 1.0)
        aim_x, aim_z, left = _aim(route, x, z, near * (_AIM + _AIM_LATER * travel.speed))
        speed = travel.speed * share
        if travel.stops:
            now = np.sqrt(states[k, 3] ** 2 + states[k, 4] ** 2)
            speed = min(speed, np.sqrt(bounds.acceleration * max(0.0, left - 0.5 * now * interval)))
        course = heading
        if (aim_x - x) ** 2 + (aim_z - z) ** 2 > 1e-6:
            course = np.arctan2(aim_x - x, aim_z - z)
        turn = turn_towards(states[k], course + travel.facing if travel.turns else travel.facing, interval, bounds)
        if travel.turns:
            leading = heading + 0.5 * interval * (states[k, 5] + turn) - travel.facing
            error = wrapped(course - leading)
            speed *= min(max(1.25 * np.cos(error), 0.0), 1.0)
            course = leading + _sidled(error)
        limited_step(states, k, speed * np.sin(course), speed * np.cos(course), turn, interval, bounds)


@exact_kernel
def stopping_states(
    states: Floats, interval: float, bounds: MotionBounds, spacing: float, wanted: Bools
) -> tuple[Floats, Indices]:
    """States (M, 7) of braking to a stand from key states but the first, and the key state of each (M,).

    They are at most `spacing` seconds apart, in order of the key states; `wanted` (n,) says which of these have a stop.
    """
    count = int(np.ceil(interval / spacing))
    longest = 0.0
    for k in range(1, states.shape[0]):
        longest = max(longest, np.sqrt(states[k, 3] ** 2 + states[k, 4] ** 2) / bounds.braking)
        longest = max(longest, abs(states[k, 5]) / bounds.turn_acceleration)
    steps = int(np.ceil(longest / interval)) + 1
    out = np.empty(((states.shape[0] - 1) * steps * count, states.shape[1]))
    owner = np.empty(out.shape[0], np.int64)
    tail = np.empty((steps + 1, states.shape[1]))
    used = 0
    for k in range(1, states.shape[0]):
        if not wanted[k - 1]:
            continue
        for c in range(states.shape[1]):
            tail[0, c] = states[k, c]
        brake(tail, _FIRST, interval, bounds)
        for i in range(steps):
            if abs(tail[i, 3]) + abs(tail[i, 4]) + abs(tail[i, 5]) < _REST:
                break
            for j in range(count):
                shown = interpolate_root(tail[i], tail[i + 1], (j + 1.0) / count, interval)
                for c in range(states.shape[1]):
                    out[used, c] = shown[c]
                owner[used] = k
                used += 1
    return out[:used], owner[:used]


@exact_kernel
def dense_states(states: Floats, interval: float, spacing: float, wanted: Bools) -> tuple[Floats, Indices]:
    """The shown states (M, 7) on the way to key states but the first, and the key state of each (M,).

    They are at most `spacing` seconds apart; `wanted` (n,) says which key intervals are asked for.
    """
    count = int(np.ceil(interval / spacing))
    out = np.empty(((states.shape[0] - 1) * count, states.shape[1]))
    owner, used = np.empty(out.shape[0], np.int64), 0
    for k in range(states.shape[0] - 1):
        if not wanted[k]:
            continue
        for j in range(count):
            shown = interpolate_root(states[k], states[k + 1], (j + 1.0) / count, interval)
            for c in range(states.shape[1]):
                out[used, c] = shown[c]
            owner[used] = k + 1
            used += 1
    return out[:used], owner[:used]


@exact_kernel
def gets_nowhere(states: Floats) -> bool:
    """Whether a path (n+1, 7) ends where it begins, and keeps its heading on the way."""
    least, most = states[0, 2], states[0, 2]
    for k in range(states.shape[0]):
        least, most = min(least, states[k, 2]), max(most, states[k, 2])
    gone = np.hypot(states[-1, 0] - states[0, 0], states[-1, 1] - states[0, 1])
    return bool(gone < _NOWHERE and most - least < _AWAY)
