"""Clay: distance-like fields, negative inside, and the ways to join and carve them.

Formulas of the round cone, the ellipsoid and the polynomial smooth minimum: Inigo Quilez, "Distance functions" and
"Smooth minimum" (iquilezles.org).
"""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Field = Callable[[Array], Array]  # points (N, 3) metres -> (N,) about metres, negative inside


def mirrored(points: Array) -> Array:
    """The points with x made positive: a field of the left side then serves both."""
    return np.column_stack([np.abs(points[:, 0]), points[:, 1], points[:, 2]])


def sphere(p: Array, centre: ArrayLike, radius: float) -> Array:
    return np.asarray(np.linalg.norm(p - np.asarray(centre), axis=1) - radius)


def ellipsoid(p: Array, centre: ArrayLike, radii: ArrayLike) -> Array:
    q = (p - np.asarray(centre)) / np.asarray(radii)
    k = np.sqrt((q * q).sum(axis=1))
    slope = np.sqrt(((q / np.asarray(radii)) ** 2).sum(axis=1))
    return np.asarray(k * (k - 1.0) / np.maximum(slope, 1e-9))


def round_cone(p: Array, a: ArrayLike, b: ArrayLike, ra: float, rb: float) -> Array:
    """A ball of radius `ra` at `a` and one of radius `rb` at `b`, and the cone that hugs both."""
    a, axis = np.asarray(a, float), np.asarray(b, float) - np.asarray(a, float)
    length2 = float((axis * axis).sum())
    step = ra - rb
    a2 = length2 - step * step
    pa = p - a
    y = (pa * axis).sum(axis=1)
    z = y - length2
    x2 = ((pa * length2 - y[:, None] * axis) ** 2).sum(axis=1)
    y2, z2 = y * y * length2, z * z * length2
    k = np.sign(step) * step * step * x2
    cone = (np.sqrt(x2 * a2 / length2) + y * step) / length2 - ra
    near_b = np.sqrt(x2 + z2) / length2 - rb
    near_a = np.sqrt(x2 + y2) / length2 - ra
    round_end = np.where(np.sign(y) * a2 * y2 < k, near_a, cone)
    return np.asarray(np.where(np.sign(z) * a2 * z2 > k, near_b, round_end))


def chain(p: Array, joints: ArrayLike, radii: Sequence[float], k: float = 0.0) -> Array:
    """Round cones along a line of joints."""
    points = np.asarray(joints, float)
    result = round_cone(p, points[0], points[1], radii[0], radii[1])
    for i in range(1, len(points) - 1):
        result = union(result, round_cone(p, points[i], points[i + 1], radii[i], radii[i + 1]), k)
    return result


def union(a: Array, b: Array, k: float = 0.0) -> Array:
    """Smooth minimum with blend width `k`, metres."""
    if k <= 0.0:
        return np.minimum(a, b)
    h = np.maximum(k - np.abs(a - b), 0.0) / k
    return np.minimum(a, b) - h * h * k * 0.25


def common(a: Array, b: Array, k: float = 0.0) -> Array:
    """What is inside both, the edge rounded over `k` metres."""
    return -union(-a, -b, k)


def carved(a: Array, tool: Array, k: float = 0.0) -> Array:
    """What is inside `a` and outside `tool`."""
    return common(a, -tool, k)


_TETRAHEDRON = np.array([[1.0, -1.0, -1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, 1.0, 1.0]])


def value_and_gradient(field: Field, points: Array, step: float = 3e-4) -> tuple[Array, Array]:
    """A field's values (N,) and gradients (N, 3) from its values at the corners of a small tetrahedron."""
    corners = [field(points + step * corner) for corner in _TETRAHEDRON]
    slope = sum(v[:, None] * corner for v, corner in zip(corners, _TETRAHEDRON, strict=True)) / (4.0 * step)
    return np.asarray(np.mean(corners, axis=0)), np.asarray(slope)


def normals(field: Field, points: Array) -> Array:
    """Outward unit normals of a field's level sets, (N, 3)."""
    _, slope = value_and_gradient(field, points)
    return np.asarray(slope / np.maximum(np.linalg.norm(slope, axis=1, keepdims=True), 1e-12))
