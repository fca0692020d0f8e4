"""How a recorded body carries hips and chest beside what planning keeps of it, and its mean stride as harmonics.

Of the hips' place and heading it is the rates that are kept: they repeat with the stride wherever the way leads.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.carriage import AHEAD, ASIDE, CHEST_LIST, LIST, POSING, TURN
from elbowroom.body.gait.own_stride import OwnStride, harmonics_of, within
from elbowroom.body.root import WITH_FEET
from elbowroom.clips.body_motion import BodyMotion
from elbowroom.clips.root_track import hips_heading, smoothed
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_HEADING = 0.5  # seconds: standard deviation of the filter that takes the turns of the hips out of the heading
_RATES = tuple(column - WITH_FEET for column in (ASIDE, AHEAD, TURN))
_MOST = {
    ASIDE: 0.08,
    AHEAD: 0.1,
    TURN: 0.35,
    LIST: 0.25,
    CHEST_LIST: 0.25,
}  # metres of a standard leg, radians
_LEFT = np.array([1.0, 0.0, 0.0])


def carried(motion: BodyMotion, hips: Floats, beside: Floats) -> Floats:
    """How hips and chest are carried in each frame: (F, POSING), rates a second of sway, ripple and turn.

    `hips` (F, 4) are their turns as seen from the root, `beside` (F, 4) what the chest is turned by before its plan.
    """
    rows = np.zeros((len(motion), POSING))
    rows[:, LIST - WITH_FEET], rows[:, CHEST_LIST - WITH_FEET] = _raised(hips), _raised(beside)
    if len(motion) < 2:
        return rows
    turned, heading = hips_heading(motion), facing(motion)
    x, z = np.gradient(middle_of_hips(motion)[:, [0, 2]], motion.frame_time, axis=0).T
    sine, cosine = np.sin(heading), np.cos(heading)
    rows[:, ASIDE - WITH_FEET], rows[:, AHEAD - WITH_FEET] = x * cosine - z * sine, x * sine + z * cosine
    rows[:, TURN - WITH_FEET] = np.gradient(turned, motion.frame_time)
    return rows


def facing(motion: BodyMotion) -> Floats:
    """Heading (F,) without the turns of the hips, radians."""
    return smoothed(hips_heading(motion), motion.frame_time, _HEADING)


def middle_of_hips(motion: BodyMotion) -> Floats:
    """The middle (F, 3) between the joints of the legs, about which hips are turned."""
    middle: Floats = 0.5 * (motion.position("leftUpperLeg") + motion.position("rightUpperLeg"))
    return middle


def displaced(rows: Floats, pace: float) -> Floats:
    """`carried` rows (n, POSING) at even phases of a stride with places for rates; `pace` is in strides a second."""
    waves = np.fft.rfft(rows, axis=0)
    number = np.arange(1, len(waves))
    for column in _RATES:
        waves[0, column] = 0.0
        waves[1:, column] /= 2j * np.pi * pace * number
    return np.fft.irfft(waves, len(rows), axis=0)


def own_stride(rows: Floats, scale: float, speed: float) -> OwnStride:
    """The stride whose `displaced` rows (n, POSING) are those of a walk at so many m/s on legs of this `scale`."""
    harmonics = harmonics_of(rows)
    harmonics[:, :3] /= scale
    for column, most in _MOST.items():
        harmonics[:, column - WITH_FEET] = within(harmonics[:, column - WITH_FEET], most)
    return OwnStride(harmonics, speed)


def _raised(turns: Floats) -> Floats:
    """How far (F,) the left side is raised, radians."""
    raised: Floats = np.arcsin(np.clip(quaternion.rotate(turns, _LEFT)[:, 1], -1.0, 1.0))
    return raised
