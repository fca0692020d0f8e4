"""A plain walking cycle tied to the root's motion: foot paths and the bob of the pelvis, at the cadence of `stride.py`.

The stance foot stands still in the world: in the root's frame it moves exactly opposite to the root, turn included. It
comes down on its heel, lies flat, and rolls over the joint of the toes, which stay where they are. The swing foot
returns on a cubic that meets the stance foot's velocity at both ends. How the foot rolls and the hips go up and down is
fitted so that the knee, which follows from both, goes through a stride as people's do (docs/motion.md). Everything is
a function of the root state alone; with the speed every excursion goes to zero, so that a body at rest stands with its
feet together. Only the hips are free to come lower than the walk has them (`lowered_hips.py`).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.smoothstep import smoothstep
from elbowroom.body.gait.stride import CLIMB, STANDARD_LEG, Stride, climbing_stride, stride_at
from elbowroom.body.gait.tilted_foot import bump, ease_of, own_roll, tilt_foot
from elbowroom.body.skeleton import Skeleton
from elbowroom.body.soles import PITCHES, Soles
from elbowroom.jit import helper, inner_kernel, kernel

Floats = NDArray[np.float64]

# Columns of `GaitShape.legs`: hip and ankle in T-pose (root frame), ball before and heel behind the ankle, thigh, shin,
# height of the toes' joint above the sole, how much of what it would the foot is pitched, toes down and up, and how
# much of that its toes hang loose; from there on how much farther ahead, and higher, its own feet have the ankle at
# `PITCHES`.
_HIP, _ANKLE, _THIGH, _SHIN, _OWN = 0, 3, 8, 9, 14

_HEEL_STRIKE, _TOE_OFF = 0.292, 0.92  # radians of foot pitch
_FLAT, _RISE = 0.16, 0.45  # of the stance: from when on the foot is flat, and its heel rises
_ROLL, _ROLLING = 4.0, 0.5  # how late the heel rises, and how fast it still does so at toe-off
_LIFT, _EARLY = 0.056, 0.6  # metres, of the swinging foot on a standard leg, and how much more of it comes early
_BEHIND = 0.062  # metres that a standard leg's stance lies behind the hips
_BOB, _LOWEST = 0.0292, 0.0132  # metres, of the hips' way up and down, and the phase at which they are lowest
_BOB_ASIDE = 2.4  # metres, of the same in steps aside, for the square of how wide they are
_STRETCH, _STRIDE_STRETCH = 0.999, 0.9981  # how straight the longest leg of the cycle gets, standing and walking

_HEEL, _TOE = 0.092, 0.09  # of an average leg's length, behind the ankle and before the joint of the toes


class GaitShape(NamedTuple):
    """What the walking cycle needs of a body."""

    legs: Floats  # (2, 48) left and right leg, metres
    scale: float  # leg length / that of an average adult
    half_leg: float  # half the length of thigh and shin together, metres: the unit of the lowering


def gait_shape(skeleton: Skeleton, soles: Soles | None = None) -> GaitShape:
    """Measure the legs of a skeleton; feet roll as average ones, or as the `soles` do if these are told.

    Without toes that bend they roll over the tips. Over edges that are farther out than an average foot's they are
    pitched as much less, and longer toes hang less, so that no tip drags.
    """
    legs = np.zeros((2, _OWN + 2 * len(PITCHES)))
    for i, side in enumerate(("left", "right")):
        reach = None if soles is None else (float(soles.heels[i]), float(soles.tips[i]))
        legs[i, :_OWN] = _measured(skeleton, side, reach)
        if soles is not None:
            legs[i, _OWN:] = own_roll(legs[i], soles.rolls[i]).ravel()
    leg = float((legs[:, _THIGH] + legs[:, _SHIN]).mean())
    return GaitShape(legs, leg / STANDARD_LEG, 0.5 * leg)


def _measured(skeleton: Skeleton, side: str, reach: tuple[float, float] | None) -> list[float]:
    """The columns of one leg, whose sole may `reach` so far behind the ankle, and before it."""
    at = dict(zip(skeleton.names, skeleton.positions, strict=True))
    hip, knee, ankle = at[f"{side}UpperLeg"], at[f"{side}LowerLeg"], at[f"{side}Foot"]
    thigh, shin = float(np.linalg.norm(knee - hip)), float(np.linalg.norm(ankle - knee))
    leg, bends = thigh + shin, f"{side}Toes" in at
    toes = at[f"{side}Toes"] if bends else ankle + np.array([0.0, -ankle[1], 0.18 * leg])
    ball, above = max(float(toes[2] - ankle[2]), 0.01), float(min(max(toes[1], 0.0), 0.5 * ankle[1]))
    heel, tip = reach or (0.0, ball)
    edge = max(tip, 0.01) if reach and not bends else ball
    back, toe = max(heel, _HEEL * leg), max(tip - ball, _TOE * leg)
    less = [min(ball / edge, 1.0), _HEEL * leg / back, _TOE * leg / toe]
    return [*hip.tolist(), *ankle.tolist(), edge, back, thigh, shin, above, *less]


@inner_kernel
def _hermite(a: float, slope_a: float, b: float, slope_b: float, w: float) -> float:
    """Cubic from `a` to `b` over w in [0, 1]."""
    rest = 1.0 - w
    return rest * rest * ((1.0 + 2.0 * w) * a + w * slope_a) + w * w * ((3.0 - 2.0 * w) * b - rest * slope_b)


@helper
def _pitch_ahead(u: float, duty: float) -> float:
    """Foot pitch when walking forward, positive toes down: heel strike, flat foot, push-off into the swing."""
    if u < duty:
        x = min(max((u / duty - _RISE) / (1.0 - _RISE), 0.0), 1.0)
        rise = x**_ROLL * (1.0 + (_ROLL - _ROLLING) * (1.0 - x))
        return float(_TOE_OFF * rise - _HEEL_STRIKE * (1.0 - smoothstep(u / (_FLAT * duty))))
    rolling = _TOE_OFF * _ROLLING / (duty * (1.0 - _RISE)) * (1.0 - duty)
    return _hermite(_TOE_OFF, rolling, -_HEEL_STRIKE, 0.0, (u - duty) / (1.0 - duty))


@helper
def _pitch_back(u: float, duty: float) -> float:
    """Foot pitch when walking backward: toes first, then the flat foot, heel last."""
    strike, lift = 0.37, -0.19
    if u < duty:
        return strike * (1.0 - smoothstep(u / (0.3 * duty))) + lift * smoothstep((u - 0.7 * duty) / (0.3 * duty))
    return lift + (strike - lift) * smoothstep((u - duty) / (1.0 - duty))


@inner_kernel
def _foot_on_ground(
    x: float, z: float, time: float, forward: float, lateral: float, turn: float
) -> tuple[float, float]:
    """Where a point fixed to the ground is in the root frame, `time` after it was at (x, z)."""
    angle = turn * time
    if abs(angle) < 1e-6:
        along, across = time, 0.5 * angle * time
    else:
        along, across = np.sin(angle) / turn, (1.0 - np.cos(angle)) / turn
    px = x - lateral * along - forward * across
    pz = z + lateral * across - forward * along
    return px * np.cos(angle) - pz * np.sin(angle), px * np.sin(angle) + pz * np.cos(angle)


@kernel
def home_of(legs: Floats, stride: Stride, side: int) -> tuple[float, float]:
    """Where a flat foot's ankle is in the root frame in the middle of its stance, x and z."""
    ahead, scale = stride.ahead, stride.scale
    outward = 1.0 if side == 0 else -1.0
    x = legs[side, _ANKLE] * (1.0 - 0.25 * min(abs(ahead), 1.0))
    x += outward * scale * (np.sqrt(stride.aside * stride.aside + 1e-4) - 1e-2)
    x += outward * 0.02 * scale * min(abs(stride.turn) * stride.period, 1.5)
    return x, legs[side, _ANKLE + 2] - _BEHIND * scale * max(ahead, 0.0)


