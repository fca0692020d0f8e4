"""What the collision library does not tell of triangles: which are none, and how far two meshes cross each other."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_FLAT = 1e-12  # square metres: edges that span less are taken as parallel, and give no direction


def crossing_depths(one: Floats, other: Floats) -> Floats:
    """How far (N,) each of `one` has to be moved to leave its partner in `other`, metres; 0 for those apart.

    Corners are (N, 3, 3). Two triangles are apart along the normal of one of them or across an edge of each if they
    are at all (Gottschalk's separating axes), so the least overlap along these is the shortest way out.
    """
    axes, told = _axes(one, other)
    heights, others = (np.einsum("nci,nai->nac", corners, axes) for corners in (one, other))
    ahead, behind = heights.max(axis=2) - others.min(axis=2), others.max(axis=2) - heights.min(axis=2)
    overlaps = np.where(told, np.minimum(ahead, behind), np.inf)
    depths: Floats = np.maximum(overlaps.min(axis=1), 0.0)
    return np.where(told.any(axis=1), depths, 0.0)


def has_area(corners: Floats) -> NDArray[np.bool_]:
    """Which triangles (..., 3, 3) are any, shape (...).

    Of one with two corners in one place nothing is seen, and the library takes it to be in the middle of every ball.
    """
    sides = corners[..., 1:, :] - corners[..., :1, :]
    seen: NDArray[np.bool_] = np.linalg.norm(np.cross(sides[..., 0, :], sides[..., 1, :]), axis=-1) > _FLAT
    return seen


def _axes(one: Floats, other: Floats) -> tuple[Floats, NDArray[np.bool_]]:
    """Unit directions (N, 11, 3) along which two triangles may be apart, and which (N, 11) say anything."""
    edges = [np.roll(corners, -1, axis=1) - corners for corners in (one, other)]
    normals = np.stack([np.cross(sides[:, 0], sides[:, 1]) for sides in edges], axis=1)
    across = np.cross(edges[0][:, :, None], edges[1][:, None]).reshape(-1, 9, 3)
    axes = np.concatenate([normals, across], axis=1)
    lengths = np.linalg.norm(axes, axis=2)
    told = lengths > _FLAT
    return axes / np.where(told, lengths, 1.0)[..., None], told
