"""The nearest obstacle of a posture: which capsule, which box, and where."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.server.schema.bounds import Vector
from elbowroom.server.schema.progress import Nearest
from elbowroom.world.clearance import pairwise_clearance
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

_SAMPLES = 17
_ROUNDS = 6  # each narrows the interval to an eighth: 4e-6 of the capsule's length


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
    on_axis, on_box = _closest_points(segments[capsule].astype(np.float64), table[box])
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


def _closest_points(segment: Floats, row: Floats) -> tuple[Floats, Floats]:
    """The nearest points of a segment (6,) and of a box (15,), by narrowing a convex function."""
    center, to_box, half = row[:3], row[3:12].reshape(3, 3), row[12:]
    start, step = to_box @ (segment[:3] - center), to_box @ (segment[3:] - segment[:3])
    low, high = 0.0, 1.0
    for _ in range(_ROUNDS):
        share = np.linspace(low, high, _SAMPLES)
        points = start + share[:, None] * step
        beyond = points - np.clip(points, -half, half)
        best = int(np.argmin(np.einsum("ij,ij->i", beyond, beyond)))
        low, high = share[max(best - 1, 0)], share[min(best + 1, _SAMPLES - 1)]
    on_axis = start + 0.5 * (low + high) * step
    on_box = np.clip(on_axis, -half, half)
    return center + to_box.T @ on_axis, center + to_box.T @ on_box


def _vector(point: Floats) -> Vector:
    x, y, z = (float(value) for value in point)
    return x, y, z
