"""Legs and pelvis among boxes that move: each moment of a path is held against what the boxes sweep around it."""

from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.kinematics import leg_capsules
from elbowroom.planning.root.hull import ground_below
from elbowroom.planning.root.lower_body import LowerBody, Neighbours
from elbowroom.world.clearance import clearance
from elbowroom.world.moving import MovingBoxes

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_AFTER = 6  # key intervals beyond a path's end in which a stop may last
_STAYS = 0.25  # metres: what moves less during a plan stands
_POLITE = 0.08  # metres that are kept from what may move
_CORNERS = np.array(list(product((-1.0, 1.0), repeat=3)))
_LATE = 1e-6  # of a key interval


class MovingAround:
    """What moves during one plan, in spans of a key interval."""

    def __init__(self, body: LowerBody, moving: MovingBoxes, begin: float, horizon: int, interval: float) -> None:
        self._body, self._moving, self._begin, self._horizon, self._interval = body, moving, begin, horizon, interval

    def __bool__(self) -> bool:
        return len(self._moving) > 0

    @cached_property
    def _rows(self) -> Floats:
        """What each box sweeps in each span, (spans, B, 15)."""
        return self._moving.swept(self._begin + self._interval * np.arange(self._horizon + _AFTER + 1.0))

    @cached_property
    def _reach(self) -> Floats:
        """How far from a box's middle legs may be that touch it, (spans, B) metres."""
        reach: Floats = np.linalg.norm(self._rows[..., 12:], axis=-1) + self._body.reach
        return reach

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

    @cached_property
    def standing(self) -> Neighbours:
        """What could move but stays where it is for now, a little larger: there are ways round it as round walls."""
        stays = np.all(np.ptp(self._rows[..., [0, 2]], axis=0) < _STAYS, axis=1)
        table = self._rows[0, stays].copy()
        table[:, [12, 14]] += _POLITE
        axes = table[:, 3:12].reshape(-1, 3, 3) * table[:, 12:, None]
        corners = table[:, None, :3] + np.einsum("ck,bkx->bcx", _CORNERS, axes)
        low = corners[:, :, 1].min(axis=1) < self._body.height
        return Neighbours(table[low].astype(np.float32), ground_below(corners[low], self._body.height))

    def gap(self, states: Floats, radius: float, height: float) -> float:
        """The least distance, metres, of an upright cylinder from what moves, at the key states (n+1, 7) of a path.

        It is looked at from above; what passes overhead is left out. Infinite where nothing moves.
        """
        rows = self._rows[: len(states) - 1]
        low = (rows[..., 1] - rows[..., 13]).min(axis=0, initial=np.inf) < height
        rows = rows[:, low]
        off, (sine, cosine) = rows[..., [0, 2]] - states[1:, None, :2], np.moveaxis(rows[..., [9, 3]], -1, 0)
        across = np.abs(off[..., 0] * cosine - off[..., 1] * sine) - rows[..., 12]
        along = np.abs(off[..., 0] * sine + off[..., 1] * cosine) - rows[..., 14]
        outside = np.hypot(np.maximum(across, 0.0), np.maximum(along, 0.0))
        gaps = outside + np.minimum(np.maximum(across, along), 0.0)
        return float(gaps.min(initial=np.inf)) - radius