@inner_kernel
def roll_of(stride: Stride, u: float) -> tuple[float, float]:
    """Pitch of a foot at cycle position `u`, radians, positive toes down; and how high it is lifted, metres."""
    duty, ahead = stride.duty, stride.ahead
    lift = 0.0
    if u >= duty:
        w = (u - duty) / (1.0 - duty)
        lift = _LIFT * stride.scale * stride.effort * bump(w) * (1.0 + _EARLY * (1.0 - 2.0 * w))
    pitch = ahead * _pitch_ahead(u, duty) if ahead >= 0.0 else -ahead * _pitch_back(u, duty)
    return pitch, lift


@kernel
def flat_place(legs: Floats, stride: Stride, side: int, u: float) -> tuple[float, float, float, float]:
    """Ankle x, z and yaw of the flat foot at cycle position `u` in [0, 1), in the root frame; what is over of a swing.

    That is 0 in the stance.
    """
    forward, lateral, turn, period, duty = stride.forward, stride.lateral, stride.turn, stride.period, stride.duty
    x0, z0 = home_of(legs, stride, side)
    half, w = 0.5 * duty * period, 0.0
    if u < duty:
        time = (u - 0.5 * duty) * period
        x, z = _foot_on_ground(x0, z0, time, forward, lateral, turn)
        yaw = -turn * time
    else:
        w, swing = (u - duty) / (1.0 - duty), (1.0 - duty) * period
        ax, az = _foot_on_ground(x0, z0, half, forward, lateral, turn)
        bx, bz = _foot_on_ground(x0, z0, -half, forward, lateral, turn)
        x = _hermite(ax, swing * (-turn * az - lateral), bx, swing * (-turn * bz - lateral), w)
        z = _hermite(az, swing * (turn * ax - forward), bz, swing * (turn * bx - forward), w)
        yaw = _hermite(-turn * half, -turn * swing, turn * half, -turn * swing, w)
        sag = 0.5 * forward * turn * half * half  # in a turn, both ends of the step lie this far towards its inside
        x -= min(max(sag, -0.1 * stride.scale), 0.1 * stride.scale) * bump(w)
    return x, z, yaw, w


