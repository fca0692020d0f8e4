"""Meshes as the kernels take them: triangles in clusters, packed one mesh after the other.

A mesh begins with a line that tells how many clusters it has. A cluster begins with a line: how many triangles and how
many edges, the middle and half lengths of a box round it. Then a line for each triangle, as in hulls, and half a line
for each edge. All in the units of tiles, about the mesh's middle.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.obstacles.layout import EDGE, LINE, PER_METRE
from elbowroom.world.obstacles.meshes.clusters import clusters_of, distinct_rows
from elbowroom.world.obstacles.shapes import Mesh

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

_FEW = 8  # triangles of a cluster
_THIN = 1e-6 * PER_METRE  # height of a triangle that is no more than its edges
_FLAT = 1.0 - 1e-12  # cosine of the angle between two triangles of one face
_TINY = 1e-30


class _Edges(NamedTuple):
    rows: Floats  # (E, EDGE)
    cluster: Longs  # (E,) increasing


def pack_meshes(meshes: Sequence[Mesh]) -> tuple[Floats32, Longs]:
    """All of them, flat, and the line at which each begins (M,)."""
    if not meshes:
        return np.zeros(0, np.float32), np.zeros(0, np.int64)
    sizes = [len(mesh.faces) for mesh in meshes]
    whose = np.repeat(np.arange(len(meshes)), sizes)
    corners = np.concatenate([mesh.corners - mesh.middle for mesh in meshes]) * PER_METRE
    cluster = clusters_of(corners, whose, _FEW, _FEW, np.inf)
    order = np.argsort(cluster, kind="stable")
    order = order[np.argsort(whose[order], kind="stable")]
    corners, whose = corners[order], whose[order]
    cluster = np.cumsum(np.append(0, np.diff(cluster[order]) != 0))  # now of one mesh after the other
    faces, solid = _faces(corners)
    edges = _edges(corners, cluster, np.where(solid[:, None], faces[:, :3], np.nan))
    return _laid_out(corners, cluster, whose, faces, solid, edges)


def _faces(corners: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Plane and planes through the sides of each triangle (T, LINE), and whether it has any to speak of (T,)."""
    steps = np.roll(corners, -1, axis=1) - corners
    normals = np.cross(steps[:, 0], steps[:, 1])
    sizes, lengths = np.linalg.norm(normals, axis=1), np.linalg.norm(steps, axis=2)
    solid = sizes > _THIN * lengths.max(axis=1)
    normals = normals / np.maximum(sizes, _TINY)[:, None]
    planes = [normals, np.einsum("ti,ti->t", normals, corners[:, 0])[:, None]]
    for i in range(3):
        outward = np.cross(steps[:, i], normals) / np.maximum(lengths[:, i, None], _TINY)
        planes += [outward, np.einsum("ti,ti->t", outward, corners[:, i])[:, None]]
    return np.concatenate(planes, axis=1), solid


def _edges(corners: Floats, cluster: Longs, normals: Floats) -> _Edges:
    """The edges of each cluster, once; without those between two triangles of one face."""
    first, number = distinct_rows(corners.reshape(-1, 3))
    points, ends = corners.reshape(-1, 3)[first], number.reshape(-1, 3)
    begin, end = ends.ravel(), np.roll(ends, -1, axis=1).ravel()
    face = np.repeat(np.arange(len(ends)), 3)
    key = (cluster[face] * len(points) + np.minimum(begin, end)) * len(points) + np.maximum(begin, end)
    order = np.argsort(key, kind="stable")
    _, begins, uses = np.unique(key[order], return_index=True, return_counts=True)
    one, other = order[begins], order[np.minimum(begins + 1, len(order) - 1)]
    opposite = (uses == 2) & (begin[one] == end[other])
    level = np.einsum("ei,ei->e", normals[face[one]], normals[face[other]]) >= _FLAT
    kept = one[~(opposite & level)]
    start, step = points[begin[kept]], points[end[kept]] - points[begin[kept]]
    squares = np.einsum("ei,ei->e", step, step)[:, None]
    per_square = np.where(squares > _TINY, 1.0 / np.maximum(squares, _TINY), 0.0)
    return _Edges(np.concatenate([start, step, squares, per_square], axis=1), cluster[face[kept]])


def _laid_out(
    corners: Floats, cluster: Longs, whose: Longs, faces: Floats, solid: NDArray[np.bool_], edges: _Edges
) -> tuple[Floats32, Longs]:
    """Clusters and what is in them, line by line."""
    many = int(cluster[-1]) + 1
    owner = np.zeros(many, np.int64)
    owner[cluster] = whose
    triangles, rims = np.bincount(cluster[solid], minlength=many), np.bincount(edges.cluster, minlength=many)
    lines = 1 + triangles + (rims + 1) // 2
    before = np.cumsum(lines) - lines + owner + 1  # and a line for each mesh until there
    out = np.zeros((int(lines.sum()) + int(owner[-1]) + 1, LINE), np.float32)
    begins = before[np.searchsorted(owner, np.arange(owner[-1] + 1))] - 1
    out[begins, 0] = np.bincount(owner)
    starts = np.searchsorted(cluster, np.arange(many))
    low = np.minimum.reduceat(corners.min(axis=1), starts)
    high = np.maximum.reduceat(corners.max(axis=1), starts)
    out[before, :8] = np.column_stack([triangles, rims, 0.5 * (low + high), 0.5 * (high - low)])
    out[_places(before + 1, triangles)] = faces[solid]
    out.reshape(-1, EDGE)[_places(2 * (before + 1 + triangles), rims)] = edges.rows
    return out.ravel(), begins


def _places(starts: Longs, counts: Longs) -> Longs:
    """Numbers from each start on, as many as are counted there, one after the other."""
    places: Longs = np.repeat(starts - (np.cumsum(counts) - counts), counts) + np.arange(int(counts.sum()))
    return places
