"""The nearest obstacle of a posture: which capsule, which box, and where."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.server.schema.bounds import Vector
from elbowroom.server.schema.progress import Nearest
from elbowroom.world.clearance import pairwise_clearance
from elbowroom.world.closest_points import closest_points
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]


def nearest(
    segments: NDArray[np.float32], radii: Floats, names: tuple[str, ...], scene: Scene, time: float
) -> Nearest | None:
    """The closest pair of a posture's capsules (C, 6), radii (C,) and the boxes at a time; None without boxes."""
    table = scene.boxes.table
    if len(scene.moving):
        table = np.concatenate([table, scene.moving.tables([time])[0]])
    if len(table) == 0:
        return None
    gaps = pairwise_clearance(segments[:, :, None], radii, table)[:, :, 0]
    capsule, box = np.unravel_index(int(np.argmin(gaps)), gaps.shape)
    on_axis, on_box = (
        points[0] for points in closest_points(segments[capsule].astype(np.float64), table[box : box + 1])
    )
    away = on_box - on_axis
    distance = float(np.linalg.norm(away))
    on_body = on_axis + away * min(1.0, radii[capsule] / distance) if distance > 0.0 else on_axis
    return Nearest(
        capsule=names[capsule],
        box=(*scene.box_names, *scene.moving.names)[box],
        on_body=_vector(on_body),
        on_box=_vector(on_box),
        distance=float(gaps[capsule, box]),
    )


def _vector(point: Floats) -> Vector:
    x, y, z = (float(value) for value in point)
    return x, y, z
