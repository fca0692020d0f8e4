"""A recorded motion as postures for the activity graphs: what an avatar has learnt to do."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.clips.clip import MotionClip
from elbowroom.body.dof import LOCAL_GROUPS, DofGroup
from elbowroom.clips.planning_motion import PlanningMotion
from elbowroom.clips.swing import resting

Floats = NDArray[np.float64]

_STEP = 0.15  # radians between two postures that both are worth knowing
_LENGTH = 1.5  # radians of way in one clip: a graph takes a handful of postures from each
_MOST = 16  # clips of one group


def dodge_clips(motion: PlanningMotion) -> tuple[MotionClip, ...]:
    """Clips of all local groups: the way from the resting body to the motion, and the motion's new postures.

    Their times are the way in radians, so that equal time steps are equal steps of posture.
    """
    return tuple(clip for group in LOCAL_GROUPS for clip in _group_clips(motion.name, group, motion.groups[group]))


def _group_clips(name: str, group: DofGroup, configurations: Floats) -> list[MotionClip]:
    """The new postures one after the other, from rest on, in clips of limited length."""
    new = [resting(group)]
    for posture in configurations:
        if np.linalg.norm(np.array(new) - posture, axis=1).min() >= _STEP:
            new.append(posture)
    rows = np.array(new)
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(rows, axis=0), axis=1))])
    clips: list[MotionClip] = []
    first = 0
    while first < len(rows) - 1 and len(clips) < _MOST:
        last = max(int(np.searchsorted(way, way[first] + _LENGTH)), first + 1)
        part = slice(first, last + 1)
        clips.append(MotionClip(name, group, way[part] - way[first], rows[part]))
        first = min(last, len(rows) - 1)
    return clips
