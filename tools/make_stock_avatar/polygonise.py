"""Clay to mesh: naive surface nets on a lattice, then vertices relaxed on and drawn onto the surface.

Method: S. F. Frisken Gibson, "Constrained elastic surface nets", MERL TR99-24 (1999).
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from make_stock_avatar.fields import Array, Field, normals, value_and_gradient


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles wound counter-clockwise seen from outside."""

    points: Array  # (V, 3) metres
    normals: Array  # (V, 3) unit
    triangles: NDArray[np.int64]  # (T, 3)

    def mirrored(self) -> "Mesh":
        """The same on the other side of x = 0."""
        flip = np.array([-1.0, 1.0, 1.0])
        return Mesh(self.points * flip, self.normals * flip, self.triangles[:, ::-1])

    def without(self, hidden: NDArray[np.bool_]) -> "Mesh":
        """The mesh less the triangles whose three points are all `hidden` (V,)."""
        kept = self.triangles[~hidden[self.triangles].all(axis=1)]
        used = np.zeros(len(self.points), bool)
        used[kept] = True
        index = np.cumsum(used) - 1
        return Mesh(self.points[used], self.normals[used], index[kept])


def lattice(low: tuple[float, ...], high: tuple[float, ...], cell: tuple[float, ...]) -> Array:
    """Corners of a box lattice (nx, ny, nz, 3), centred in its box so that a symmetric box gives mirrored corners."""
    lines = []
    for a, b, h in zip(low, high, cell, strict=True):
        count = int(np.ceil((b - a) / h)) + 1
        lines.append((a + b) / 2 + (np.arange(count) - (count - 1) / 2) * h)
    return np.stack(np.meshgrid(*lines, indexing="ij"), axis=-1)


def snapped(points: Array) -> Array:
    """Points on a grid far finer than the figure's details.

    Processors differ in the last bits of mathematical functions; every choice between triangles is made on snapped
    points, so that it falls alike everywhere.
    """
    return np.round(points * 2.0**22) / 2.0**22


def is_manifold(triangles: NDArray[np.int64]) -> bool:
    """Whether no directed edge is used twice by polygons (N, 3 or 4)."""
    base = int(triangles.max()) + 1
    keys = (triangles * base + np.roll(triangles, -1, axis=1)).ravel()
    return len(np.unique(keys)) == len(keys)


def polygonise(field: Field, corners: Array, relax: int = 4, warp: Callable[[Array], Array] | None = None) -> Mesh:
    """The zero level of `field` on a lattice (nx, ny, nz, 3); `warp` bends the corners first.

    Raises ValueError where two sheets of the surface share a cell: choose another cell size or thicker clay.
    """
    shape = corners.shape[:3]
    points = corners.reshape(-1, 3)
    points = warp(points) if warp else points
    values = field(points).reshape(shape)
    vertices, cells = _cell_vertices(values, points.reshape(*shape, 3))
    quads = _quads(values, cells)
    if not is_manifold(quads):
        raise ValueError("two sheets of the surface share a cell of the lattice")
    vertices = _settle(field, vertices, quads, relax)
    return Mesh(vertices, normals(field, vertices), _triangles(vertices, quads))


def _cell_vertices(values: Array, points: Array) -> tuple[Array, NDArray[np.int64]]:
    """One vertex in every cell that the surface crosses: the mean of its edge crossings."""
    total = np.zeros((*(n - 1 for n in values.shape), 3))
    count = np.zeros(total.shape[:3])
    for axis in range(3):
        low, high = _slices(axis, 0), _slices(axis, 1)
        a, b = values[low], values[high]
        crosses = (a < 0) != (b < 0)
        u = np.where(crosses, a / np.where(crosses, a - b, 1.0), 0.0)[..., None]
        at = np.where(crosses[..., None], points[low] * (1 - u) + points[high] * u, 0.0)
        first, second = (i for i in range(3) if i != axis)
        for di in (0, 1):
            for dj in (0, 1):
                pick = [slice(None)] * 3
                pick[first] = slice(di, values.shape[first] - 1 + di)
                pick[second] = slice(dj, values.shape[second] - 1 + dj)
                total += at[tuple(pick)]
                count += crosses[tuple(pick)]
    live = count > 0
    cells = np.full(count.shape, -1, np.int64)
    cells[live] = np.arange(int(live.sum()))
    return snapped(total[live] / count[live][:, None]), cells


def _slices(axis: int, offset: int) -> tuple[slice, ...]:
    return tuple(slice(offset, -1 if offset == 0 else None) if i == axis else slice(None) for i in range(3))


def _quads(values: Array, cells: NDArray[np.int64]) -> NDArray[np.int64]:
    """A quad around every lattice edge that the surface crosses, (Q, 4)."""
    quads = []
    for axis in range(3):
        first, second = (axis + 1) % 3, (axis + 2) % 3
        inner: list[slice] = [slice(None)] * 3
        inner[first] = inner[second] = slice(1, -1)
        a = values[_slices(axis, 0)][tuple(inner)]
        b = values[_slices(axis, 1)][tuple(inner)]
        at = np.argwhere((a < 0) != (b < 0))
        outward = a[tuple(at.T)] < 0
        at[:, first] += 1
        at[:, second] += 1
        ring = []
        for di, dj in ((1, 1), (0, 1), (0, 0), (1, 0)):
            corner = at.copy()
            corner[:, first] -= di
            corner[:, second] -= dj
            ring.append(cells[tuple(corner.T)])
        quad = np.column_stack(ring)
        quads.append(np.where(outward[:, None], quad, quad[:, ::-1]))
    return np.concatenate(quads)


def _settle(field: Field, vertices: Array, quads: NDArray[np.int64], relax: int) -> Array:
    """Even out the net along the surface, then draw it onto the surface."""
    size = np.linalg.norm(vertices[quads[:, 0]] - vertices[quads[:, 2]], axis=1).mean()
    for _ in range(relax):
        total, count = np.zeros_like(vertices), np.zeros(len(vertices))
        for i in range(4):
            for j in (i - 1, (i + 1) % 4):
                np.add.at(total, quads[:, i], vertices[quads[:, j]])
                np.add.at(count, quads[:, i], 1.0)
        moved = 0.5 * (vertices + total / count[:, None])
        vertices = drawn_to(field, moved, size, steps=1)
    return drawn_to(field, vertices, size, steps=3)


def drawn_to(field: Field, points: Array, limit: float, steps: int = 2) -> Array:
    """Newton steps onto the surface, none longer than half of `limit`."""
    for _ in range(steps):
        value, slope = value_and_gradient(field, points)
        step = -value[:, None] * slope / np.maximum((slope * slope).sum(axis=1, keepdims=True), 0.05)
        length = np.linalg.norm(step, axis=1, keepdims=True)
        points = snapped(points + step * np.minimum(1.0, 0.5 * limit / np.maximum(length, 1e-12)))
    return points


def _triangles(vertices: Array, quads: NDArray[np.int64]) -> NDArray[np.int64]:
    """Each quad cut along its shorter diagonal."""
    corner = vertices[quads]
    across = np.linalg.norm(corner[:, 0] - corner[:, 2], axis=1) <= np.linalg.norm(corner[:, 1] - corner[:, 3], axis=1)
    one = np.where(across[:, None], quads[:, [0, 1, 2]], quads[:, [0, 1, 3]])
    two = np.where(across[:, None], quads[:, [0, 2, 3]], quads[:, [1, 2, 3]])
    return np.concatenate([one, two])