@inner_kernel
def _foot_pose(legs: Floats, stride: Stride, side: int, u: float, out: Floats) -> None:
    """Ankle (x, y, z), yaw, pitch and toe bend of one foot at cycle position `u` in [0, 1), in the root frame."""
    x, z, yaw, w = flat_place(legs, stride, side, u)
    tilt_foot(legs, side, (x, z, yaw), roll_of(stride, u), ease_of(stride.ahead, w), out)


@inner_kernel
def too_high(foot: Floats, hip: tuple[float, float, float], reach: float) -> float:
    """How far a hip is above where its foot (6,) is as far from it as it reaches, metres; below it less than 0."""
    x, z = foot[0] - hip[0], foot[2] - hip[2]
    return float(hip[1] - foot[1] - np.sqrt(max(reach * reach - x * x - z * z, 0.25 * reach * reach)))


@helper
def _needed_drop(legs: Floats, side: int, foot: Floats, stretch: float) -> float:
    """How far the pelvis must come down for the leg to reach the ankle."""
    hip = (legs[side, _HIP], legs[side, _HIP + 1], legs[side, _HIP + 2])
    return float(max(too_high(foot, hip, stretch * (legs[side, _THIGH] + legs[side, _SHIN])), 0.0))


@inner_kernel
def _bob(stride: Stride, phase: float) -> float:
    """How far the hips are below the highest place of their stride: they are lowest while both feet stand."""
    long, wide = stride.ahead**4, stride.aside**2
    ahead = _BOB * 2.0 * long / (1.0 + long) * (0.5 + 0.5 * np.cos(4.0 * np.pi * (phase - _LOWEST)))
    aside = _BOB_ASIDE * wide * (0.5 + 0.5 * np.cos(4.0 * np.pi * (phase - 0.5 * (stride.duty - 0.5))))
    return float(stride.scale * (ahead + aside))


