"""Extrusion and ElevationGrid as triangles (ISO/IEC 19775-1, 13.3.5 and 13.3.4)."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.polygons import ears
from elbowroom.formats.x3d.mesh import Corners, Mesh, assembled, creased_normals
from elbowroom.formats.x3d.model import Node
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_MOST_POINTS = 300_000
_SQUARE = (1.0, 1.0, 1.0, -1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0)


def extrusion(node: Node) -> Mesh | None:
    """An Extrusion; None if it has no length or no width."""
    section = node.vectors("crossSection", 2) if node.has("crossSection") else np.reshape(_SQUARE, (-1, 2))
    spine = node.vectors("spine", 3) if node.has("spine") else np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    if len(section) < 2 or len(spine) < 2:
        return None
    if len(section) * len(spine) > _MOST_POINTS:
        raise InputError(f"{node.place} has {len(section)} x {len(spine)} points: at most {_MOST_POINTS} are read")
    scale = _along(node, "scale", 2, (1.0, 1.0), len(spine))
    turn = _along(node, "orientation", 4, (0.0, 0.0, 1.0, 0.0), len(spine))
    axis = turn[:, :3] / np.maximum(np.linalg.norm(turn[:, :3], axis=1, keepdims=True), 1e-12)
    turns = quaternion.from_rotation_vector(axis * turn[:, 3:])
    flat = np.zeros((len(spine), len(section), 3))
    flat[:, :, [0, 2]] = section * scale[:, None, :]
    turned = quaternion.rotate(turns[:, None, :], flat)
    points = (np.einsum("nij,nkj->nki", _frames(spine), turned) + spine[:, None, :]).reshape(-1, 3)
    at = _swept(node, points, section, len(spine))
    if not node.flag("ccw", True):
        at = at.reshape(-1, 3)[:, ::-1].reshape(-1)
    normals = creased_normals(points, at, node.number("creaseAngle", 0.0))
    return assembled(Corners(points, at, normals, two_sided=not node.flag("solid", True)))


def elevation_grid(node: Node) -> Mesh | None:
    """An ElevationGrid; None if it has no area."""
    columns, rows = int(node.number("xDimension", 0.0)), int(node.number("zDimension", 0.0))
    heights = node.numbers("height")
    if columns < 2 or rows < 2:
        return None
    if len(heights) < columns * rows:
        raise InputError(f"{node.place}.height has {len(heights)} numbers: {columns} x {rows} are needed")
    z, x = np.divmod(np.arange(columns * rows), columns)
    spacing = node.number("xSpacing", 1.0), node.number("zSpacing", 1.0)
    points = np.column_stack([x * spacing[0], heights[: columns * rows], z * spacing[1]])
    cell = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).reshape(-1)
    below = cell + columns
    at = np.stack([cell, below, below + 1, cell, below + 1, cell + 1], axis=1).reshape(-1)
    if not node.flag("ccw", True):
        at = at.reshape(-1, 3)[:, ::-1].reshape(-1)
    normals = creased_normals(points, at, node.number("creaseAngle", 0.0))
    colours = _grid_colours(node, at, columns * rows)
    return assembled(Corners(points, at, normals, colours, two_sided=not node.flag("solid", True)))


def _along(node: Node, name: str, size: int, default: tuple[float, ...], count: int) -> Floats:
    """One vector for each point of the spine: one for all, or as many as there are (the last one holds on)."""
    given = node.vectors(name, size) if node.has(name) else np.array([default])
    given = given if len(given) else np.array([default])
    return given[np.minimum(np.arange(count), len(given) - 1)]


def _frames(spine: Floats) -> Floats:
    """The cross section's X, Y and Z axes at each point of the spine, as columns (n, 3, 3)."""
    closed = bool(np.allclose(spine[0], spine[-1]))
    before, after = np.roll(spine, 1, axis=0), np.roll(spine, -1, axis=0)
    if closed:
        before[0], after[-1] = spine[-2], spine[1]
    else:
        before[0], after[-1] = spine[0], spine[-1]
    y = _filled(after - before, np.array([0.0, 1.0, 0.0]))
    bend = np.cross(after - spine, before - spine)
    if not closed and len(spine) > 2:
        bend[0], bend[-1] = bend[1], bend[-2]
    if float(np.linalg.norm(bend, axis=1).max()) < 1e-9 * max(float(np.ptp(spine)) ** 2, 1e-30):
        start = quaternion.between([0.0, 1.0, 0.0], y[0])
        bend = np.tile(quaternion.rotate(start, [0.0, 0.0, 1.0]), (len(spine), 1))
    z = _filled(bend, np.array([0.0, 0.0, 1.0]))
    for i in range(1, len(z)):
        if z[i] @ z[i - 1] < 0.0:
            z[i] = -z[i]
    z = _filled(z - np.einsum("ni,ni->n", z, y)[:, None] * y, np.array([0.0, 0.0, 1.0]))
    return np.stack([np.cross(y, z), y, z], axis=2)


def _filled(vectors: Floats, default: Floats) -> Floats:
    """Unit vectors; where there is none, the one before it, or the first one after, or the default."""
    length = np.linalg.norm(vectors, axis=1)
    good = np.flatnonzero(length > 1e-12)
    if not len(good):
        return np.tile(default, (len(vectors), 1))
    nearest = good[np.maximum(np.searchsorted(good, np.arange(len(vectors)), side="right") - 1, 0)]
    unit: Floats = vectors[nearest] / length[nearest, None]
    return unit


def _swept(node: Node, points: Floats, section: Floats, rings: int) -> Ints:
    """Corners of the sides and of the caps."""
    size = len(section)
    ring = (np.arange(rings - 1)[:, None] * size + np.arange(size - 1)).reshape(-1)
    above = ring + size
    sides = np.stack([ring, ring + 1, above + 1, ring, above + 1, above], axis=1).reshape(-1)
    closed = bool(np.allclose(section[0], section[-1]))
    around = np.arange(size - 1 if closed else size)
    if len(around) < 3:
        return sides
    corners = [sides]
    lid = ears(points, around, np.array([0]), np.array([len(around)]))[0].reshape(-1)
    if node.flag("beginCap", True):
        corners.append(lid.reshape(-1, 3)[:, ::-1].reshape(-1))
    if node.flag("endCap", True):
        corners.append(lid + (rings - 1) * size)
    return np.concatenate(corners)


def _grid_colours(node: Node, at: Ints, count: int) -> tuple[Floats, Ints] | None:
    holder = node.node("color")
    if holder is None:
        return None
    size = 4 if holder.kind == "ColorRGBA" else 3
    colours = np.clip(holder.vectors("color", size), 0.0, 1.0)
    index = at if node.flag("colorPerVertex", True) else np.arange(len(at)) // 6
    if len(colours) <= int(index.max()) or len(colours) > count:
        return None
    return (colours if size == 4 else np.column_stack([colours, np.ones(len(colours))])), index
