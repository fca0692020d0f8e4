"""The surfaces of shapes as triangles: round ones by as many corners as the eye asks for."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.obstacles.meshes.hulls import surface_of
from elbowroom.world.obstacles.shapes import Box, Capsule, Cylinder, Hull, Mesh, Shape, Sphere

Floats = NDArray[np.float64]

_AROUND, _RINGS = 32, 8  # corners of a circle, rings of half a ball
_BOX = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def triangles_of(shape: Shape) -> Floats:
    """Corners (T, 3, 3) of a shape's surface about its own origin, counter-clockwise seen from outside, metres."""
    match shape:
        case Box(size):
            signs = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
            faces = np.array(_BOX)[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
            corners: Floats = (signs * size)[faces]
            return corners
        case Sphere(radius):
            return _turned(_half_ball(radius, 0.0))
        case Capsule(radius, length):
            return _turned(_half_ball(radius, 0.5 * length))
        case Cylinder(radius, height):
            half = 0.5 * height
            return _turned([(0.0, -half), (radius, -half), (radius, half), (0.0, half)])
        case Hull():
            points, triangles = surface_of(shape)
            corners = points[triangles]
            return corners
        case Mesh():
            return shape.corners


def _half_ball(radius: float, rise: float) -> list[tuple[float, float]]:
    """Outline (radius, height), from the lowest point up, of a ball whose halves are moved apart by `rise` each.

    Both halves have the whole radius where they begin, so that the surface is as wide as the shape.
    """
    upper = [
        (radius * np.cos(a), radius * np.sin(a) + rise) for a in np.linspace(0.0, 0.5 * np.pi, _RINGS + 1).tolist()
    ]
    return [*((wide, -height) for wide, height in reversed(upper)), *upper]


def _turned(outline: Sequence[tuple[float, float]]) -> Floats:
    """The surface that an outline sweeps about Y."""
    angles = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    rings = np.array([[[r * np.sin(a), y, r * np.cos(a)] for a in angles] for r, y in outline])
    beside = np.roll(rings, -1, axis=1)
    lower = np.stack([rings[:-1], beside[:-1], beside[1:]], axis=2)
    upper = np.stack([rings[:-1], beside[1:], rings[1:]], axis=2)
    triangles = np.concatenate([lower.reshape(-1, 3, 3), upper.reshape(-1, 3, 3)])
    return triangles[areas_of(triangles) > 1e-12]


def areas_of(triangles: Floats) -> Floats:
    """Twice the areas (T,) of triangles (T, 3, 3)."""
    across: Floats = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    areas: Floats = np.linalg.norm(across, axis=1)
    return areas