@helper
def _highest(legs: Floats, stride: Stride, foot: Floats) -> float:
    """How far the hips are below T-pose where they are highest, so that feet reach the ground; `foot` is scratch."""
    stretch = _STRETCH + (_STRIDE_STRETCH - _STRETCH) * smoothstep(stride.speed / stride.scale)
    low = 0.0
    for side in range(2):
        for u in (0.0, 0.5 * stride.duty, 0.7 * stride.duty, 0.85 * stride.duty, stride.duty * (1.0 - 1e-9), 0.96):
            _foot_pose(legs, stride, side, u, foot)
            if u > stride.duty:
                foot[0] = legs[side, _HIP]  # aside a swinging foot may stay short of its way
            low = max(low, _needed_drop(legs, side, foot, stretch) - _bob(stride, u))
    return low


@inner_kernel
def walk_into(legs: Floats, scale: float, roots: Floats, feet: Floats, drops: Floats, scratch: Floats) -> None:
    """`foot_poses`, written to `feet` (N, 2, 6), or (0, 2, 6) where nobody asks for them, and `drops` (N,).

    `scratch` (6,) is a foot's.
    """
    stride, low, wanted, climb = climbing_stride(scale, 0.0, 0.0, 0.0, 0.0), -1.0, feet.shape[0] > 0, 0.0
    for n in range(len(roots)):
        forward, lateral, turn, phase = roots[n, 3], roots[n, 4], roots[n, 5], roots[n, 6]
        climbs = roots[n, CLIMB] if roots.shape[1] > CLIMB else 0.0
        same = forward == stride.forward and lateral == stride.lateral and turn == stride.turn and climbs == climb
        if low < 0.0 or not same:
            stride, climb = climbing_stride(scale, forward, lateral, turn, climbs), climbs
            low = _highest(legs, stride, scratch)
        if wanted:
            for side in range(2):
                cycle = phase + 0.5 * side
                _foot_pose(legs, stride, side, cycle - np.floor(cycle), feet[n, side])
        drops[n] = low + _bob(stride, phase)


@kernel
def foot_poses(legs: Floats, scale: float, roots: Floats) -> tuple[Floats, Floats]:
    """Feet and pelvis of the walking cycle for root states (N, 7).

    Returns the feet (N, 2, 6) in the root frame: ankle x, y, z, yaw, pitch (positive toes down), bend of the toes; and
    how far the hips are below their height in T-pose (N,).
    """
    feet, drops = np.empty((len(roots), 2, 6)), np.empty(len(roots))
    walk_into(legs, scale, roots, feet, drops, np.empty(6))
    return feet, drops


@inner_kernel
def stood_places(legs: Floats, scale: float, root: Floats, side: int, out: Floats) -> float:
    """Where a foot stands or stood last, and where it stands next if the root keeps its velocities; how far it is.

    Ankle x, z and yaw of the flat foot in the root frame, twice, to `out` (6,). Returns the part of the swing that is
    over, 0 for a foot that stands.
    """
    stride = stride_at(scale, root)
    cycle = root[6] + 0.5 * side
    u, half = cycle - np.floor(cycle), 0.5 * stride.duty
    _foot_pose(legs, stride, side, half, out)
    x, z = out[0], out[2]
    for k in range(2):
        time = (u - half - k) * stride.period
        at = 3 * k
        out[at], out[at + 1] = _foot_on_ground(x, z, time, stride.forward, stride.lateral, stride.turn)
        out[at + 2] = -stride.turn * time
    return float(max(u - stride.duty, 0.0) / (1.0 - stride.duty))
