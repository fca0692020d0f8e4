"""Where a segment and obstacles are closest: for single answers, in double precision, without a compiled kernel.

The distance from a point of the segment to a convex set is a convex function of how far along the segment the point
lies: an interval that holds the least of a row of samples and both its neighbours holds the minimum. Meshes are not
convex, and have a file of their own.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.obstacles.layout import DATA, EDGE, HALF, KIND, LINE, PER_METRE, ROUNDING, TURN, Nearby, ShapeKind
from elbowroom.world.obstacles.meshes.closest_on_mesh import closest_on_mesh

Floats = NDArray[np.float64]

_SAMPLES = 17
_ROUNDS = 6  # each narrows the interval to an eighth: 4e-6 of the segment's length
_TINY = 1e-30


def closest_points(segment: Floats, near: Nearby) -> tuple[Floats, Floats]:
    """The nearest points of a segment (6,) and of each obstacle, both (B, 3), metres.

    They lie on the segment and in the obstacle, so that their distance is never less than the least one; it is more by
    at most 4e-6 of the segment's length.
    """
    rows = near.rows
    centers, to_own = rows[:, :TURN], rows[:, TURN:HALF].reshape(-1, 3, 3)
    begins = np.einsum("bij,bj->bi", to_own, segment[:3] - centers)
    steps = to_own @ (segment[3:] - segment[:3])
    on_axes, on_shapes = begins.copy(), begins.copy()
    for kind in ShapeKind:
        of_kind = np.flatnonzero(rows[:, KIND] == kind)
        if kind is ShapeKind.MESH:
            for b in of_kind:
                on_axes[b], on_shapes[b] = closest_on_mesh(begins[b], steps[b], near.packed, int(rows[b, DATA]))
            continue
        groups = [of_kind] if kind is not ShapeKind.HULL else [of_kind[i : i + 1] for i in range(len(of_kind))]
        for own in groups:
            if len(own):
                on_axes[own], on_shapes[own] = _closest(begins[own], steps[own], rows[own], near)
    back = np.swapaxes(to_own, 1, 2)
    return centers + np.einsum("bij,bj->bi", back, on_axes), centers + np.einsum("bij,bj->bi", back, on_shapes)


def _closest(begins: Floats, steps: Floats, rows: Floats, near: Nearby) -> tuple[Floats, Floats]:
    """The nearest points of axes and shapes of one kind, each (B, 3) in the shape's own axes."""
    low, high = np.zeros(len(rows)), np.ones(len(rows))
    for _ in range(_ROUNDS):
        share = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, _SAMPLES)
        points = begins[:, None] + share[:, :, None] * steps[:, None]
        off = points - _inside(points, rows, near)
        best = np.argmin(np.einsum("bsi,bsi->bs", off, off), axis=1)
        least, most = np.maximum(best - 1, 0), np.minimum(best + 1, _SAMPLES - 1)
        low, high = np.take_along_axis(share, np.stack([least, most], axis=1), axis=1).T
    on_axes = begins + (0.5 * (low + high))[:, None] * steps
    return on_axes, _inside(on_axes[:, None], rows, near)[:, 0]


def _inside(points: Floats, rows: Floats, near: Nearby) -> Floats:
    """The points of shapes (B,) of one kind that are nearest to points (B, S, 3), in the shapes' own axes."""
    half = rows[:, None, HALF:ROUNDING]
    kind = ShapeKind(int(rows[0, KIND]))
    if kind is ShapeKind.CYLINDER:
        away = np.hypot(points[..., 0], points[..., 2])
        shrunk = np.minimum(half[..., 0] / np.maximum(away, _TINY), 1.0)
        high = np.clip(points[..., 1], -half[..., 1], half[..., 1])
        return np.stack([points[..., 0] * shrunk, high, points[..., 2] * shrunk], axis=-1)
    if kind is ShapeKind.HULL:
        return _in_hull(points[0], near, int(rows[0, DATA]))[None]
    inner = np.clip(points, -half, half)
    off = points - inner
    away = np.linalg.norm(off, axis=-1, keepdims=True)
    outer: Floats = inner + off * np.minimum(rows[:, None, ROUNDING, None] / np.maximum(away, _TINY), 1.0)
    return outer


def _in_hull(points: Floats, near: Nearby, line: int) -> Floats:
    """The points of a hull nearest to points (S, 3)."""
    lines = near.packed[line * LINE :].astype(np.float64)
    triangles, edges = int(lines[0]), int(lines[1])
    faces = lines[LINE : LINE * (1 + triangles)].reshape(-1, 4, 4)
    sides = lines[LINE * (1 + triangles) : LINE * (1 + triangles) + EDGE * edges].reshape(-1, EDGE)
    scaled = points[:, None] * PER_METRE
    above = np.einsum("sfi,fki->sfk", np.broadcast_to(scaled, (len(points), triangles, 3)), faces[:, :, :3])
    above = above - faces[:, :, 3]
    found, best = scaled[:, 0].copy(), np.where((above[..., 0] <= 0.0).all(axis=1), 0.0, np.inf)
    over = (above[..., 0] > 0.0) & (above[..., 1:] <= 1e-4).all(axis=2)
    height = np.where(over, above[..., 0], np.inf)
    nearest = np.argmin(height, axis=1)
    each = np.arange(len(points))
    low = height[each, nearest]
    closer = low < best
    found[closer] -= low[closer, None] * faces[nearest[closer], 0, :3]
    best[closer] = low[closer]
    along = np.clip(np.einsum("sei,ei->se", scaled - sides[:, :3], sides[:, 3:6]) * sides[:, 7], 0.0, 1.0)
    on_edges = sides[:, :3] + along[..., None] * sides[:, 3:6]
    gaps = np.linalg.norm(scaled - on_edges, axis=2)
    nearest = np.argmin(gaps, axis=1)
    closer = gaps[each, nearest] < best
    found[closer] = on_edges[each, nearest][closer]
    return found / PER_METRE
