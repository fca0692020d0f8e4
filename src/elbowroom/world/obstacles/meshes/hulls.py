"""Convex hulls as the kernels take them: triangles of their surface and edges, packed one hull after the other."""

from collections.abc import Iterable
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.obstacles.layout import LINE, PER_METRE
from elbowroom.world.obstacles.shapes import Hull

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

THINNEST = 1e-3  # metres
_NONE = np.zeros(0, np.float32)
_FLAT = 1.0 - 1e-12  # cosine of the angle between two triangles of one face


class FlatHullError(ValueError):
    """Points that lie in a plane, or nearly."""


@lru_cache(maxsize=4096)
def surface_of(hull: Hull) -> tuple[Floats, Indices]:
    """The hull's corners (V, 3) and its surface as triangles (T, 3), counter-clockwise seen from outside.

    Raises `FlatHullError` where the hull is thinner than a millimetre.
    """
    from scipy.spatial import ConvexHull, QhullError

    points = hull.array
    try:
        found = ConvexHull(points)
    except (QhullError, ValueError) as error:
        raise FlatHullError from error
    depths = found.equations[:, :3] @ points.T + found.equations[:, 3:]
    if np.min(-depths.min(axis=1)) < THINNEST:
        raise FlatHullError
    corners = points[found.vertices]
    number = np.full(len(points), -1)
    number[found.vertices] = np.arange(len(found.vertices))
    triangles = number[found.simplices].astype(np.int64)
    a, b, c = np.moveaxis(corners[triangles], 1, 0)
    inward = np.einsum("ti,ti->t", np.cross(b - a, c - a), found.equations[:, :3]) < 0.0
    triangles[inward] = triangles[inward][:, [0, 2, 1]]
    return corners, triangles


class PackedHulls(NamedTuple):
    """Some hulls, flat."""

    lines: Floats32  # flat
    begins: dict[Hull, int]  # the line at which each begins


def pack_hulls(hulls: Iterable[Hull]) -> PackedHulls:
    """Some hulls packed; equal ones are there once."""
    begins: dict[Hull, int] = {}
    parts, end = [_NONE], 0
    for hull in hulls:
        if hull not in begins:
            begins[hull] = end
            parts.append(_pack(hull))
            end += len(parts[-1]) // LINE
    return PackedHulls(np.concatenate(parts), begins)


def _pack(hull: Hull) -> Floats32:
    """A head, a line for each triangle, half a line for each edge. In the units of tiles, about the hull's middle."""
    corners, triangles = surface_of(hull)
    corners = (corners - hull.middle) * PER_METRE
    ends = corners[triangles]
    normals = np.cross(ends[:, 1] - ends[:, 0], ends[:, 2] - ends[:, 0])
    sizes = np.linalg.norm(normals, axis=1)
    solid = sizes > 1e-9 * sizes.max()
    ends, normals = ends[solid], normals[solid] / sizes[solid, None]
    faces = np.concatenate([normals, np.einsum("ti,ti->t", normals, ends[:, 0])[:, None]], axis=1)
    sides = []
    for i in range(3):
        begin, step = ends[:, i], ends[:, (i + 1) % 3] - ends[:, i]
        outward = np.cross(step, normals)
        outward /= np.linalg.norm(outward, axis=1, keepdims=True)
        sides += [outward, np.einsum("ti,ti->t", outward, begin)[:, None]]
    edges = _edges(corners, triangles[solid], normals)
    head = np.zeros(LINE)
    head[0], head[1] = len(faces), len(edges)
    lines = np.concatenate([head, np.concatenate([faces, *sides], axis=1).ravel(), edges.ravel()])
    return np.append(lines, np.zeros(-len(lines) % LINE)).astype(np.float32)


def _edges(corners: Floats, triangles: Indices, normals: Floats) -> Floats:
    """The edges (E, EDGE) between faces; those between two triangles of one face are left out."""
    beside: dict[tuple[int, int], list[int]] = {}
    for number, triangle in enumerate(triangles.tolist()):
        for i in range(3):
            a, b = triangle[i], triangle[(i + 1) % 3]
            beside.setdefault((min(a, b), max(a, b)), []).append(number)
    real = [
        ends for ends, both in beside.items() if len(both) != 2 or float(normals[both[0]] @ normals[both[1]]) < _FLAT
    ]
    begin, end = np.moveaxis(corners[np.array(real)], 1, 0)
    squares = np.einsum("ei,ei->e", end - begin, end - begin)[:, None]
    edges: Floats = np.concatenate([begin, end - begin, squares, 1.0 / squares], axis=1)
    return edges
