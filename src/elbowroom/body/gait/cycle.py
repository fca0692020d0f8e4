"""A plain walking cycle tied to the root's motion: cadence, foot paths and the bob of the pelvis.

The stance foot stands still in the world: in the root's frame it moves exactly opposite to the root, turn included. It
comes down on its heel, lies flat, and rolls over the joint of the toes, which stay where they are. The swing foot
returns on a cubic that meets the stance foot's velocity at both ends. How the foot rolls and the hips go up and down is
fitted so that the knee, which follows from both, goes through a stride as people's do (docs/motion.md). Everything is
a function of the root state alone; with the speed every excursion goes to zero, so that a body at rest stands with its
feet together. Only the hips are free to come lower than the walk has them: `hips_sinks`.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import HEIGHT
from elbowroom.body.skeleton import Skeleton
from elbowroom.jit import brief_kernel, helper, inner_kernel, kernel

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

STANDARD_LEG = 0.491 * 1.72  # metres: thigh and shin of an average adult, see `proportions`

# Columns of `GaitShape.legs`: hip and ankle in T-pose (root frame), ball before and heel behind the ankle, thigh, shin,
# height of the toes' joint above the sole.
_HIP, _ANKLE, _BALL, _HEEL, _THIGH, _SHIN, _TOES = 0, 3, 6, 7, 8, 9, 10

_CLIMB = HEIGHT + 1  # column of root states: how fast they go up

_STATURE = 1.72  # metres, of the standard leg
_CADENCE = 64.8 / 60.0  # strides/s at one stature per second
_SLOW = (0.30 / _STATURE) ** 2  # below some 0.3 m/s cadence is constant and strides shrink
_PACE = 0.57  # power of a body's size by which its strides are quicker at the same speed
_STILL = 1e-3  # m/s: below, the phase rests
_RISE_OF_STEP = 0.17  # metres that a step leads up or down at most, on the whole: a tread
_LATERAL, _TURN, _BACK = 2.3, 1.2, 1.25  # such steps are short and quick: weights in the effective speed
_DUTY, _DUTY_LOSS = 0.6425, 0.0353  # stance part of the cycle at standstill, and how much less per m/s (Kirtley 1985)
_REACH = 1.4  # longest stance path in leg lengths, beyond it the body runs
_STEP = 1.26  # metres, of a standard leg's stride at 1.1 m/s: the pitch of the foot and the bob are its
_LONGEST = 1.25  # of that: what is longer lifts and pitches the foot no more
_HEEL_STRIKE, _TOE_OFF = 0.292, 0.92  # radians of foot pitch
_FLAT, _RISE = 0.16, 0.45  # of the stance: from when on the foot is flat, and its heel rises
_ROLL, _ROLLING = 4.0, 0.5  # how late the heel rises, and how fast it still does so at toe-off
_LIFT, _EARLY = 0.056, 0.6  # metres, of the swinging foot on a standard leg, and how much more of it comes early
_ROUND = 0.0225  # how gently heel and ball change places in the swing
_RELAXED = 0.5  # how much less the swinging foot's toes are bent than they would be on the ground
_BEHIND = 0.062  # metres that a standard leg's stance lies behind the hips
_BOB, _LOWEST = 0.0292, 0.0132  # metres, of the hips' way up and down, and the phase at which they are lowest
_BOB_ASIDE = 2.4  # metres, of the same in steps aside, for the square of how wide they are
# How far lowered hips lean forward, radians, and half leg lengths from which on they lean no more: hardly while knees
# will do. With thighs that rise in a stride this stays within what hips flex (120 degrees, the book named in `dof`).
_LEAN, _LEANING = 0.6, 0.45
STEEPEST = 1.5 * _LEAN / _LEANING  # radians that they lean more for a unit of lowering, at most
_SETBACK = 0.5  # how far lowered hips go back, against how far they go down; less, and the shins lean too far
_STRETCH, _STRIDE_STRETCH = 0.999, 0.9981  # how straight the longest leg of the cycle gets, standing and walking


class GaitShape(NamedTuple):
    """What the walking cycle needs of a body."""

    legs: Floats  # (2, 11) left and right leg, metres
    scale: float  # leg length / that of an average adult
    half_leg: float  # half the length of thigh and shin together, metres: the unit of the lowering


def gait_shape(skeleton: Skeleton) -> GaitShape:
    """Measure the legs of a skeleton."""
    at = dict(zip(skeleton.names, skeleton.positions, strict=True))
    rows = []
    for side in ("left", "right"):
        hip, knee, ankle = at[f"{side}UpperLeg"], at[f"{side}LowerLeg"], at[f"{side}Foot"]
        thigh, shin = float(np.linalg.norm(knee - hip)), float(np.linalg.norm(ankle - knee))
        leg, toes = thigh + shin, at.get(f"{side}Toes", ankle + np.array([0.0, -ankle[1], 0.18 * (thigh + shin)]))
        ball, above = max(float(toes[2] - ankle[2]), 0.01), float(min(max(toes[1], 0.0), 0.5 * ankle[1]))
        rows.append([*hip, *ankle, ball, 0.092 * leg, thigh, shin, above])
    legs = np.array(rows)
    leg = float((legs[:, _THIGH] + legs[:, _SHIN]).mean())
    return GaitShape(legs, leg / STANDARD_LEG, 0.5 * leg)


@inner_kernel
def _cadence(forward: float, lateral: float, turn: float, climb: float) -> float:
    """Strides per second, not yet resting at standstill; more where it is so steep that steps would climb too far."""
    side, spin = _LATERAL * lateral, _TURN * turn
    ahead = forward if forward >= 0.0 else _BACK * forward
    relative = (ahead * ahead + side * side + spin * spin) / _STATURE**2
    return float(max(_CADENCE * (relative + _SLOW) ** 0.285, abs(climb) / (2.0 * _RISE_OF_STEP)))


@inner_kernel
def _quickness(scale: float) -> float:
    return float(scale**-_PACE)


@kernel
def quickness(scale: float) -> float:
    """How many strides a body with legs of this `scale` takes for one of an average adult at the same speed.

    Cadence grows with (speed / stature)^0.57 (Grieve & Gear), so at one speed it falls with stature^0.57.
    """
    return _quickness(scale)


def phase_rate(forward: float, lateral: float, turn: float) -> float:
    """Strides per second of an average adult for root velocities in m/s and rad/s; 0 at standstill; see `quickness`.

    D. W. Grieve & R. J. Gear, "The relationships between length of stride, step frequency, time of swing and speed of
    walking for children and adults", Ergonomics 9 (1966): cadence 64.8 (speed / stature)^0.57 strides a minute.
    """
    return climbing_rate(forward, lateral, turn, 0.0)


@kernel
def climbing_rate(forward: float, lateral: float, turn: float, climb: float) -> float:
    """`phase_rate` of who also goes up or down at `climb` m/s: on stairs steps are short and quick, a tread each."""
    if abs(forward) + abs(lateral) + abs(turn) < _STILL:
        return 0.0
    return _cadence(forward, lateral, turn, climb)


@kernel
def stride_length(speed: float) -> float:
    """Length in metres of an average adult's stride (two steps), walking forward at `speed` m/s; see `quickness`."""
    return abs(speed) / _cadence(abs(speed), 0.0, 0.0, 0.0)


