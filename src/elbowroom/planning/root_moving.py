"""Legs and pelvis among boxes that move: each moment of a path is held against what the boxes sweep around it."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.kinematics import leg_capsules
from elbowroom.planning.root_body import LowerBody
from elbowroom.world.clearance import clearance
from elbowroom.world.moving import MovingBoxes

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_AFTER = 6  # key intervals beyond a path's end in which a stop may last
_LATE = 1e-6  # of a key interval


class MovingAround:
    """What moves during one plan, in spans of a key interval."""

    def __init__(self, body: LowerBody, moving: MovingBoxes, begin: float, horizon: int, interval: float) -> None:
        self._body, self._interval = body, interval
        self._rows = moving.swept(begin + interval * np.arange(horizon + _AFTER + 1.0))
        self._reach = np.linalg.norm(self._rows[..., 12:], axis=-1) + body.reach

    def __bool__(self) -> bool:
        return bool(self._rows.shape[1] > 0)

    def clearance(self, states: Floats, after: Floats) -> Floats32:
        """Clearance (N,) of legs and pelvis at root states (N, 7), `after` (N,) seconds from the plan's beginning."""
        out = np.full(len(states), np.inf, np.float32)
        if not len(states) or not self:
            return out
        spans = np.clip((after / self._interval - _LATE).astype(np.int64), 0, len(self._rows) - 1)
        away = np.hypot(*np.moveaxis(self._rows[spans][..., [0, 2]] - states[:, None, :2], -1, 0))  # (N, B)
        near = np.flatnonzero((away < self._reach[spans]).any(axis=1))
        if not len(near):
            return out
        segments = leg_capsules(self._body.model, states[near])
        for span in np.unique(spans[near]):
            lanes = spans[near] == span
            out[near[lanes]] = clearance(segments[:, :, lanes], self._body.radii, self._rows[span])
        return out
