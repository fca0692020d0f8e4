"""What a root's velocities make of strides: how quick they are, how long, and for how much of each a foot stands."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import HEIGHT
from elbowroom.jit import brief_kernel, helper, inner_kernel, kernel

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

STANDARD_LEG = 0.491 * 1.72  # metres: thigh and shin of an average adult, see `proportions`
CLIMB = HEIGHT + 1  # column of root states: how fast they go up

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


@inner_kernel
def climbing_stride(scale: float, forward: float, lateral: float, turn: float, climb: float) -> Stride:
    """What root velocities in m/s and rad/s make of the cycle of a body with legs of this `scale`."""
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
    return climbing_stride(scale, forward, lateral, turn, 0.0)


@inner_kernel
def stride_at(scale: float, root: Floats) -> Stride:
    """What a root state (7 or more,) makes of it, by its velocities and by how fast it climbs where it tells."""
    return climbing_stride(scale, root[3], root[4], root[5], root[CLIMB] if root.shape[0] > CLIMB else 0.0)


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
