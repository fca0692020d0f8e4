"""Capsules against obstacles: a wide look that misses nothing, then the other library's word on what is near."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.judge.capsule_shapes import CapsuleShapes, PlacedCapsules
from elbowroom.experiment.judge.case import Case
from elbowroom.experiment.judge.nearest_first import nearest_first
from elbowroom.experiment.judge.obstacle_index import ObstacleIndex
from elbowroom.experiment.judge.obstacles import Obstacle, coal_library
from elbowroom.experiment.judge.stretches import stretches_of

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_AT_ONCE = 32  # capsules, each in a stretch, that are looked at before the limit is asked again


class CapsuleJudge:
    """Judges the collision body of one avatar in one scene."""

    def __init__(self, humanoid: Humanoid, obstacles: Sequence[Obstacle]) -> None:
        self._coal, self._index = coal_library(), ObstacleIndex(obstacles)
        self._shapes = CapsuleShapes(humanoid)
        self._request = self._coal.DistanceRequest()

    @property
    def reach(self) -> float:
        """Metres that anything of the body is away from the joint that carries it, at most."""
        return self._shapes.reach

    def judge(self, case: Case) -> None:
        """Enter what the capsules do."""
        placed, stretches = self._shapes.placed(case.posed), stretches_of(case.posed)
        middle, away = placed.at(stretches.middles), self._shapes.away(stretches)
        reach = np.abs(middle.half_axes) + (self._shapes.radii + away)[..., None]
        low, high = (middle.middles - reach).min(axis=(0, 1)), (middle.middles + reach).max(axis=(0, 1))
        for least, obstacle in self._index.nearest_first(low, high):
            if least > case.ledger.limit:
                return
            wide = self._bounds(middle.middles, middle.half_axes, obstacle) - self._shapes.radii - away
            for some, capsules in nearest_first(wide, lambda: case.ledger.limit, _AT_ONCE):
                rows = stretches.rows(some)
                every = np.broadcast_to(capsules[:, None], rows.shape)
                self._judge_near(placed, rows.ravel(), every.ravel(), obstacle, case)

    def _judge_near(self, placed: PlacedCapsules, rows: Ints, capsules: Ints, obstacle: Obstacle, case: Case) -> None:
        """Enter what capsules (n,) do to an obstacle at poses `rows` (n,)."""
        axes = placed.middles[rows, capsules], placed.half_axes[rows, capsules]
        bounds = self._bounds(*axes, obstacle) - self._shapes.radii[capsules]
        for (some,) in nearest_first(bounds, lambda: case.ledger.limit, 1):
            pose, capsule = int(rows[some[0]]), int(capsules[some[0]])
            distance = self._distance(capsule, self._shapes.place(placed, pose, capsule), obstacle)
            case.enter(pose, self._shapes.names[capsule], obstacle.name, distance)

    def _bounds(self, middles: Floats, half_axes: Floats, obstacle: Obstacle) -> Floats:
        """A lower bound (...) of the distances of axes (..., 3): that of the boxes round axis and obstacle."""
        middle, reach = obstacle.seen_from(middles), np.abs(half_axes @ obstacle.to_box.T)
        return obstacle.box_distance(middle - reach, middle + reach)

    def _distance(self, capsule: int, place: Any, obstacle: Obstacle) -> float:
        result, shape = self._coal.DistanceResult(), self._shapes.shapes[capsule]
        return float(self._coal.distance(shape, place, obstacle.shape, obstacle.place, self._request, result))
