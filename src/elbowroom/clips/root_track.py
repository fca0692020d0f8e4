"""Where the body as a whole went: a root that moves as smoothly as a planned one, and the stride it was in."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import ROOT_STATE
from elbowroom.clips.body_motion import BodyMotion
from elbowroom.clips.strides import Strides, strides_of
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_SMOOTH = 0.25  # seconds: standard deviation of the filter that takes the sway of the hips out of the root's way


@dataclass(frozen=True, eq=False)
class RootTrack:
    """The root of a motion and its strides."""

    states: Floats  # (F, 7) root states; velocities include what a walk on the spot would have covered
    strides: Strides


def root_track(motion: BodyMotion) -> RootTrack:
    """Smooth the hips' way and heading, and find the strides."""
    heading = smoothed(hips_heading(motion), motion.frame_time, _SMOOTH)
    ground = smoothed(motion.hips[:, [0, 2]], motion.frame_time, _SMOOTH)
    strides = strides_of(motion, ground, heading)
    states = np.zeros((len(motion), ROOT_STATE))
    states[:, :2], states[:, 2] = ground, heading
    if len(motion) > 1:
        velocity = np.gradient(ground, motion.frame_time, axis=0)
        sine, cosine = np.sin(heading), np.cos(heading)
        states[:, 3] = velocity[:, 0] * sine + velocity[:, 1] * cosine
        states[:, 4] = velocity[:, 0] * cosine - velocity[:, 1] * sine
        states[:, 5] = np.gradient(heading, motion.frame_time)
    states[:, 6] = strides.phases
    if strides.on_the_spot:
        states[:, 3] += strides.speed
    return RootTrack(states, strides)


def hips_heading(motion: BodyMotion) -> Floats:
    """Heading (F,) of the hips, radians, without jumps."""
    turn = motion.turns[:, 0]
    return np.unwrap(2.0 * np.arctan2(turn[:, 1], turn[:, 3]))


def seen_from_root(motion: BodyMotion, states: Floats) -> Floats:
    """The turns (F, B, 4) of all bones in the axes of the root."""
    return quaternion.multiply(quaternion.about_axis(1, -states[:, 2])[:, None], motion.turns)


def smoothed(values: Floats, frame_time: float, seconds: float) -> Floats:
    """Gaussian filter of that standard deviation along time; beyond its ends a motion goes on as it began and ended."""
    from scipy.ndimage import gaussian_filter1d  # takes longer to import than a whole start

    if len(values) < 3:
        return values.copy()
    spread = seconds / frame_time
    pad = min(len(values) - 1, max(int(3 * spread), 1))
    before, after = 2.0 * values[0] - values[pad:0:-1], 2.0 * values[-1] - values[-2 : -pad - 2 : -1]
    filtered: Floats = gaussian_filter1d(np.concatenate([before, values, after]), spread, axis=0)
    return filtered[pad : pad + len(values)]
