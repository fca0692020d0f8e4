"""Obstacles that stand as the rows that stand for them: most are one, a mesh is one for each of its pieces."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.mesh_pieces import pieces_of
from elbowroom.world.obstacles.shapes import Mesh, Shape

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

RISE = 0.005  # metres: triangles that rise no higher from the ground are the ground


class Parts(NamedTuple):
    """B shapes and where they are."""

    shapes: tuple[Shape, ...]
    centers: Floats  # (B, 3)
    rotations: Floats  # (B, 4)
    owners: Longs  # (B,) the numbers of the obstacles that they are parts of, in order


def parts_of(shapes: Sequence[Shape], centers: Floats, rotations: Floats, ground: float) -> Parts:
    """The parts of obstacles of these shapes whose origins are at `centers` (N, 3), turned by `rotations` (N, 4).

    They stand on level ground of that height.
    """
    cut = [_cut(*posed, ground) for posed in zip(shapes, centers, rotations, strict=True)]
    owners = np.repeat(np.arange(len(cut)), [len(own) for own in cut])
    return Parts(tuple(part for own in cut for part in own), centers[owners], rotations[owners], owners)


def above_ground(mesh: Mesh, center: Floats, turn: Floats, ground: float) -> Mesh | None:
    """The triangles of a mesh that rise from the ground; none where it is nothing but ground."""
    heights = quaternion.rotate(turn, mesh.vertices)[:, 1] + center[1]
    rises = heights[mesh.faces].max(axis=1) > ground + RISE
    if rises.all():
        return mesh
    return Mesh(mesh.vertices, mesh.faces[rises]) if rises.any() else None


def _cut(shape: Shape, center: Floats, turn: Floats, ground: float) -> tuple[Shape, ...]:
    if not isinstance(shape, Mesh):
        return (shape,)
    standing = above_ground(shape, center, turn, ground)
    return pieces_of(standing) if standing is not None else ()
