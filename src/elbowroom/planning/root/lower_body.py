"""What cannot bend: legs and pelvis of a humanoid among the boxes that they can touch."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import BodyModel, body_model, leg_capsules
from elbowroom.planning.root.hull import Ground, ground_below, stride_hull
from elbowroom.world.boxes import Boxes
from elbowroom.world.clearance import clearance
from elbowroom.world.walkable import Stance, stance_segments

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_WALK, _RUN = 1.1, 2.2  # m/s
_SPARE = 0.2  # metres: more than any clearance that is asked for
_SPARE_HEIGHT = 0.05  # metres above the pelvis as it walks
_HALF_DIAGONAL = 0.71  # of a square metre
_LOW = 0.1  # metres: lower end of the stance capsule's axis


class Neighbours(NamedTuple):
    """Boxes and the ground that they stand on."""

    table: Floats32  # (B, 15) as in `Boxes.table32`
    ground: Ground

    def around(self, places: Floats, reach: float) -> "Neighbours":
        """Those that may come within `reach` metres of one of `places` (N, 2)."""
        low, high = places.min(axis=0) - reach, places.max(axis=0) + reach
        near = np.all((self.ground.least <= high) & (self.ground.most >= low), axis=1)
        if near.all():
            return self
        return Neighbours(np.ascontiguousarray(self.table[near]), Ground(*(part[near] for part in self.ground)))

    def __add__(self, more: "Neighbours") -> "Neighbours":  # type: ignore[override]
        """These and others."""
        ground = Ground(*(np.concatenate([a, b]) for a, b in zip(self.ground, more.ground, strict=True)))
        return Neighbours(np.concatenate([self.table, more.table]), ground)


class LowerBody:
    """Legs and pelvis, and the boxes low enough to matter to them."""

    def __init__(self, humanoid: Humanoid, boxes: Boxes) -> None:
        self.model: BodyModel = body_model(humanoid)
        self.radii: Floats32 = self.model.roots.radii
        self.stance, height, self.reach = _measure(self.model)
        corners, height = boxes.corners, height + _SPARE_HEIGHT
        low = corners[:, :, 1].min(axis=1) < height
        self.height = height
        self.hull = stride_hull(self.model)
        self.boxes = Neighbours(np.ascontiguousarray(boxes.table32[low]), ground_below(corners[low], height))
        self._near: tuple[tuple[int, int, float], Neighbours] | None = None

    def near(self, x: float, z: float, reach: float) -> Neighbours:
        """The boxes within `reach` metres of a place, and perhaps some a little farther: those of a square metre."""
        asked = (round(x), round(z), reach)
        if self._near is None or self._near[0] != asked:
            self._near = asked, self.boxes.around(np.array([asked[:2]], np.float64), reach + _HALF_DIAGONAL)
        return self._near[1]

    def clearance(self, boxes: Neighbours, states: Floats) -> Floats32:
        """Clearance (N,) of legs and pelvis, posed by the gait, at root states (N, 7); infinite where far."""
        near = boxes.around(states[:, :2], self.reach)
        if not len(near.table):
            return np.full(len(states), np.inf, np.float32)
        return clearance(leg_capsules(self.model, states), self.radii, near.table)

    def standing_clearance(self, boxes: Neighbours, places: Floats) -> Floats32:
        """Clearance (N,) of the stance capsule at `places` (N, 2) on the ground."""
        segments = stance_segments(self.stance, places[:, 0], places[:, 1])
        return clearance(segments, np.array([self.stance.radius]), boxes.table)


def _measure(model: BodyModel) -> tuple[Stance, float, float]:
    """A vertical capsule as broad as legs and pelvis in a walk and as high as the pelvis; that height; and how far the
    legs reach in a run, with a little to spare."""
    walk, run = (_stride(model, speed) for speed in (_WALK, _RUN))
    radius, height = float(walk[:, 0].max()), float(walk[:, 1].max())
    return Stance(radius, _LOW, max(height - radius, _LOW)), height, float(run.max()) + _SPARE


def _stride(model: BodyModel, speed: float) -> Floats:
    """Greatest distance from the root aside, up and ahead of every capsule over a stride, (C, 3)."""
    roots = np.zeros((32, 7))
    roots[:, 3], roots[:, 6] = speed, np.linspace(0.0, 1.0, 32, endpoint=False)
    segments = np.abs(leg_capsules(model, roots)).reshape(len(model.roots.radii), 2, 3, 32)
    greatest: Floats = segments.max(axis=(1, 3)) + model.roots.radii[:, None]
    return greatest
