"""The legs of a body that crouches: knees that come forward and aside, hips that go down and back, among the boxes.

The root's path is planned for upright legs. How deep the body crouches on it is chosen with the waist, so legs and
pelvis have to be looked at again where it does. That depends on the lowering and on the root's state alone.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup, limits
from elbowroom.body.kinematics import BodyModel, leg_capsules
from elbowroom.world.boxes import Boxes
from elbowroom.world.clearance import clearance

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]

_LEAST = 1e-3  # of a lowering that is looked at: less than a millimetre
_SPEED = 2.2  # m/s: a run, in which legs reach farthest
_DEEP = float(limits(DofGroup.WAIST)[2, 1])
_SPARE = 0.1  # metres beyond the reach of the legs


class LoweredLegs:
    """Legs and pelvis of one humanoid in one scene; frozen once made."""

    def __init__(self, model: BodyModel, boxes: Boxes) -> None:
        self._model = model
        self._reach, height = _extent(model)
        corners = boxes.corners
        low = corners[:, :, 1].min(axis=1, initial=np.inf) < height
        ground = corners[low][:, :, [0, 2]]
        self._table = np.ascontiguousarray(boxes.table[low])
        self._least, self._most = ground.min(axis=1), ground.max(axis=1)

    def clearances(self, roots: Floats, lowerings: Floats) -> Floats32:
        """Clearance (N,) at root states (N, 7) and lowerings (N,); infinite where upright or far from every box."""
        out = np.full(len(roots), np.inf, np.float32)
        lowered = np.flatnonzero(lowerings > _LEAST)
        if not len(lowered):
            return out
        places = roots[lowered, :2]
        near = (self._least <= places.max(axis=0) + self._reach) & (self._most >= places.min(axis=0) - self._reach)
        table = self._table[near.all(axis=1)].copy()
        if not len(table):
            return out
        # at the origin, so that single precision holds anywhere
        states, origin = roots[lowered].copy(), places[0].copy()
        states[:, :2] -= origin
        table[:, [0, 2]] -= origin
        out[lowered] = clearance(
            leg_capsules(self._model, states, lowerings[lowered]), self._model.roots.radii, table.astype(np.float32)
        )
        return out

    def touching(self, roots: Floats, lowerings: Floats, margin: float) -> Bools:
        """Whether lowerings (V,) come within `margin` of a box at any of the root states (T, m, 7) of a row: (T, V)."""
        levels, place = np.unique(lowerings, return_inverse=True)
        rows, moments = roots.shape[:2]
        states = np.repeat(roots.reshape(-1, 7), len(levels), axis=0)
        found = self.clearances(states, np.tile(levels, rows * moments)).reshape(rows, moments, len(levels))
        touching: Bools = (found.min(axis=1) < margin)[:, place]
        return touching


def _extent(model: BodyModel) -> tuple[float, float]:
    """How far lowered legs may reach from the root on the ground, and how high they come, with a little to spare."""
    roots = np.zeros((64, 7))
    roots[:, 3], roots[:, 6] = _SPEED, np.arange(64) / 32.0
    segments = leg_capsules(model, roots, np.repeat([0.0, _DEEP], 32)).reshape(-1, 2, 3, 64)
    radii = model.roots.radii[:, None, None]
    aside = np.linalg.norm(segments[:, :, [0, 2]], axis=2) + radii
    return float(aside.max()) + _SPARE, float((segments[:, :, 1] + radii).max()) + _SPARE
