"""Playing a motion in advance: how clear of everything it stays."""

import copy
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL_GROUPS, columns_of
from elbowroom.control.body_check import BodyCheck
from elbowroom.control.key_frame_queue import KeyFrameQueue, Playback
from elbowroom.planning.root_path import RootPath

Floats = NDArray[np.float64]

_SPACING = 1 / 60  # seconds between rehearsed poses
_CLOSER = 0.002  # metres: the hips' bob brings a kept pose closer for a moment
_MOVES = 0.02  # radians: less is no motion
_HARD_BY = 0.01  # metres of clearance: sliding along is a way out


class Rehearsal:
    """What would be shown from now on, if the queue were refilled: only looked at, the queue stays as it is."""

    def __init__(self, queue: KeyFrameQueue, now: Playback, stance: Floats, check: BodyCheck) -> None:
        self._queue, self._now, self._stance, self._check = queue, now, stance, check

    def is_playable(self, path: RootPath, uppers: Floats) -> bool:
        """Whether the motion touches nothing within its first key interval."""
        return bool(self._clearances(path, uppers, path.interval).min() >= 0.0)

    def leads_away(self, path: RootPath, uppers: Floats, clearance: float) -> bool:
        """Whether the motion begins by leaving, or sliding along, what is now at the given clearance, metres."""
        found = self._clearances(path, uppers, path.interval)
        leaves = found[-1] > clearance or clearance < _HARD_BY
        return bool(leaves and found.min() >= clearance - _CLOSER)

    def _clearances(self, path: RootPath, uppers: Floats, duration: float) -> Floats:
        trial = copy.copy(self._queue)  # a refill makes new arrays, so the original is not changed
        trial.refill(path, uppers, self._now)
        found = []
        for _ in range(round(duration / _SPACING)):
            trial.advance(_SPACING)
            root, upper, _ = trial.sample()
            root[3:6] += self._stance
            found.append(self._check.clearance(root, upper))
        return np.array(found)


def standing_path(path: RootPath, root: Floats) -> RootPath:
    """A path with the key times of `path` on which the root stands at `root` (7,)."""
    still = root.copy()
    still[3:6] = 0.0
    return RootPath(path.start_time, path.interval, np.tile(still, (len(path.states), 1)))


def partial_motions(motion: Floats, upper: Floats) -> list[Floats]:
    """The motion (n+1, 11), and the same with some groups kept as in `upper`: one limb frees itself before another."""
    columns = {group: columns_of(group) for group in LOCAL_GROUPS}
    found = []
    for count in range(len(LOCAL_GROUPS)):
        for kept in combinations(LOCAL_GROUPS, count):
            part = motion.copy()
            for group in kept:
                part[:, columns[group]] = upper[columns[group]]
            if np.abs(part - upper).max() > _MOVES:
                found.append(part)
    return found


def frozen_motion(path: RootPath, upper: Floats) -> Floats:
    """The upper body (11,) kept as it is along a path: (n+1, 11)."""
    return np.tile(upper, (len(path.states), 1))
