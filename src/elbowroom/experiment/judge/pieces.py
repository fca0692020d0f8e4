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


class MeshPiece(NamedTuple):
    """Some triangles of a mesh, and the box round them."""

    whole: Mesh
    rows: Ints  # (t,) the numbers of its triangles
    middle: Floats  # (3,) of the box, in the mesh's own axes
    to_box: Floats  # (3, 3) from these to the box's
    half_size: Floats  # (3,)

    @property
    def mesh(self) -> Mesh:
        """These triangles by themselves."""
        used, faces = np.unique(self.whole.faces[self.rows], return_inverse=True)
        return Mesh(self.whole.vertices[used], faces.reshape(-1, 3))


class _Triangles(NamedTuple):
    """The triangles of a mesh."""

    whole: Mesh
    middles: Floats  # (T, 3)
    areas: Floats  # (T,) twice as large
    axes: Floats  # (T, 3, 3) rows: along the longest side, across it in the triangle, and out of it


def pieces_of(mesh: Mesh) -> list[MeshPiece]:
    """The mesh in pieces; each of its triangles is in one."""
    triangles, waiting, done = _triangles(mesh), [np.arange(len(mesh.faces))], list[MeshPiece]()
    while waiting:
        rows = waiting.pop()
        if len(rows) == 1 or (len(rows) <= MOST and np.ptp(mesh.corners[rows], axis=(0, 1)).max() <= _SMALL):
            done.append(_piece(triangles, rows))
            continue
        middles = triangles.middles[rows]
        order = rows[np.argsort(middles[:, np.ptp(middles, axis=0).argmax()], kind="stable")]
        waiting += [order[: len(rows) // 2], order[len(rows) // 2 :]]
    return done


def _triangles(mesh: Mesh) -> _Triangles:
    corners = mesh.corners
    sides = np.roll(corners, -1, axis=1) - corners
    longest = sides[np.arange(len(sides)), np.linalg.norm(sides, axis=2).argmax(axis=1)]
    out = np.cross(sides[:, 0], sides[:, 1])
    areas = np.linalg.norm(out, axis=1)
    axes = np.stack([longest, np.cross(out, longest), out], axis=1)
    lengths = np.linalg.norm(axes, axis=2, keepdims=True)
    return _Triangles(mesh, corners.mean(axis=1), areas, axes / np.where(lengths > 0.0, lengths, 1.0))


def _piece(triangles: _Triangles, rows: Ints) -> MeshPiece:
    """In a box along the mesh's axes, or along those of its largest triangle: that which is smaller."""
    points, largest = triangles.whole.corners[rows].reshape(-1, 3), rows[triangles.areas[rows].argmax()]
    ways = (np.eye(3), triangles.axes[largest]) if triangles.areas[largest] > _FLAT else (np.eye(3),)
    middle, axes, half = min((_box(points, axes) for axes in ways), key=lambda box: _surface(*box[2].tolist()))
    return MeshPiece(triangles.whole, rows, middle, axes, half)


def _box(points: Floats, axes: Floats) -> tuple[Floats, Floats, Floats]:
    """The middle, the axes and the half lengths of a box round points (N, 3) along some axes, the rows (3, 3)."""
    seen = points @ axes.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    return 0.5 * (low + high) @ axes, axes, 0.5 * (high - low)


def _surface(x: float, y: float, z: float) -> float:
    return x * y + y * z + z * x
