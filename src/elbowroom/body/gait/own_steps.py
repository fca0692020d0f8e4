"""How one walker's own feet go in a walk ahead, as a recorded walk shows it: where they stand, roll and swing.

They take the place of the walking cycle's (`gait`) under feet that step (`footholds`), by the part of the steps that
leads ahead. At the speed of the recording they are those recorded; slower they shrink to the cycle at rest, faster they
grow a little, as the recorded arms do (`clips.swing`).
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.cycle import home_of
from elbowroom.body.gait.own_stride import GROWTH, WIDEST
from elbowroom.body.gait.roll import ahead_part, stepping_roll
from elbowroom.body.gait.stride import Stride, stride_at
from elbowroom.by_reference import by_reference
from elbowroom.jit import helper, inner_kernel, kernel, plain

Floats = NDArray[np.float64]

_ANKLE = 3  # column of `GaitShape.legs`

KEYS = 16  # of a stance, and of the swing that follows on it
AHEAD, ASIDE, YAW, PITCH, LIFT = map(plain, range(5))  # columns of a cycle
PATH = 5


@by_reference
class OwnSteps(NamedTuple):
    """The recorded steps of the left and the right foot; lengths in metres of a standard leg."""

    speed: float  # m/s of the recorded walk; 0: nobody was recorded
    duty: float  # how much more of the cycle feet stand than in the walking cycle at that speed
    homes: Floats  # (2, 3) flat feet in the middle of their stance: outwards and ahead of T-pose's ankle, yaw outwards
    cycle: Floats  # (2, 2 KEYS + 1, PATH) from landing to landing: how far a swinging foot is beside an even way (ahead
    # in parts of a stride, to the left, and turned left), its pitch, positive toes down, and its lift


CYCLE = OwnSteps(0.0, 0.0, np.zeros((2, 3)), np.zeros((2, 2 * KEYS + 1, PATH)))


@inner_kernel
def _share(own: OwnSteps, stride: Stride) -> float:
    """How far feet go as recorded: the part of the steps that leads ahead."""
    return ahead_part(stride) if own.speed > 0.0 else 0.0


@inner_kernel
def _gain(own: OwnSteps, stride: Stride) -> float:
    """How large steps are beside those recorded."""
    gain = (1.0 - math.exp(-stride.forward / GROWTH)) / (1.0 - math.exp(-own.speed / GROWTH))
    return float(min(gain, WIDEST))


@helper
def _place(stride: Stride, u: float) -> float:
    """Where in the table of a cycle a foot is at cycle position `u` in [0, 1]."""
    if u < stride.duty:
        return float(KEYS * u / stride.duty)
    return float(KEYS + KEYS * min((u - stride.duty) / (1.0 - stride.duty), 1.0))


@kernel
def _value(own: OwnSteps, side: int, column: int, place: float) -> float:
    """A number of a foot's cycle."""
    first = min(int(place), 2 * KEYS - 1)
    value = own.cycle[side, first, column]
    return float(value + (place - first) * (own.cycle[side, first + 1, column] - value))


@inner_kernel
def own_stride_at(own: OwnSteps, scale: float, root: Floats) -> Stride:
    """What a root state (7 or more,) makes of the steps of a body with legs of this `scale`."""
    s = stride_at(scale, root)
    duty = s.duty + _share(own, s) * own.duty
    return Stride(s.forward, s.lateral, s.turn, s.speed, s.period, duty, s.ahead, s.aside, s.effort, s.scale)


@inner_kernel
def own_home(own: OwnSteps, legs: Floats, stride: Stride, side: int) -> tuple[float, float, float]:
    """Where a flat foot is in the root frame in the middle of its stance: ankle x, z, and yaw."""
    x, z = home_of(legs, stride, side)
    share = _share(own, stride)
    if share <= 0.0:
        return x, z, 0.0
    outward, gain = 1.0 if side == 0 else -1.0, min(_gain(own, stride), 1.0)
    x += share * (legs[side, _ANKLE] + gain * stride.scale * outward * own.homes[side, 0] - x)
    z += share * (legs[side, _ANKLE + 2] + gain * stride.scale * own.homes[side, 1] - z)
    return x, z, share * gain * outward * own.homes[side, 2]


@inner_kernel
def own_roll(own: OwnSteps, stride: Stride, side: int, u: float) -> tuple[float, float]:
    """Pitch of a foot at cycle position `u`, radians, positive toes down; and how high it is lifted, metres."""
    pitch, lift = stepping_roll(stride, u)
    share = _share(own, stride)
    if share > 0.0:
        gain, place = _gain(own, stride), _place(stride, u)
        pitch += share * (gain * _value(own, side, PITCH, place) - pitch)
        lift += share * (gain * stride.scale * _value(own, side, LIFT, place) - lift)
    return pitch, lift


@inner_kernel
def own_detour(own: OwnSteps, stride: Stride, side: int, w: float) -> tuple[float, float, float]:
    """How far a swinging foot is from its even way when `w` of its swing is over: x, z and yaw in the root frame."""
    share = _share(own, stride)
    if share <= 0.0:
        return 0.0, 0.0, 0.0
    gain, place, way = share * _gain(own, stride), KEYS + KEYS * min(w, 1.0), stride.forward * stride.period
    return (
        gain * stride.scale * _value(own, side, ASIDE, place),
        share * way * _value(own, side, AHEAD, place),
        gain * _value(own, side, YAW, place),
    )