@helper
def _stance_part(speed: float, stride: float, scale: float) -> float:
    """The part of the cycle that a foot stands: less at speed, and where strides of this length outgrow the legs."""
    duty = _DUTY - _DUTY_LOSS * speed / np.sqrt(scale)
    return float(duty * (1.0 + (duty / _REACH * stride / (STANDARD_LEG * scale)) ** 12) ** (-1.0 / 12.0))


@inner_kernel
def _smooth(x: float) -> float:
    """Smoothstep, 0 below 0 and 1 above 1."""
    t = min(max(x, 0.0), 1.0)
    return float(t * t * (3.0 - 2.0 * t))


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
        return float(_TOE_OFF * rise - _HEEL_STRIKE * (1.0 - _smooth(u / (_FLAT * duty))))
    rolling = _TOE_OFF * _ROLLING / (duty * (1.0 - _RISE)) * (1.0 - duty)
    return _hermite(_TOE_OFF, rolling, -_HEEL_STRIKE, 0.0, (u - duty) / (1.0 - duty))


@helper
def _pitch_back(u: float, duty: float) -> float:
    """Foot pitch when walking backward: toes first, then the flat foot, heel last."""
    strike, lift = 0.37, -0.19
    if u < duty:
        return strike * (1.0 - _smooth(u / (0.3 * duty))) + lift * _smooth((u - 0.7 * duty) / (0.3 * duty))
    return lift + (strike - lift) * _smooth((u - duty) / (1.0 - duty))


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


