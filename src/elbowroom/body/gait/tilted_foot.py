"""A foot that is pitched on the ground: where its ankle is, about ball or heel, as its own sole rolls.

An average foot turns about two places of a flat sole: the joint of its toes, which stay level, and its heel. What an
own foot does beside that is told at a few pitches (`soles.Soles`), and added.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.soles import PITCHES
from elbowroom.jit import helper, inner_kernel, kernel

Floats = NDArray[np.float64]

# Columns of `GaitShape.legs`, see `cycle`.
_ANKLE, _BALL, _HEEL, _TOES, _PITCH_DOWN, _PITCH_UP, _HANG, _OWN = 3, 6, 7, 10, 11, 12, 13, 14
_ROUND = 0.0225  # how gently heel and ball change places in the swing
_RELAXED = 0.5  # how much less the swinging foot's toes are bent than they would be on the ground
_HOVERS = 0.008  # metres that a heel may be above the ground as it strikes
_FIRST, _STEP = float(PITCHES[0]), float(PITCHES[1] - PITCHES[0])  # radians
_LAST = len(PITCHES) - 1.0 - 1e-9  # steps


@helper
def _average(leg: Floats, pitch: float, gentle: float) -> tuple[float, float, float]:
    """How far the ankle of an average foot on the ground is ahead of where it is flat, and how high, at a pitch.

    Heel and ball change places as gently as that says; and of how much of the sine of its pitch the toes are down.
    """
    sine, cosine = np.sin(pitch), np.cos(pitch)
    size = np.sqrt(sine * sine + gentle)
    toes_down, toes_up = 0.5 * (size + sine), 0.5 * (size - sine)  # of these the sine is made
    pivot, over = (leg[_BALL], 1.0 - cosine) if pitch > 0.0 else (-leg[_HEEL], 0.0)
    along = leg[_ANKLE + 1] * sine - leg[_TOES] * toes_down + pivot * (1.0 - cosine)
    height = leg[_ANKLE + 1] * cosine + leg[_BALL] * toes_down + leg[_HEEL] * toes_up + leg[_TOES] * over
    return along, height, toes_down


@kernel
def rolled(leg: Floats, pitch: Floats) -> tuple[Floats, Floats]:
    """How far (F,) the ankle of a pitched foot on the ground is ahead of where it is flat, and how high it is.

    Of average feet with that ball and heel, as `tilt_foot` has them where no foot swings; `leg` is a row of legs.
    """
    along, height = np.empty(len(pitch)), np.empty(len(pitch))
    for i in range(len(pitch)):
        along[i], height[i], _ = _average(leg, pitch[i], 0.0)
    return along, height


def own_roll(leg: Floats, roll: Floats) -> Floats:
    """How much farther ahead, and higher, ankles (17, 2) are than `rolled` has them.

    A foot whose heel is short comes down on it a little above the ground: else its knee would be bent all the stride.
    """
    own: Floats = roll - np.stack(rolled(leg, PITCHES), axis=1)
    own[:, 1] -= np.where(PITCHES < 0.0, np.clip(own[:, 1], -_HOVERS, 0.0), 0.0)
    return own


@inner_kernel
def bump(w: float) -> float:
    """0 at both ends of a swing, with no slope, 1 in its middle."""
    return 16.0 * (w * (1.0 - w)) ** 2


@helper
def _own_way(leg: Floats, pitch: float) -> tuple[float, float]:
    """How much farther ahead, and higher, the ankle of an own foot is at a pitch, metres."""
    place = min(max((pitch - _FIRST) / _STEP, 0.0), _LAST)
    k = int(place)
    part, at = place - k, _OWN + 2 * k
    return leg[at] + part * (leg[at + 2] - leg[at]), leg[at + 1] + part * (leg[at + 3] - leg[at + 1])


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
    pitch *= legs[side, _PITCH_DOWN] if pitch > 0.0 else legs[side, _PITCH_UP]
    along, height, toes_down = _average(legs[side], pitch, gentle)
    farther, higher = _own_way(legs[side], pitch)
    out[0] = x + (along + farther) * np.sin(yaw)
    out[1] = height + higher + lift
    out[2] = z + (along + farther) * np.cos(yaw)
    out[3] = yaw
    out[4] = pitch
    out[5] = -np.arcsin(min(toes_down, 1.0)) * (1.0 - relaxed * legs[side, _HANG])


@inner_kernel
def ease_of(ahead: float, w: float) -> tuple[float, float]:
    """How gently heel and ball change places at the part `w` of a swing, and how far the toes hang loose."""
    return _ROUND * ahead * ahead * bump(w), _RELAXED * bump(w)
