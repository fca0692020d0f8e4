"""Obstacles as the shapes that stand for them: most as themselves, a mesh as its pieces and the boxes in it."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.meshes.mesh_pieces import pieces_of
from elbowroom.world.obstacles.meshes.solids import inner_boxes
from elbowroom.world.obstacles.shapes import Box, Mesh, Shape

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_UP = np.array([0.0, 1.0, 0.0])
RISE = 0.005  # metres: triangles that rise no higher from the ground are the ground


class ObstacleParts(NamedTuple):
    """B shapes and where they are."""

    shapes: tuple[Shape, ...]
    centers: Floats  # (B, 3)
    rotations: Floats  # (B, 4)
    owners: Longs  # (B,) the numbers of the obstacles that they are parts of, in order


def parts_of(shapes: Sequence[Shape], centers: Floats, rotations: Floats, ground: float) -> ObstacleParts:
    """The parts of obstacles of these shapes whose origins are at `centers` (N, 3), turned by `rotations` (N, 4).

    They stand on level ground of that height.
    """
    parts = [_cut(*posed, ground) for posed in zip(shapes, centers, rotations, strict=True)]
    owners = np.repeat(np.arange(len(parts)), [len(own.shapes) for own in parts])
    if not parts:
        return ObstacleParts((), centers, rotations, owners)
    return ObstacleParts(
        tuple(shape for own in parts for shape in own.shapes),
        np.concatenate([own.centers for own in parts]),
        np.concatenate([own.rotations for own in parts]),
        owners,
    )


def above_ground(mesh: Mesh, center: Floats, turn: Floats, ground: float) -> Mesh | None:
    """The triangles of a mesh that rise from the ground; none where it is nothing but ground."""
    heights = quaternion.rotate(turn, mesh.vertices)[:, 1] + center[1]
    rises = heights[mesh.faces].max(axis=1) > ground + RISE
    if rises.all():
        return mesh
    return Mesh(mesh.vertices, mesh.faces[rises]) if rises.any() else None


def _cut(shape: Shape, center: Floats, turn: Floats, ground: float) -> ObstacleParts:
    if not isinstance(shape, Mesh):
        return _in_one_place((shape,), center, turn)
    standing = above_ground(shape, center, turn, ground)
    up = quaternion.rotate(quaternion.conjugate(turn), _UP)
    pieces = _in_one_place(pieces_of(standing, up) if standing is not None else (), center, turn)
    inner = _within(shape, center, turn, ground)
    return ObstacleParts(
        pieces.shapes + inner.shapes,
        np.concatenate([pieces.centers, inner.centers]),
        np.concatenate([pieces.rotations, inner.rotations]),
        np.concatenate([pieces.owners, inner.owners]),
    )


def _in_one_place(shapes: tuple[Shape, ...], center: Floats, turn: Floats) -> ObstacleParts:
    many = len(shapes)
    return ObstacleParts(shapes, np.tile(center, (many, 1)), np.tile(turn, (many, 1)), np.zeros(many, np.int64))


def _within(mesh: Mesh, center: Floats, turn: Floats, ground: float) -> ObstacleParts:
    """The boxes in what a mesh encloses, those that rise from the ground."""
    boxes = inner_boxes(mesh)
    rotations = quaternion.multiply(turn, quaternion.from_matrix(boxes.turns))
    centers = center + quaternion.rotate(turn, boxes.centers)
    up = quaternion.to_matrix(rotations)[:, 1]
    rises = centers[:, 1] + np.einsum("bi,bi->b", np.abs(up), boxes.halves) > ground + RISE
    shapes = tuple(Box((x, y, z)) for x, y, z in (2.0 * boxes.halves[rises]).tolist())
    return ObstacleParts(shapes, centers[rises], rotations[rises], np.zeros(len(shapes), np.int64))
