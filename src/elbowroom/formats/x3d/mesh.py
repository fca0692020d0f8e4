"""Triangles with what belongs to their corners, and how they are made from the index lists of X3D."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_MAX_PAIRS = 4_000_000  # of corners at the same point; with more, creases are not looked for
_GRID = 1000.0  # normals that agree to three digits are one


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles with vertices of their own."""

    points: Floats  # (V, 3)
    triangles: Ints  # (T, 3) vertices, counter-clockwise seen from outside
    sources: Ints  # (V,) the point of the file's Coordinate node that a vertex comes from
    normals: Floats | None = None  # (V, 3) unit; None: flat faces
    colours: Floats | None = None  # (V, 4) RGBA as in the file
    uvs: Floats | None = None  # (V, 2) origin at the lower left
    two_sided: bool = False


@dataclass(frozen=True, eq=False)
class Corners:
    """The corners of triangles, each with its own indices: how X3D writes faces."""

    points: Floats  # (P, 3)
    at: Ints  # (3T,) point of each corner, three a triangle
    normals: tuple[Floats, Ints] | None = None  # vectors (N, 3), index (3T,)
    colours: tuple[Floats, Ints] | None = None  # RGBA (C, 4), index (3T,)
    uvs: tuple[Floats, Ints] | None = None  # (U, 2), index (3T,)
    two_sided: bool = False


def assembled(corners: Corners) -> Mesh:
    """One vertex for each set of indices that occurs."""
    key, count = _compact(corners.at)
    for attribute in (corners.normals, corners.colours, corners.uvs):
        if attribute is not None:
            other, size = _compact(attribute[1])
            key, count = _compact(key * size + other)
    first = np.zeros(count, dtype=np.int64)
    first[key[::-1]] = np.arange(len(key) - 1, -1, -1)
    sources = corners.at[first]

    def picked(attribute: tuple[Floats, Ints] | None) -> Floats | None:
        return None if attribute is None else attribute[0][attribute[1][first]]

    return Mesh(
        points=corners.points[sources],
        triangles=key.reshape(-1, 3),
        sources=sources,
        normals=picked(corners.normals),
        colours=picked(corners.colours),
        uvs=picked(corners.uvs),
        two_sided=corners.two_sided,
    )


def creased_normals(points: Floats, at: Ints, crease: float) -> tuple[Floats, Ints] | None:
    """Normals of corners (3T,), smooth across edges that bend by less than `crease` radians; None: flat faces."""
    if crease < 1e-3 or not len(at):
        return None
    triangle = points[at].reshape(-1, 3, 3)
    weighted = np.cross(triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0])
    facing = np.repeat(_unit(weighted), 3, axis=0)
    weighted = np.repeat(weighted, 3, axis=0)
    order = np.argsort(at, kind="stable")
    starts = np.flatnonzero(np.diff(at[order], prepend=-1))
    sizes = np.diff(starts, append=len(at))
    if float((sizes.astype(np.float64) ** 2).sum()) > _MAX_PAIRS or crease >= np.pi:
        sums = np.add.reduceat(weighted[order], starts, axis=0)
        normals = np.empty_like(weighted)
        normals[order] = np.repeat(sums, sizes, axis=0)
    else:
        group_size = np.repeat(sizes, sizes)
        a = np.repeat(np.arange(len(at)), group_size)
        within = np.arange(len(a)) - np.repeat(np.cumsum(group_size) - group_size, group_size)
        b = np.repeat(np.repeat(starts, sizes), group_size) + within
        a, b = order[a], order[b]
        near = np.einsum("pi,pi->p", facing[a], facing[b]) >= np.cos(crease) - 1e-9
        normals = np.stack([np.bincount(a[near], weighted[b[near], k], len(at)) for k in range(3)], axis=1)
    return _merged(_unit(normals))


def _merged(normals: Floats) -> tuple[Floats, Ints]:
    grid = np.round(normals * _GRID).astype(np.int64) + 2000
    key = (grid[:, 0] * 4001 + grid[:, 1]) * 4001 + grid[:, 2]
    _, first, index = np.unique(key, return_index=True, return_inverse=True)
    return normals[first], index.astype(np.int64)


def _unit(vectors: Floats) -> Floats:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit: Floats = np.where(length > 1e-30, vectors / np.maximum(length, 1e-30), np.array([0.0, 1.0, 0.0]))
    return unit


def _compact(key: Ints) -> tuple[Ints, int]:
    """The keys renumbered without gaps, and how many there are."""
    values, index = np.unique(key, return_inverse=True)
    return index.astype(np.int64), len(values)
