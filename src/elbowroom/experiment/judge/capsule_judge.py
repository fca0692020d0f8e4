"""Capsules against obstacles: a wide look that misses nothing, then the other library's word on what is near."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.judge.capsule_shapes import CapsuleShapes
from elbowroom.experiment.judge.ledger import Ledger, Nearness
from elbowroom.experiment.judge.obstacles import Obstacle, coal_library
from elbowroom.experiment.judge.poses import Posed

Floats = NDArray[np.float64]


class CapsuleJudge:
    """Judges the collision body of one avatar in one scene."""

    def __init__(self, humanoid: Humanoid, obstacles: Sequence[Obstacle]) -> None:
        self._coal, self._obstacles = coal_library(), obstacles
        self._shapes = CapsuleShapes(humanoid)
        self._request = self._coal.DistanceRequest()

    def judge(self, posed: Posed, times: Floats, first: int, ledger: Ledger) -> None:
        """Enter what the capsules do at N poses, whose numbers begin at `first`."""
        placed = self._shapes.placed(posed)
        bounds = self._bounds(placed.middles, placed.half_axes)  # (N, C, B)
        for at in np.argsort(bounds, axis=None):
            pose, capsule, which = (int(i) for i in np.unravel_index(at, bounds.shape))
            if bounds[pose, capsule, which] > ledger.limit:
                return
            obstacle, place = self._obstacles[which], self._shapes.place(placed, pose, capsule)
            distance = self._distance(capsule, place, obstacle)
            found = Nearness(self._shapes.names[capsule], obstacle.name, float(times[pose]), distance)
            ledger.enter(first + pose, found)

    def _bounds(self, middles: Floats, half_axes: Floats) -> Floats:
        """A lower bound of every distance: that of the boxes round axis and obstacle, less the radius."""
        bounds = np.empty((*middles.shape[:2], len(self._obstacles)))
        for which, obstacle in enumerate(self._obstacles):
            middle, reach = obstacle.seen_from(middles), np.abs(half_axes @ obstacle.to_box.T)
            bounds[:, :, which] = obstacle.box_distance(middle - reach, middle + reach) - self._shapes.radii
        return bounds

    def _distance(self, capsule: int, place: Any, obstacle: Obstacle) -> float:
        result, shape = self._coal.DistanceResult(), self._shapes.shapes[capsule]
        return float(self._coal.distance(shape, place, obstacle.shape, obstacle.place, self._request, result))
