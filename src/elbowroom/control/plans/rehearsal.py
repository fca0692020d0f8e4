"""Playing a motion in advance: how clear of everything it stays."""

from itertools import chain, combinations
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL_GROUPS, columns_of, followers_of
from elbowroom.body.gait.gliding import gliding
from elbowroom.body.root import ROOT_STATE
from elbowroom.control.key_frame_queue import KeyFrameQueue
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]

_SPACING = 1 / 60  # seconds between rehearsed poses
_CLOSER = 0.002  # metres: the hips' bob brings a kept pose closer for a moment
_MOVES = 0.02  # radians: less is no motion
_FOLLOWERS = frozenset(chain.from_iterable(map(followers_of, LOCAL_GROUPS)))
_HARD_BY = 0.01  # metres of clearance: sliding along is a way out


class Held(NamedTuple):
    """The pose in which an avatar is held after a contact."""

    root: Floats  # (SHOWN,)
    upper: Floats  # (LOCAL,)
    stance: Floats  # (3,) velocities of the stride in which the legs were held; the root stands
    clearance: float  # metres


class Rehearsal:
    """What would be shown if a motion were played from the pose in which the avatar is held."""

    def __init__(self, held: Held, check: BodyCheck) -> None:
        self._held, self._check = held, check

    def is_playable(self, path: RootPath, uppers: Floats) -> bool:
        """Whether the motion touches nothing within its first key interval, or less and less what has come upon it."""
        return bool(
            np.all(np.diff(np.minimum(np.append(self._held.clearance, self._clearances(path, uppers)), 0.0)) >= 0.0)
        )

    def leads_away(self, path: RootPath, uppers: Floats) -> bool:
        """Whether the motion begins by leaving, or sliding along, what is near."""
        found, clearance = self._clearances(path, uppers), self._held.clearance
        leaves = found[-1] > clearance or clearance < _HARD_BY
        return bool(leaves and found.min() >= clearance - _CLOSER)

    def _clearances(self, path: RootPath, uppers: Floats) -> Floats:
        trial = KeyFrameQueue(path.horizon, path.interval)
        trial.time = path.start_time
        trial.splice(path, uppers, np.zeros_like(self._held.upper))
        found, root = [], self._held.root
        for _ in range(round(path.interval / _SPACING)):
            trial.advance(_SPACING)
            shown = trial.sample()
            shown.root[3:6] += self._held.stance
            root = self._on_feet(root, shown.root)
            found.append(self._check.clearance(root, shown.upper, trial.time))
        return np.array(found)

    def _on_feet(self, before: Floats, root: Floats) -> Floats:
        """A root state (7,) after the one `before`, which may have feet, on what it stands on."""
        stood = self._check.standing(root)
        return gliding(self._check.model.gait, before, stood, _SPACING) if len(before) > ROOT_STATE else stood


def standing_path(path: RootPath, root: Floats) -> RootPath:
    """A path with the key times of `path` on which the root stands at `root` (7,)."""
    still = root[:ROOT_STATE].copy()
    still[3:6] = 0.0
    return RootPath(path.start_time, path.interval, np.tile(still, (len(path.states), 1)))


def partial_motions(motion: Floats, upper: Floats) -> list[Floats]:
    """The motion (n+1, LOCAL), and with some groups kept as in `upper`: one limb frees itself before another.

    What follows a group is kept with it: a head that moves alone frees nothing.
    """
    limbs = [(group, *followers_of(group)) for group in LOCAL_GROUPS if group not in _FOLLOWERS]
    found = []
    for count in range(len(limbs)):
        for kept in combinations(limbs, count):
            part = motion.copy()
            for group in chain.from_iterable(kept):
                part[:, columns_of(group)] = upper[columns_of(group)]
            if np.abs(part - upper).max() > _MOVES:
                found.append(part)
    return found


def frozen_motion(path: RootPath, upper: Floats) -> Floats:
    """The upper body (LOCAL,) kept as it is along a path: (n+1, LOCAL)."""
    return np.tile(upper, (len(path.states), 1))
