"""Capsules against obstacles: a wide look that misses nothing, then the other library's word on what is near."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.judge.around import Around
from elbowroom.experiment.judge.capsule_shapes import CapsuleShapes, Placed
from elbowroom.experiment.judge.ledger import Ledger, Nearness
from elbowroom.experiment.judge.obstacles import Obstacle, coal_library
from elbowroom.experiment.judge.poses import Posed

Floats = NDArray[np.float64]


class CapsuleJudge:
    """Judges the collision body of one avatar in one scene."""

    def __init__(self, humanoid: Humanoid, obstacles: Sequence[Obstacle]) -> None:
        self._coal, self._around = coal_library(), Around(obstacles)
        self._shapes = CapsuleShapes(humanoid)
        self._request = self._coal.DistanceRequest()

    def judge(self, posed: Posed, times: Floats, first: int, ledger: Ledger) -> None:
        """Enter what the capsules do at N poses, whose numbers begin at `first`."""
        placed = self._shapes.placed(posed)
        reach = np.abs(placed.half_axes) + self._shapes.radii[:, None]
        low, high = (placed.middles - reach).min(axis=(0, 1)), (placed.middles + reach).max(axis=(0, 1))
        for least, obstacle in self._around.nearest_first(low, high):
            if least > ledger.limit:
                return
            bounds = self._bounds(placed, obstacle)  # (N, C)
            near = np.argwhere(bounds <= ledger.limit)
            for pose, capsule in near[np.argsort(bounds[bounds <= ledger.limit], kind="stable")].tolist():
                if bounds[pose, capsule] > ledger.limit:
                    break
                distance = self._distance(capsule, self._shapes.place(placed, pose, capsule), obstacle)
                found = Nearness(self._shapes.names[capsule], obstacle.name, float(times[pose]), distance)
                ledger.enter(first + pose, found)

    def _bounds(self, placed: Placed, obstacle: Obstacle) -> Floats:
        """A lower bound (N, C) of the distances: that of the boxes round axis and obstacle, less the radius."""
        middle, reach = obstacle.seen_from(placed.middles), np.abs(placed.half_axes @ obstacle.to_box.T)
        bounds: Floats = obstacle.box_distance(middle - reach, middle + reach) - self._shapes.radii
        return bounds

    def _distance(self, capsule: int, place: Any, obstacle: Obstacle) -> float:
        result, shape = self._coal.DistanceResult(), self._shapes.shapes[capsule]
        return float(self._coal.distance(shape, place, obstacle.shape, obstacle.place, self._request, result))
