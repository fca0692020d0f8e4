"""Whether the head looks to where one goes before one goes there."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.skeleton import Skeleton
from elbowroom.experiment.motion.trunk import turned_about
from elbowroom.experiment.motion.walked import RATE, Walked

Floats = NDArray[np.float64]

_MOVING = 0.2  # m/s: who is slower goes nowhere in particular


def head_lead(walked: Walked, skeleton: Skeleton) -> float | None:
    """Seconds by which the head is half way through a turn before the way is; None where there is no turn."""
    head = turned_about(walked.joints.rotations[:, skeleton.index("head")], np.zeros(len(walked.roots)))[:, 0]
    velocity = RATE * np.gradient(walked.roots[:, :2], axis=0)
    moving = np.linalg.norm(velocity, axis=1) > _MOVING
    course = np.degrees(np.arctan2(velocity[:, 0], velocity[:, 1]))
    return lead(np.unwrap(head, period=360.0), np.where(moving, course, 0.0), RATE)


def lead(head: Floats, course: Floats, rate: float) -> float | None:
    """Seconds by which `head` (N,) is half way to its last value before `course` (N,) is, degrees, ends alike."""
    halves = [_crossing(track, 0.5 * (track[0] + course[-1])) for track in (head, course)]
    if abs(course[-1] - course[0]) < 1.0 or halves[0] is None or halves[1] is None:
        return None
    return (halves[1] - halves[0]) / rate


def _crossing(track: Floats, level: float) -> float | None:
    """The moment, in frames, from which on a track stays beyond a level."""
    before = np.flatnonzero(np.sign(track - level) != np.sign(track[-1] - level))
    if not len(before) or before[-1] + 1 >= len(track):
        return None
    n = int(before[-1])
    return n + float((level - track[n]) / (track[n + 1] - track[n]))
