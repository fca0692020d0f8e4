"""How the foot of who steps ahead rolls and is lifted, so that knee and ankle go through a stride as people's do.

The walking cycle (`cycle`) is what plans are proven with, and keeps legs short behind the body: its heel rises early,
on a knee that bends with it. Feet that step (`footholds`) have the room to stand flat under a straight leg until the
other foot comes down, and then to roll over the toes more quickly: the heel goes on rising after the toes have left the
ground, and the foot is lifted soon. Fitted to the published curves at 1.1 and 1.4 m/s (docs/motion.md), with the hips
where `living` carries them. Aside, backward and in turns on the spot feet roll as in the cycle.
"""

from elbowroom.body.gait.cycle import roll_of
from elbowroom.body.gait.smoothstep import smoothstep
from elbowroom.body.gait.stride import Stride
from elbowroom.jit import helper, inner_kernel

_STRIKE, _FLAT = 0.278, 0.16  # radians, toes up, at heel strike; part of the stance at which the foot is flat
_RISE, _ROLL = 0.675, 3.5  # part of the stance from which the heel rises; how late it does so
_TOE_OFF, _ROLLING = 0.995, 3.5  # radians of pitch where the toes leave the ground; how fast it grows there, a swing
_LESS = 0.44  # radians, by which the pitch is less than that would lead to, in the middle of the swing
_LEAST = 0.028  # metres that a standard leg's foot is lifted in any step
_CREEP = 0.03  # m/s: steps that are hardly as quick lead nowhere
_LIFT, _SLOWLY, _SOON = 0.078, 1.55, 2.9  # metres of a standard leg; the powers by which they begin and end


@inner_kernel
def straight_part(stride: Stride) -> float:
    """The part of the steps that leads ahead or back, 0 to 1; the rest goes aside or turns."""
    along = stride.forward * stride.forward
    return float(
        along / (along + stride.lateral * stride.lateral + (0.3 * stride.scale * stride.turn) ** 2 + _CREEP**2)
    )


@inner_kernel
def ahead_part(stride: Stride) -> float:
    """The part of the steps that leads ahead, 0 to 1."""
    return straight_part(stride) if stride.forward > 0.0 else 0.0


@helper
def _pitch(u: float, duty: float) -> float:
    """Pitch of the foot in a long stride at cycle position `u`, radians, positive toes down."""
    if u < duty:
        x = min(max((u / duty - _RISE) / (1.0 - _RISE), 0.0), 1.0)
        rolling = _ROLLING / _TOE_OFF * duty / (1.0 - duty) * (1.0 - _RISE)  # as x grows
        struck = 1.0 - smoothstep(u / (_FLAT * duty))
        return float(_TOE_OFF * x**_ROLL * (1.0 + (_ROLL - rolling) * (1.0 - x)) - _STRIKE * struck)
    w = (u - duty) / (1.0 - duty)
    rest = 1.0 - w
    led = rest * rest * ((1.0 + 2.0 * w) * _TOE_OFF + w * _ROLLING) - w * w * (3.0 - 2.0 * w) * _STRIKE
    return float(led - _LESS * 16.0 * (w * rest) ** 2)


@inner_kernel
def _lift(w: float) -> float:
    """How high a foot is lifted when `w` of its swing is over, in parts of `_LIFT`."""
    top = _SLOWLY / (_SLOWLY + _SOON)
    return float((w / top) ** _SLOWLY * ((1.0 - w) / (1.0 - top)) ** _SOON)


@inner_kernel
def least_lift(stride: Stride, w: float) -> float:
    """How high a foot is lifted at least when `w` of its swing is over, however short the stride; metres."""
    even = 16.0 * (w * (1.0 - w)) ** 2
    return float(_LEAST * stride.scale * (even + ahead_part(stride) * (_lift(w) - even)))


@inner_kernel
def stepping_roll(stride: Stride, u: float) -> tuple[float, float]:
    """Pitch of a foot that steps at cycle position `u`, radians, positive toes down; and its lift, metres."""
    pitch, lift = roll_of(stride, u)
    part = ahead_part(stride)
    if part > 0.0:
        pitch += part * (stride.ahead * _pitch(u, stride.duty) - pitch)
        if u > stride.duty:
            w = (u - stride.duty) / (1.0 - stride.duty)
            lift += part * (_LIFT * stride.scale * stride.effort * _lift(w) - lift)
    return pitch, lift
