"""A mesh cut into pieces, each in a small box of its own: so that what is near somewhere is near and not elsewhere.

Level triangles are pieces of their own, those of one height: so a floor is told from what stands on it.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.obstacles.meshes.clusters import clusters_of
from elbowroom.world.obstacles.shapes import Mesh

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_FEWEST, _MOST = 8, 64  # triangles of a piece, and where they lie close
_CLOSE = 1.0  # metres
_LONGEST = 4.0  # metres: the side of a triangle; one that is longer is halved
_HALVES = 400_000  # triangles, beyond which none is halved
_LEVEL, _SAME = 1e-3, 0.01  # metres by which a level triangle rises, and in which heights are one
_UP = np.array([0.0, 1.0, 0.0])


def pieces_of(mesh: Mesh, up: Floats = _UP) -> tuple[Mesh, ...]:
    """The mesh in pieces that hold the same surface, about the same origin; `up` (3,) points up in its own axes."""
    corners = _halved(mesh.corners)
    piece = clusters_of(corners, _levels(corners @ up), _FEWEST, _MOST, _CLOSE)
    order = np.argsort(piece, kind="stable")
    ends = np.flatnonzero(np.diff(piece[order])) + 1
    return tuple(_soup(part) for part in np.split(corners[order], ends))


def _levels(heights: Floats) -> Longs:
    """A number for the height of each level triangle (T,), of those with corners at `heights` (T, 3); 0 of the others.

    Metres.
    """
    least, most = heights.min(axis=1), heights.max(axis=1)
    _, number = np.unique(np.floor(most / _SAME), return_inverse=True)
    return np.where(most - least <= _LEVEL, 1 + number, 0)


def _soup(corners: Floats) -> Mesh:
    """Triangles by their corners (T, 3, 3)."""
    return Mesh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


def _halved(corners: Floats) -> Floats:
    """Triangles (T, 3, 3) in halves, until none has a side that is too long."""
    done: list[Floats] = []
    rest, many = corners, len(corners)
    while len(rest):
        sides = np.linalg.norm(np.roll(rest, -1, axis=1) - rest, axis=2)
        long = (sides.max(axis=1) > _LONGEST) & (many < _HALVES)
        many += int(long.sum())
        done.append(rest[~long])
        turned = (sides[long].argmax(axis=1)[:, None] + np.arange(3)) % 3
        a, b, c = np.moveaxis(np.take_along_axis(rest[long], turned[:, :, None], axis=1), 1, 0)
        middle = 0.5 * (a + b)
        rest = np.concatenate([np.stack([a, middle, c], axis=1), np.stack([middle, b, c], axis=1)])
    return np.concatenate(done)
