"""What lies within a mesh that is closed, as boxes: those who ask about a place deep inside learn that it is taken.

A surface alone keeps everything out that comes from outside. But a point that is farther from it than a capsule's
radius looks free from both sides. So the parts of a mesh that are closed are filled: with boxes along the axes of
their largest faces, between planes that lie in those faces and, where others are slanted, a few centimetres apart. A
cell that no triangle touches is inside where the surface winds round it; cells are joined to boxes as large as may be.
Boxes are never outside, and what is left between them and the surface is less than a hand is thick.

A part that is closed and turned inside out is a room: what lies in it is free, unless nobody could stand there.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.obstacles.meshes.cells import boxes_in, filled_cells
from elbowroom.world.obstacles.meshes.clusters import distinct_rows
from elbowroom.world.obstacles.shapes import Mesh

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

_SAME = 1e-5  # metres: corners that are as near are one
_THICK = 0.06  # metres: what is thinner has no place that is far from its surface
_FINEST, _COARSEST = 0.04, 0.06  # metres between planes beside slanted faces
_CELLS = 1_000_000  # of one part; with more, planes are farther apart
_ALIGNED = 1e-3  # how much a normal may be off an axis
_NOBODY = (0.4, 1.2, 0.4)  # metres: a room that is smaller is none
_MOST = 20_000  # boxes of a mesh: the largest


class InnerBoxes(NamedTuple):
    """N boxes within a mesh, along axes of their own."""

    centers: Floats  # (N, 3) metres, in the mesh's axes
    turns: Floats  # (N, 3, 3) from the boxes' axes to the mesh's
    halves: Floats  # (N, 3) metres


_NONE = InnerBoxes(np.empty((0, 3)), np.empty((0, 3, 3)), np.empty((0, 3)))


def inner_boxes(mesh: Mesh) -> InnerBoxes:
    """Boxes in what the mesh encloses."""
    points, faces = _welded(mesh)
    found = [_filled(points[own]) for own in _closed_parts(points, faces)]
    if not found:
        return _NONE
    centers, turns, halves = (np.concatenate(part) for part in zip(*found, strict=True))
    largest = np.argsort(-halves.prod(axis=1), kind="stable")[:_MOST]
    return InnerBoxes(centers[largest], turns[largest], halves[largest])


def enclosing_triangles(mesh: Mesh) -> Floats:
    """The triangles (T, 3, 3) of the closed parts of a mesh, with the rooms in them: they wind round what is inside."""
    points, faces = _welded(mesh)
    return np.concatenate([np.empty((0, 3, 3)), *(points[own] for own in _closed_parts(points, faces))])


def _welded(mesh: Mesh) -> tuple[Floats, Longs]:
    """Corners that are no two in one place, and triangles (F, 3) that are no two the same and have three corners."""
    rounded = np.round((mesh.vertices - mesh.middle) / _SAME).astype(np.int64)
    first, number = distinct_rows(rounded)
    faces = number[mesh.faces]
    ordered = np.sort(faces, axis=1)
    kept, _ = distinct_rows(ordered)
    kept = kept[(np.diff(ordered[kept], axis=1) > 0).all(axis=1)]
    return mesh.vertices[first], faces[kept]


def _closed_parts(points: Floats, faces: Longs) -> Iterator[Longs]:
    """Triangles (F', 3) of each part that is closed and thick, with the rooms in it."""
    solids, rooms = [], []
    for own in _connected(faces):
        if not _is_closed(own, len(points)):
            continue
        corners = points[own]
        size = np.ptp(corners.reshape(-1, 3), axis=0)
        if size.min() < _THICK:
            continue
        if _volume(corners) > 0.0:
            solids.append(own)
        elif (size >= _NOBODY).all():
            rooms.append(own)
        else:
            solids.append(own[:, ::-1])
    for own in solids:
        low, high = points[own].min(axis=(0, 1)), points[own].max(axis=(0, 1))
        held = [room for room in rooms if (points[room] >= low).all() and (points[room] <= high).all()]
        yield np.concatenate([own, *held])


def _connected(faces: Longs) -> Iterator[Longs]:
    """Triangles that hang together by their edges."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components  # slow to import, and seldom needed

    if not len(faces):
        return
    begin, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    _, edge = np.unique(np.minimum(begin, end) * (faces.max() + 1) + np.maximum(begin, end), return_inverse=True)
    face, count = np.repeat(np.arange(len(faces)), 3), len(faces)
    links = coo_array((np.ones(len(edge)), (face, count + edge)), shape=(count + edge.max() + 1,) * 2)
    part = connected_components(links, directed=False)[1][:count]
    order = np.argsort(part, kind="stable")
    yield from np.split(faces[order], np.flatnonzero(np.diff(part[order])) + 1)


def _is_closed(faces: Longs, points: int) -> bool:
    """Whether each edge is gone along as often one way as the other."""
    begin, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    return bool(np.array_equal(np.sort(begin * points + end), np.sort(end * points + begin)))


def _volume(corners: Floats) -> float:
    a, b, c = np.moveaxis(corners - corners.mean(axis=(0, 1)), 1, 0)
    return float(np.einsum("ti,ti->", a, np.cross(b, c))) / 6.0


def _area(corners: Floats) -> float:
    return 0.5 * float(
        np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum()
    )


def _filled(corners: Floats) -> InnerBoxes:
    """Boxes in a closed part (F, 3, 3)."""
    axes, normals = _axes(corners)
    own = corners @ axes.T
    aligned = np.abs(normals @ axes.T) > 1.0 - _ALIGNED
    planes = _planes(own, aligned, 0.8 * _volume(corners) / _area(corners))
    if planes is None:
        return _NONE
    inside = filled_cells(np.ascontiguousarray(own), *planes)
    cells = boxes_in(inside)
    low = np.stack([planes[i][cells[:, i]] for i in range(3)], axis=1)
    high = np.stack([planes[i][cells[:, 3 + i]] for i in range(3)], axis=1)
    thick = (high - low).min(axis=1) > 0.005
    low, high = low[thick] + _SAME, high[thick] - _SAME
    turns = np.broadcast_to(axes.T, (len(low), 3, 3))
    return InnerBoxes(0.5 * (low + high) @ axes, turns, 0.5 * (high - low))


def _axes(corners: Floats) -> tuple[Floats, Floats]:
    """Axes (3, 3) along the normals of the largest faces, and all normals (F, 3)."""
    cross = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sizes = np.linalg.norm(cross, axis=1)
    normals = cross / np.maximum(sizes, 1e-30)[:, None]
    first = normals[np.argmax(sizes)]
    aside = cross - np.outer(cross @ first, first)
    second = aside[np.argmax(np.einsum("ti,ti->t", aside, aside))]
    second = second / np.linalg.norm(second)
    return np.stack([first, second, np.cross(first, second)]), normals


def _planes(corners: Floats, aligned: Bools, wanted: float) -> tuple[Floats, Floats, Floats] | None:
    """Where the cells of a part begin and end along each axis; none where there would be no end of them."""
    low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
    straight = bool(aligned.any(axis=1).all())
    step = max(min(max(wanted, _FINEST), _COARSEST), float(np.cbrt((high - low).prod() / _CELLS)))
    planes = []
    for i in range(3):
        flat = np.round(corners[aligned[:, i], 0, i] / _SAME) * _SAME
        even = low[i] + step * np.arange(1.0, np.ceil((high[i] - low[i]) / step))
        both = np.unique(np.concatenate([[low[i], high[i]], flat, *([] if straight else [even])]))
        planes.append(np.append(both[:-1][np.diff(both) > 3.0 * _SAME], both[-1]))
    return (planes[0], planes[1], planes[2]) if np.prod([len(p) for p in planes]) < 4 * _CELLS else None
