"""What cannot bend: legs and pelvis of a humanoid among the boxes that they can touch."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import BodyModel, body_model, leg_capsules
from elbowroom.world.boxes import Boxes
from elbowroom.world.clearance import clearance
from elbowroom.world.walkable import Stance, stance_segments

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_STRIDE_SPEED = 1.1  # m/s: the walk whose breadth the stance capsule has
_LOW = 0.1  # metres: lower end of the stance capsule's axis


class LowerBody:
    """Legs and pelvis, and the boxes low enough to matter to them; frozen once made."""

    def __init__(self, humanoid: Humanoid, boxes: Boxes) -> None:
        self.model: BodyModel = body_model(humanoid)
        self.radii: Floats32 = self.model.roots.radii
        self.stance, self.height = _measure(self.model)
        corners = boxes.corners
        low = corners[:, :, 1].min(axis=1) < self.height + 0.05
        self._table: Floats32 = np.ascontiguousarray(boxes.table32[low])
        self._least: Floats = corners[low][:, :, [0, 2]].min(axis=1)
        self._most: Floats = corners[low][:, :, [0, 2]].max(axis=1)

    def boxes_near(self, x: float, z: float, reach: float) -> Floats32:
        """Table rows of the boxes that come within `reach` metres of a place on the ground."""
        if not len(self._table):
            return self._table
        place = np.array([x, z])
        near = np.all((self._least <= place + reach) & (self._most >= place - reach), axis=1)
        return self._table if near.all() else np.ascontiguousarray(self._table[near])

    def clearance(self, table: Floats32, states: Floats) -> Floats32:
        """Clearance (N,) of legs and pelvis, posed by the gait, at root states (N, 7)."""
        return clearance(leg_capsules(self.model, states), self.radii, table)

    def standing_clearance(self, table: Floats32, x: ArrayLike, z: ArrayLike) -> Floats32:
        """Clearance (N,) of the stance capsule at places on the ground."""
        return clearance(stance_segments(self.stance, x, z), np.array([self.stance.radius]), table)


def _measure(model: BodyModel) -> tuple[Stance, float]:
    """A vertical capsule as broad as legs and pelvis in a walk and as high as the pelvis; and that height."""
    roots = np.zeros((32, 7))
    roots[:, 3], roots[:, 6] = _STRIDE_SPEED, np.linspace(0.0, 1.0, 32, endpoint=False)
    segments = leg_capsules(model, roots)
    reach = model.roots.radii[:, None]
    radius = float(np.max(np.maximum(np.abs(segments[:, 0]), np.abs(segments[:, 3])) + reach))
    height = float(np.max(np.maximum(segments[:, 1], segments[:, 4]) + reach))
    return Stance(radius, _LOW, max(height - radius, _LOW)), height
