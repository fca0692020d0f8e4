"""What stands about legs: obstacles, each with what it covers of the ground."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference
from elbowroom.planning.root.legs.hull import LowBoxes, joined_boxes, some_boxes
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.obstacles import EVERY_HEIGHT, Span
from elbowroom.world.obstacles.rows import is_empty, joined, some_of

Floats = NDArray[np.float64]


@by_reference
class Neighbours(NamedTuple):
    """Obstacles, and what is low of them as boxes seen from above."""

    obstacles: Nearby
    boxes: LowBoxes

    @property
    def empty(self) -> bool:
        """Whether there is nothing."""
        return is_empty(self.obstacles)

    def around(self, places: Floats, reach: float, heights: Span = EVERY_HEIGHT) -> "Neighbours":
        """Those that may come within `reach` metres of one of `places` (N, 2), at some of these heights."""
        boxes, (low_x, low_z), (high_x, high_z) = self.boxes, places.min(axis=0) - reach, places.max(axis=0) + reach
        near = (boxes.least[:, 0] <= high_x) & (boxes.most[:, 0] >= low_x)
        near &= (boxes.least[:, 1] <= high_z) & (boxes.most[:, 1] >= low_z)
        near &= (boxes.heights[:, 0] <= heights[1]) & (boxes.heights[:, 1] >= heights[0])
        if near.all():
            return self
        return Neighbours(some_of(self.obstacles, near), some_boxes(self.boxes, near))

    def above(self, floor: float, top: float = math.inf) -> "Neighbours":
        """Those that rise above a height and begin below another."""
        rises = (self.boxes.heights[:, 1] > floor) & (self.boxes.heights[:, 0] < top)
        return self if rises.all() else Neighbours(some_of(self.obstacles, rises), some_boxes(self.boxes, rises))

    def __add__(self, more: "Neighbours") -> "Neighbours":  # type: ignore[override]
        """These and others."""
        return Neighbours(joined(self.obstacles, more.obstacles), joined_boxes(self.boxes, more.boxes))