class Stride(NamedTuple):
    """What a root's velocities make of the cycle."""

    forward: float
    lateral: float
    turn: float
    speed: float
    period: float  # seconds
    duty: float  # stance part of the cycle
    ahead: float  # how long the stride is, 1.25 at most; negative: backward
    aside: float  # a quarter of the way to the left in a stride, for a standard leg, metres
    effort: float  # 0 at rest, 1 for long strides
    scale: float


@kernel
def _stride(scale: float, forward: float, lateral: float, turn: float, climb: float) -> Stride:
    period = 1.0 / (_quickness(scale) * _cadence(forward, lateral, turn, climb))
    speed = np.sqrt(forward * forward + lateral * lateral)
    duty = _stance_part(speed, speed * period, scale)
    ahead = min(max(forward * period / (_STEP * scale), -_LONGEST), _LONGEST)
    travel = (speed + 0.25 * scale * abs(turn)) * period / (0.6 * scale)
    effort = travel * travel / (0.5 + travel * travel)
    return Stride(forward, lateral, turn, speed, period, duty, ahead, 0.25 * lateral * period / scale, effort, scale)


@kernel
def stride_of(scale: float, forward: float, lateral: float, turn: float) -> Stride:
    """What root velocities in m/s and rad/s make of the cycle of a body with legs of this `scale`, on the level."""
    return _stride(scale, forward, lateral, turn, 0.0)


@inner_kernel
def stride_at(scale: float, root: Floats) -> Stride:
    """What a root state (7 or more,) makes of it, by its velocities and by how fast it climbs where it tells."""
    return _stride(scale, root[3], root[4], root[5], root[_CLIMB] if root.shape[0] > _CLIMB else 0.0)


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
def _bump(w: float) -> float:
    """0 at both ends of a swing, with no slope, 1 in its middle."""
    return 16.0 * (w * (1.0 - w)) ** 2


@inner_kernel
def roll_of(stride: Stride, u: float) -> tuple[float, float]:
    """Pitch of a foot at cycle position `u`, radians, positive toes down; and how high it is lifted, metres."""
    duty, ahead = stride.duty, stride.ahead
    lift = 0.0
    if u >= duty:
        w = (u - duty) / (1.0 - duty)
        lift = _LIFT * stride.scale * stride.effort * _bump(w) * (1.0 + _EARLY * (1.0 - 2.0 * w))
    pitch = ahead * _pitch_ahead(u, duty) if ahead >= 0.0 else -ahead * _pitch_back(u, duty)
    return pitch, lift


@inner_kernel
def tilt_foot(
    legs: Floats,
    side: int,
    place: tuple[float, float, float],
    roll: tuple[float, float],
    ease: tuple[float, float],
    out: Floats,
) -> None:
    """Ankle, yaw, pitch and toe bend (6,) of a foot whose flat place is x, z, yaw, pitched and lifted as `roll` says.

    It turns about its ball or its heel, as gently as `ease_of` its swing says.
    """
    (x, z, yaw), (pitch, lift), (gentle, relaxed) = place, roll, ease
    height, above = legs[side, _ANKLE + 1], legs[side, _TOES]
    sine, cosine = np.sin(pitch), np.cos(pitch)
    size = np.sqrt(sine * sine + gentle)
    toes_down, toes_up = 0.5 * (size + sine), 0.5 * (size - sine)  # of these the sine is made
    pivot = legs[side, _BALL] if pitch > 0.0 else -legs[side, _HEEL]
    along = height * sine - above * toes_down + pivot * (1.0 - cosine)
    over_toes = above * (1.0 - cosine) if pitch > 0.0 else 0.0
    out[0] = x + along * np.sin(yaw)
    out[1] = height * cosine + legs[side, _BALL] * toes_down + legs[side, _HEEL] * toes_up + over_toes + lift
    out[2] = z + along * np.cos(yaw)
    out[3] = yaw
    out[4] = pitch
    out[5] = -np.arcsin(min(toes_down, 1.0)) * (1.0 - relaxed)


