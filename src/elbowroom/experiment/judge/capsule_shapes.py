"""An avatar's capsules as the other library's shapes, and where a pose puts them."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.judge.obstacles import coal_library
from elbowroom.experiment.judge.poses import Posed
from elbowroom.experiment.judge.stretches import Stretches
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_POINT = 1e-9  # metres: a shorter capsule is a ball


class PlacedCapsules(NamedTuple):
    """Capsules at N poses."""

    turns: Floats  # (N, C, 3, 3) of the joints
    middles: Floats  # (N, C, 3) metres
    half_axes: Floats  # (N, C, 3)

    def at(self, rows: Ints) -> "PlacedCapsules":
        """At some of the poses."""
        return PlacedCapsules(self.turns[rows], self.middles[rows], self.half_axes[rows])


class CapsuleShapes:
    """The collision body of one avatar."""

    def __init__(self, humanoid: Humanoid) -> None:
        self._coal, capsules = coal_library(), humanoid.capsules
        self.names, self.radii = capsules.names, capsules.radii
        self._joints = capsules.joints
        self._middles = 0.5 * (capsules.starts + capsules.ends)
        self._farthest = np.maximum(*(np.linalg.norm(ends, axis=1) for ends in (capsules.starts, capsules.ends)))
        axes = capsules.ends - capsules.starts
        lengths = np.linalg.norm(axes, axis=1)
        upright = np.where(lengths[:, None] > _POINT, axes, [0.0, 0.0, 1.0])
        self._half_axes = 0.5 * axes
        self._turns = quaternion.to_matrix(quaternion.between(np.tile([0.0, 0.0, 1.0], (len(axes), 1)), upright))
        self.shapes = [
            self._coal.Capsule(float(radius), float(length)) if length > _POINT else self._coal.Sphere(float(radius))
            for radius, length in zip(self.radii, lengths, strict=True)
        ]

    def placed(self, posed: Posed) -> PlacedCapsules:
        """The capsules of N posed bodies."""
        turns = posed.rotations[:, self._joints]
        middles = posed.positions[:, self._joints] + np.einsum("ncij,cj->nci", turns, self._middles)
        return PlacedCapsules(turns, middles, np.einsum("ncij,cj->nci", turns, self._half_axes))

    @property
    def reach(self) -> float:
        """Metres that anything of the body is away from the joint that carries it, at most."""
        return float((self._farthest + self.radii).max())

    def away(self, stretches: Stretches) -> Floats:
        """How far (S, C) axes are, at any pose of a stretch, at most from where they are at its middle one, metres."""
        return stretches.away(self._joints, self._farthest)

    def place(self, placed: PlacedCapsules, pose: int, capsule: int) -> Any:
        """Where the library has to put a capsule's shape."""
        turn = placed.turns[pose, capsule] @ self._turns[capsule]
        return self._coal.Transform3s(turn, placed.middles[pose, capsule])
