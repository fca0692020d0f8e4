"""Box, Sphere, Cylinder and Cone as triangles (ISO/IEC 19775-1, 13.3: centred, axis along Y)."""

from dataclasses import replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.x3d.mesh import Corners, Mesh, assembled, creased_normals
from elbowroom.formats.x3d.model import Node

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_AROUND = 24  # corners of a circle
_UP = 12  # rings of a sphere
_CREASE = 0.7  # radians: smooth round the circle, sharp at the rims
_BOX = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def box(node: Node) -> Mesh:
    """A Box."""
    size = _positive(node, node.vector("size", (2.0, 2.0, 2.0)), "size")
    signs = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    quads = np.array(_BOX)
    return Mesh(signs * size, quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3), np.arange(8))


def sphere(node: Node) -> Mesh:
    """A Sphere."""
    radius = _positive(node, node.vector("radius", (1.0,)), "radius")[0]
    return _stretched(_unit_sphere(), np.full(3, radius))


def cylinder(node: Node) -> Mesh | None:
    """A Cylinder; None if all its parts are switched off."""
    radius = _positive(node, node.vector("radius", (1.0,)), "radius")[0]
    height = _positive(node, node.vector("height", (2.0,)), "height")[0]
    parts = tuple(part for part in ("side", "top", "bottom") if node.flag(part, True))
    return _stretched(_unit_tapered(1.0, parts), np.array([radius, height, radius])) if parts else None


def cone(node: Node) -> Mesh | None:
    """A Cone; None if both its parts are switched off."""
    radius = _positive(node, node.vector("bottomRadius", (1.0,)), "bottomRadius")[0]
    height = _positive(node, node.vector("height", (2.0,)), "height")[0]
    parts = tuple(part for part in ("side", "bottom") if node.flag(part, True))
    return _stretched(_unit_tapered(0.0, parts), np.array([radius, height, radius])) if parts else None


@cache
def _unit_sphere() -> Mesh:
    angles = np.linspace(0.5 * np.pi, -0.5 * np.pi, _UP + 1)
    rings = [_ring(np.cos(angle), np.sin(angle)) for angle in angles]
    return _mesh(np.concatenate(rings), np.concatenate([_band(i) for i in range(_UP)]), np.pi)


@cache
def _unit_tapered(top: float, parts: tuple[str, ...]) -> Mesh:
    """Parts of a cylinder or cone of radius 1 below, radius `top` above, and height 1."""
    faces = {"side": _band(0), "top": _lid(0)[::-1], "bottom": _lid(_AROUND)}
    points = np.concatenate([_ring(top, 0.5), _ring(1.0, -0.5)])
    return _mesh(points, np.concatenate([faces[part] for part in parts]), _CREASE)


def _stretched(mesh: Mesh, scale: Floats) -> Mesh:
    """The mesh scaled along the axes; normals turn the other way."""
    if mesh.normals is None:
        return replace(mesh, points=mesh.points * scale)
    with np.errstate(all="ignore"):  # a scale may be next to nothing
        normals = mesh.normals / scale
        unit = normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    return replace(mesh, points=mesh.points * scale, normals=unit)


def _ring(radius: float, y: float) -> Floats:
    angle = 2.0 * np.pi * np.arange(_AROUND) / _AROUND
    return np.column_stack([radius * np.sin(angle), np.full(_AROUND, y), radius * np.cos(angle)])


def _band(ring: int) -> Ints:
    """Corners of the triangles between a ring and the next one below."""
    a = ring * _AROUND + np.arange(_AROUND)
    b = ring * _AROUND + (np.arange(_AROUND) + 1) % _AROUND
    return np.stack([a, a + _AROUND, b + _AROUND, a, b + _AROUND, b], axis=1).reshape(-1)


def _lid(first: int) -> Ints:
    """Corners of the triangles of a disc that faces down."""
    step = np.arange(1, _AROUND - 1)
    return np.stack([np.full(len(step), first), first + step + 1, first + step], axis=1).reshape(-1)


def _mesh(points: Floats, at: Ints, crease: float) -> Mesh:
    triangle = points[at].reshape(-1, 3, 3)
    area = np.linalg.norm(np.cross(triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0]), axis=1)
    at = at.reshape(-1, 3)[area > 1e-9 * max(float(area.max(initial=0.0)), 1e-30)].reshape(-1)
    return assembled(Corners(points, at, creased_normals(points, at, crease)))


def _positive(node: Node, values: Floats, name: str) -> Floats:
    if values.min() <= 0.0:
        raise node.wrong(name, "positive")
    return values