@inner_kernel
def ease_of(ahead: float, w: float) -> tuple[float, float]:
    """How gently heel and ball change places at the part `w` of a swing, and how far the toes hang loose."""
    return _ROUND * ahead * ahead * _bump(w), _RELAXED * _bump(w)


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
        x -= min(max(sag, -0.1 * stride.scale), 0.1 * stride.scale) * _bump(w)
    return x, z, yaw, w


@inner_kernel
def _foot_pose(legs: Floats, stride: Stride, side: int, u: float, out: Floats) -> None:
    """Ankle (x, y, z), yaw, pitch and toe bend of one foot at cycle position `u` in [0, 1), in the root frame."""
    x, z, yaw, w = flat_place(legs, stride, side, u)
    tilt_foot(legs, side, (x, z, yaw), roll_of(stride, u), ease_of(stride.ahead, w), out)


@helper
def _needed_drop(legs: Floats, side: int, foot: Floats, stretch: float) -> float:
    """How far the pelvis must come down for the leg to reach the ankle."""
    length = stretch * (legs[side, _THIGH] + legs[side, _SHIN])
    dx, dz = foot[0] - legs[side, _HIP], foot[2] - legs[side, _HIP + 2]
    reach = np.sqrt(max(length * length - dx * dx - dz * dz, 0.25 * length * length))
    return float(max(legs[side, _HIP + 1] - foot[1] - reach, 0.0))


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
    stretch = _STRETCH + (_STRIDE_STRETCH - _STRETCH) * _smooth(stride.speed / stride.scale)
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
    stride, low, wanted, climb = _stride(scale, 0.0, 0.0, 0.0, 0.0), -1.0, feet.shape[0] > 0, 0.0
    for n in range(len(roots)):
        forward, lateral, turn, phase = roots[n, 3], roots[n, 4], roots[n, 5], roots[n, 6]
        climbs = roots[n, _CLIMB] if roots.shape[1] > _CLIMB else 0.0
        same = forward == stride.forward and lateral == stride.lateral and turn == stride.turn and climbs == climb
        if low < 0.0 or not same:
            stride, climb = _stride(scale, forward, lateral, turn, climbs), climbs
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


@brief_kernel
def feet_standing(scale: float, roots: Floats) -> Bools:
    """Which feet (N, 2), left and right, stand on the ground at root states (N, 7); both do where the root rests."""
    standing = np.empty((len(roots), 2), np.bool_)
    for n in range(len(roots)):
        forward, lateral, turn, phase = roots[n, 3], roots[n, 4], roots[n, 5], roots[n, 6]
        duty = stride_at(scale, roots[n]).duty
        rests = abs(forward) + abs(lateral) + abs(turn) < _STILL
        for side in range(2):
            cycle = phase + 0.5 * side
            standing[n, side] = rests or cycle - np.floor(cycle) < duty
    return standing


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


@inner_kernel
def hips_lean(lowering: float) -> float:
    """How far lowered hips lean forward, radians."""
    return _LEAN * _smooth(lowering / _LEANING)


@inner_kernel
def hips_sink(half_leg: float, drop: float, lowering: float) -> tuple[float, float, float]:
    """One row of `hips_sinks`."""
    lowered = half_leg * lowering
    return drop + lowered, _SETBACK * lowered, hips_lean(lowering)


@kernel
def hips_sinks(half_leg: float, drops: Floats, lowerings: Floats) -> Floats:
    """How far the hips are below and behind their place in T-pose, metres, and lean forward, radians (N, 3).

    `drops` (N,) are those of `foot_poses`, `lowerings` (N,) the part of a configuration. Hips go back as they go down,
    as in every squat: the body's weight stays over the feet, and the shins within the reach of the ankles. They lean
    about the middle between the joints of the legs.
    """
    sinks = np.empty((len(drops), 3))
    for n in range(len(drops)):
        sinks[n, 0], sinks[n, 1], sinks[n, 2] = hips_sink(half_leg, drops[n], lowerings[n])
    return sinks
