"""When feet step: how much a standing foot is due to be lifted, and how long a swinging one takes to land."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.cycle import home_of
from elbowroom.body.gait.foot_state import SWING, YAW, X, Z, position, rests
from elbowroom.body.gait.landing_places import TWISTED, worth_a_step
from elbowroom.body.gait.own_steps import OwnSteps, own_home
from elbowroom.body.gait.stride import Stride
from elbowroom.jit import inner_exact_kernel

Floats = NDArray[np.float64]

TURNING = 0.25  # metres of a standard leg: so much way over the ground is a radian
TO_REST = 0.36  # seconds of a standard leg's swing to come to rest
_SWINGS = 0.20, 0.80  # the same, at least and at most
_HIP, _THIGH, _SHIN = 0, 8, 9  # columns of `GaitShape.legs`
_FAR = 0.75  # of a leg: a standing foot farther off has to follow soon
_OVER = 0.005  # of the cycle, by which a foot may stand longer than in an even walk
_LATE = 0.75  # of the cycle's swing: who has not lifted a foot by then leaves it
_FASTEST = 5.0  # m/s of a foot on a standard leg over the ground, where the root stands
_NEARLY = 0.12  # metres: so near it lands


@inner_exact_kernel
def away_from(foot: Floats, place: tuple[float, float, float], scale: float) -> float:
    """How far a foot is from a place (x, z, yaw): above 1 it is worth a step."""
    return worth_a_step(foot[X] - place[0], foot[Z] - place[1], foot[YAW] - place[2], scale)


@inner_exact_kernel
def is_overtaken(legs: Floats, side: int, foot: Floats) -> bool:
    """Whether a foot is so far from its hip, or so twisted, that it has to follow."""
    far = np.hypot(foot[X] - legs[side, _HIP], foot[Z] - legs[side, _HIP + 2])
    return bool(far > _FAR * (legs[side, _THIGH] + legs[side, _SHIN]) or abs(foot[YAW]) > TWISTED)


@inner_exact_kernel
def passed_ago(own: OwnSteps, legs: Floats, stride: Stride, side: int, foot: Floats) -> float:
    """How long ago the root passed by a standing foot, seconds: half its stance later the cycle lifts it."""
    x, z, _ = own_home(own, legs, stride, side)
    wide = (TURNING * stride.scale) ** 2
    way = (x - foot[X]) * stride.lateral + (z - foot[Z]) * stride.forward - wide * foot[YAW] * stride.turn
    return float(way / max(stride.speed * stride.speed + wide * stride.turn * stride.turn, 1e-12))


@inner_exact_kernel
def urge_to_step(
    own: OwnSteps,
    legs: Floats,
    stride: Stride,
    side: int,
    root: Floats,
    foot: Floats,
    goal: tuple[float, float, float],
) -> float:
    """How much a standing foot is due to be lifted; 0: it is not. The cycle would have it come down at a `goal` now."""
    if is_overtaken(legs, side, foot):
        return 1e3 + float(np.hypot(foot[X] - legs[side, _HIP], foot[Z] - legs[side, _HIP + 2]))
    if rests(root):
        x, z = home_of(legs, stride, side)
        away = away_from(foot, (x, z, 0.0), stride.scale)
        return away if away > 1.0 else 0.0
    u, late = position(root[6], side), _LATE * (1.0 - stride.duty)
    due = stride.duty <= u <= stride.duty + late
    over = passed_ago(own, legs, stride, side, foot) / stride.period - (0.5 * stride.duty + _OVER)
    if not due and over <= 0.0:
        return 0.0
    away = away_from(foot, goal, stride.scale)
    return away if away > 2.0 else 0.0


@inner_exact_kernel
def time_to_landing(
    own: OwnSteps, legs: Floats, stride: Stride, side: int, root: Floats, foot: Floats, twin: Floats, dt: float
) -> float:
    """Seconds until a swinging foot lands, `dt` seconds after it was as it is told; its twin stands or swings."""
    size, rest = np.sqrt(stride.scale), 1.0 - foot[SWING]
    least, most = rest * _SWINGS[0] * size, rest * _SWINGS[1] * size
    u = position(root[6], side)
    if rests(root):
        return float(rest * TO_REST * size - dt)
    left = (1.0 - u) * stride.period if u >= 0.5 * stride.duty else rest * TO_REST * size - dt
    if twin[SWING] <= 0.0:
        left = min(left, 0.5 * stride.duty * stride.period - passed_ago(own, legs, stride, 1 - side, twin))
        if is_overtaken(legs, 1 - side, twin):
            left = 0.0
    return float(min(max(left, least - dt), most - dt))


@inner_exact_kernel
def time_needed(stride: Stride, foot: Floats, goal: tuple[float, float, float]) -> float:
    """Seconds that a swinging foot takes at least to where it lands; none where it is nearly there."""
    way = np.hypot(goal[0] - foot[X], goal[1] - foot[Z])
    if way < _NEARLY * stride.scale:
        return 0.0
    return float(1.5 * way / (_FASTEST * np.sqrt(stride.scale) + 2.2 * stride.speed))


@inner_exact_kernel
def lifted_since(stride: Stride, side: int, root: Floats, dt: float) -> float:
    """Seconds, up to `dt`, since a foot was lifted that stood a frame ago."""
    since = (position(root[6], side) - stride.duty) * stride.period
    return float(since if 0.0 < since < dt and not rests(root) else dt)


@inner_exact_kernel
def landed_since(stride: Stride, side: int, root: Floats, dt: float) -> float:
    """Seconds, up to `dt`, since the cycle has landed a foot that swung a frame ago."""
    u = position(root[6], side)
    return float(min(u * stride.period, dt) if u < 0.5 * stride.duty and not rests(root) else 0.0)
