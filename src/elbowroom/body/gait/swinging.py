"""How a foot swings to where it lands: over the ground without a jump of its place or velocity, rolled and lifted."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.foot_state import LIFT, LIFTING, PITCH, ROLLING, SWING, VELOCITY, YAW, Goal, X, Z, eased, land
from elbowroom.body.gait.landing_places import LOWER, beside_twin, borne_pitch, way_over
from elbowroom.body.gait.own_steps import OwnSteps, own_detour, own_roll
from elbowroom.body.gait.roll import least_lift, straight_part
from elbowroom.body.gait.stepping_times import TURNING
from elbowroom.body.gait.stride import Stride
from elbowroom.jit import helper, inner_exact_kernel

Floats = NDArray[np.float64]

_LIFTS, _ROLLS = 16.0, 10.0  # 1/s: how soon what a foot is lifted and pitched beside its cycle fades
_LANDS = 4.0  # the same, in parts of the time that is left until it lands, where that is sooner
_MOMENT = 1e-4  # of a swing, over which it is seen how fast it goes
_THERE, _LATE_SPEED = 0.004, 1.0  # metres from its place; m/s by which it goes on to another one; of a standard leg


@helper
def _towards(foot: Floats, i: int, goal: float, part: float, time: float) -> None:
    """Move one number of a foot the `part` of the way to a goal where it will rest in `time` seconds: a cubic."""
    rest, start, slope = 1.0 - part, foot[i], foot[VELOCITY + i] * time
    foot[i] = rest * rest * ((1.0 + 2.0 * part) * start + part * slope) + part * part * (3.0 - 2.0 * part) * goal
    change = 6.0 * part * rest * (goal - start) + rest * (rest - 2.0 * part) * slope
    foot[VELOCITY + i] = change / time


@helper
def _time_over_ground(
    stride: Stride, goal: tuple[float, float, float], times: tuple[float, float], part: float, foot: Floats
) -> float:
    """Seconds in which a swinging foot goes over its place; none where it is there.

    `times` are the seconds until it lands, and until it should be over that place, for which it has that `part` of an
    even swing. It takes more of them where that has changed since, and it would be much faster than evenly ahead.
    """
    (lands, over), wide = times, TURNING * stride.scale
    evenly = straight_part(stride) * stride.speed / ((1.0 - stride.duty) * part)
    way = np.hypot(goal[0] - foot[X], goal[1] - foot[Z]) + wide * abs(goal[2] - foot[YAW])
    if over <= 0.0 and way < _THERE * stride.scale:
        return 0.0
    return float(min(max(over, 1.5 * way / (_LATE_SPEED * np.sqrt(stride.scale) + 1.5 * evenly)), lands))


@helper
def _goes(own: OwnSteps, stride: Stride, side: int, w: float, pace: float, lands: Floats) -> tuple[Goal, Goal]:
    """Pitch and lift, each with its rate, when `w` of a swing is over that goes on at a pace, 1/s, and `lands` so."""
    rest, first = 1.0 - stride.duty, min(w, 1.0 - _MOMENT)
    before, low = own_roll(own, stride, side, stride.duty + rest * first)
    after, high = own_roll(own, stride, side, stride.duty + rest * (first + _MOMENT))
    low, high = max(low, least_lift(stride, first)), max(high, least_lift(stride, first + _MOMENT))
    before, after = max(before, borne_pitch(lands, before)), max(after, borne_pitch(lands, after))  # only toes up
    u, pace = (w - first) / _MOMENT, pace / _MOMENT
    return (before + u * (after - before), pace * (after - before)), (low + u * (high - low), pace * (high - low))


@inner_exact_kernel
def swing_foot(
    own: OwnSteps,
    stride: Stride,
    side: int,
    goal: tuple[float, float, float],
    times: tuple[float, float],
    lands: Floats,
    foot: Floats,
    twin: Floats,
) -> None:
    """Let a foot swing for so many seconds, so that it lands so many after their end.

    It `lands` (LANDS,) as in `landing_places`, and is over its place before it comes down: it would rub over the
    ground, in steps aside and round, or over an edge.
    """
    (dt, left), done, way = times, foot[SWING], way_over(stride, lands[LOWER])
    after = done + (1.0 - done) * dt / (left + dt)
    over, there = min(done / way, 1.0), min(after / way, 1.0)
    before, then = own_detour(own, stride, side, over), own_detour(own, stride, side, there)
    for i in range(3):
        foot[i] -= before[i]
    time = _time_over_ground(stride, goal, (left + dt, (left + dt) * (way - done) / (1.0 - done)), way, foot)
    for i in range(3):
        if time > 0.0:
            _towards(foot, i, goal[i], min(dt / time, 1.0), time)
        else:
            foot[VELOCITY + i] = 0.0
        foot[i] += then[i]
    half = 0.5 * stride.duty * stride.period
    sag = min(max(0.5 * stride.forward * stride.turn * half * half, -0.1 * stride.scale), 0.1 * stride.scale)
    foot[X] -= sag * 16.0 * ((there * (1.0 - there)) ** 2 - (over * (1.0 - over)) ** 2)
    x, z = beside_twin(side, foot[X] - twin[X], foot[Z] - twin[Z], 0.0, stride.scale)
    foot[X], foot[Z], foot[SWING] = twin[X] + x, twin[Z] + z, after
    pace = (1.0 - done) / (left + dt)
    pitch, lift = _goes(own, stride, side, done, pace, lands)
    next_pitch, next_lift = _goes(own, stride, side, after, pace, lands)
    rolls, lifts = max(_ROLLS, _LANDS / (left + dt)), max(_LIFTS, _LANDS / (left + dt))
    foot[PITCH], foot[ROLLING] = eased((foot[PITCH], foot[ROLLING]), pitch, next_pitch, rolls, dt)
    foot[LIFT], foot[LIFTING] = eased((foot[LIFT], foot[LIFTING]), lift, next_lift, lifts, dt)
    foot[LIFT] = max(foot[LIFT], 0.0)
    if left <= 0.0:
        land(foot)
