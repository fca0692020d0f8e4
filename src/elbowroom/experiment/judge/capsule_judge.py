"""Capsules against obstacles: a wide look that misses nothing, then the other library's word on what is near."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.judge.ledger import Ledger, Nearness
from elbowroom.experiment.judge.obstacles import Obstacle, coal_library
from elbowroom.experiment.judge.poses import Posed
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_POINT = 1e-9  # metres: a shorter capsule is a ball


class CapsuleJudge:
    """Judges the collision body of one avatar in one scene."""

    def __init__(self, humanoid: Humanoid, obstacles: Sequence[Obstacle]) -> None:
        coal, capsules = coal_library(), humanoid.capsules
        self._coal, self._obstacles, self._names = coal, obstacles, capsules.names
        self._joints, self._radii = capsules.joints, capsules.radii
        self._middles = 0.5 * (capsules.starts + capsules.ends)
        axes = capsules.ends - capsules.starts
        lengths = np.linalg.norm(axes, axis=1)
        upright = np.where(lengths[:, None] > _POINT, axes, [0.0, 0.0, 1.0])
        self._half_axes = 0.5 * axes
        self._turns = quaternion.to_matrix(quaternion.between(np.tile([0.0, 0.0, 1.0], (len(axes), 1)), upright))
        self._shapes = [
            coal.Capsule(float(radius), float(length)) if length > _POINT else coal.Sphere(float(radius))
            for radius, length in zip(self._radii, lengths, strict=True)
        ]
        self._request = coal.DistanceRequest()

    def judge(self, posed: Posed, times: Floats, first: int, ledger: Ledger) -> None:
        """Enter what the capsules do at N poses, whose numbers begin at `first`."""
        turns = posed.rotations[:, self._joints]
        middles = posed.positions[:, self._joints] + np.einsum("ncij,cj->nci", turns, self._middles)
        half_axes = np.einsum("ncij,cj->nci", turns, self._half_axes)
        bounds = self._bounds(middles, half_axes)  # (N, C, B)
        for at in np.argsort(bounds, axis=None):
            pose, capsule, which = (int(i) for i in np.unravel_index(at, bounds.shape))
            if bounds[pose, capsule, which] > ledger.limit:
                return
            turn = turns[pose, capsule] @ self._turns[capsule]
            distance = self._distance(capsule, turn, middles[pose, capsule], self._obstacles[which])
            part, obstacle = self._names[capsule], self._obstacles[which].name
            ledger.enter(first + pose, Nearness(part, obstacle, float(times[pose]), distance))

    def _bounds(self, middles: Floats, half_axes: Floats) -> Floats:
        """A lower bound of every distance: that of the boxes round axis and obstacle, less the radius."""
        bounds = np.empty((*middles.shape[:2], len(self._obstacles)))
        for which, obstacle in enumerate(self._obstacles):
            middle, reach = obstacle.seen_from(middles), np.abs(half_axes @ obstacle.to_box.T)
            bounds[:, :, which] = obstacle.box_distance(middle - reach, middle + reach) - self._radii
        return bounds

    def _distance(self, capsule: int, turn: Floats, middle: Floats, obstacle: Obstacle) -> float:
        result, place = self._coal.DistanceResult(), self._coal.Transform3s(turn, middle)
        shape = self._shapes[capsule]
        return float(self._coal.distance(shape, place, obstacle.shape, obstacle.place, self._request, result))
