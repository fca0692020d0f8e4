"""A scene's obstacles as another library knows them, and in which oriented box each of them lies."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.geometry import quaternion
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Obstacle:
    """One obstacle: the library's shape and place, and an oriented box round it for finding what is near."""

    name: str
    shape: Any  # coal.CollisionGeometry
    place: Any  # coal.Transform3s
    center: Floats  # (3,) of the box round it, in the world
    to_box: Floats  # (3, 3) world to box axes
    half_size: Floats  # (3,)

    def box_distance(self, low: Floats, high: Floats) -> Floats:
        """Distance (...) from the box round the obstacle to boxes along its axes with corners `low`, `high` (..., 3).

        Corners are in the box's frame. Whatever lies between them is at least so far from the obstacle.
        """
        gap = np.maximum(np.maximum(low - self.half_size, -self.half_size - high), 0.0)
        distance: Floats = np.sqrt(np.einsum("...i,...i->...", gap, gap))
        return distance

    def seen_from(self, points: Floats) -> Floats:
        """World points (..., 3) in the frame of the box round the obstacle."""
        seen: Floats = (points - self.center) @ self.to_box.T
        return seen


def coal_library() -> Any:
    """The collision library; raises `InputError` where it is not installed."""
    try:
        import coal
    except ImportError:
        raise InputError('the judge needs the collision library coal: pip install "elbowroom[judge]"') from None
    return coal


def obstacles_of(scene: Scene) -> tuple[Obstacle, ...]:
    """Every obstacle of a scene."""
    return _boxes(scene)


def _boxes(scene: Scene) -> tuple[Obstacle, ...]:
    coal, boxes = coal_library(), scene.boxes
    turns = quaternion.to_matrix(boxes.rotations)
    return tuple(
        Obstacle(
            name=name,
            shape=coal.Box(*(2.0 * half)),
            place=coal.Transform3s(turn, center),
            center=center,
            to_box=turn.T,
            half_size=half,
        )
        for name, center, turn, half in zip(scene.box_names, boxes.centers, turns, boxes.half_sizes, strict=True)
    )
