"""The nearest obstacle of a posture: which capsule, which box, and where."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.server.schema.bounds import Vector
from elbowroom.server.schema.progress import Nearest
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]


def nearest(
    segments: NDArray[np.float32], radii: Floats, names: tuple[str, ...], scene: Scene, time: float
) -> Nearest | None:
    """The closest pair of a posture's capsules (C, 6), radii (C,), and an obstacle at a time; None without any."""
    origin = segments[0, [0, 2]].astype(np.float64)
    found = scene.obstacles.nearest(segments - np.tile([origin[0], 0.0, origin[1]], 2), radii, origin, time)
    if found is None:
        return None
    away = found.on_obstacle - found.on_axis
    distance = float(np.linalg.norm(away))
    on_body = found.on_axis + away * min(1.0, radii[found.capsule] / distance) if distance > 0.0 else found.on_axis
    return Nearest(
        capsule=names[found.capsule],
        obstacle=scene.obstacles.names[found.obstacle],
        on_body=_vector(on_body),
        on_obstacle=_vector(found.on_obstacle),
        distance=found.distance,
    )


def _vector(point: Floats) -> Vector:
    x, y, z = (float(value) for value in point)
    return x, y, z
