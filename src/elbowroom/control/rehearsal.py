"""Playing a motion in advance: how long it stays clear of everything."""

import copy

import numpy as np
from numpy.typing import NDArray

from elbowroom.control.body_check import BodyCheck
from elbowroom.control.key_frame_queue import KeyFrameQueue, Playback
from elbowroom.planning.root_path import RootPath

Floats = NDArray[np.float64]

_SPACING = 1 / 60  # seconds between rehearsed poses


def is_playable(queue: KeyFrameQueue, path: RootPath, uppers: Floats, now: Playback, check: BodyCheck) -> bool:
    """Whether the first key interval of a motion would touch nothing, if the queue were refilled with it now."""
    trial = copy.copy(queue)  # a refill makes new arrays, so the queue itself stays as it is
    trial.refill(path, uppers, now)
    for _ in range(round(path.interval / _SPACING)):
        trial.advance(_SPACING)
        playback = trial.sample()
        if check.clearance(playback.root, playback.upper) < 0.0:
            return False
    return True


def frozen_motion(path: RootPath, upper: Floats) -> Floats:
    """The upper body (10,) kept as it is along a path: (n+1, 10)."""
    return np.tile(upper, (len(path.states), 1))
