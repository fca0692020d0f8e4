"""A mesh in pieces, each in a small box of its own: what is far from the box is far from all that is in it.

A building's wall is one mesh, and the box round it holds the door in it and whoever goes through. So triangles are
parted until each piece is small or a single one, and a slanted one lies in a box that is slanted as it is.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.obstacles.shapes import Mesh

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_SMALL, MOST = 0.5, 32  # metres, and triangles: a piece that has no longer side and no more of them is left whole
_FLAT = 1e-12  # square metres: a smaller triangle says nothing of how it is turned


class Piece(NamedTuple):
    """Some triangles of a mesh, and the box round them."""

    mesh: Mesh
    middle: Floats  # (3,) of the box, in the mesh's own axes
    to_box: Floats  # (3, 3) from these to the box's
    half_size: Floats  # (3,)


def pieces_of(mesh: Mesh) -> list[Piece]:
    """The mesh in pieces; each of its triangles is in one."""
    waiting, done = [np.arange(len(mesh.faces))], list[Piece]()
    while waiting:
        rows = waiting.pop()
        corners = mesh.corners[rows]
        if len(rows) == 1 or (len(rows) <= MOST and np.ptp(corners, axis=(0, 1)).max() <= _SMALL):
            done.append(_piece(mesh, rows))
            continue
        middles = corners.mean(axis=1)
        order = rows[np.argsort(middles[:, np.ptp(middles, axis=0).argmax()], kind="stable")]
        waiting += [order[: len(rows) // 2], order[len(rows) // 2 :]]
    return done


def _piece(mesh: Mesh, rows: Ints) -> Piece:
    used, faces = np.unique(mesh.faces[rows], return_inverse=True)
    vertices = mesh.vertices[used]
    boxes = [_box(vertices, axes) for axes in (np.eye(3), *_along_largest(mesh.corners[rows]))]
    middle, axes, half = min(boxes, key=lambda box: float(box[2] @ np.roll(box[2], 1)))
    return Piece(Mesh(vertices, faces.reshape(-1, 3)), middle, axes, half)


def _box(vertices: Floats, axes: Floats) -> tuple[Floats, Floats, Floats]:
    """The middle, the axes and the half lengths of a box round vertices (V, 3) along some axes, the rows (3, 3)."""
    seen = vertices @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    return 0.5 * (low + high) @ axes, axes, 0.5 * (high - low)


def _along_largest(corners: Floats) -> list[Floats]:
    """Axes, the rows (3, 3), two of them in the largest triangle and one along its longest side; none if it is flat."""
    sides = np.roll(corners, -1, axis=1) - corners  # (T, 3, 3)
    normals = np.cross(sides[:, 0], sides[:, 1])
    which = int(np.linalg.norm(normals, axis=1).argmax())
    normal, longest = normals[which], sides[which, np.linalg.norm(sides[which], axis=1).argmax()]
    if np.linalg.norm(normal) < _FLAT:
        return []
    normal, longest = normal / np.linalg.norm(normal), longest / np.linalg.norm(longest)
    return [np.stack([longest, np.cross(normal, longest), normal])]
