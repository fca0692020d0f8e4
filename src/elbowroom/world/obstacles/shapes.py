"""The shapes that obstacles have, each about its own origin and along its own axes. Metres."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.world.obstacles.layout import ShapeKind

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]
Vector = tuple[float, float, float]

_MIDDLE = np.zeros(3)


@dataclass(frozen=True)
class Box:
    """A box."""

    size: Vector  # full lengths along X, Y, Z

    kind = ShapeKind.BOX
    rounding = 0.0
    middle = _MIDDLE

    @property
    def half(self) -> Floats:
        """Half lengths (3,) of the box that the kernels know it by; `rounding` is to every side of it."""
        return 0.5 * np.array(self.size)


@dataclass(frozen=True)
class Sphere:
    """A ball."""

    radius: float

    kind = ShapeKind.ROUNDED
    middle = _MIDDLE

    @property
    def half(self) -> Floats:
        """As in `Box`: a point."""
        return np.zeros(3)

    @property
    def rounding(self) -> float:
        """Its radius."""
        return self.radius


@dataclass(frozen=True)
class Capsule:
    """All that is near to a line along Y."""

    radius: float
    length: float  # of the line, between the middles of the round ends

    kind = ShapeKind.ROUNDED
    middle = _MIDDLE

    @property
    def half(self) -> Floats:
        """As in `Box`: the line."""
        return np.array([0.0, 0.5 * self.length, 0.0])

    @property
    def rounding(self) -> float:
        """Its radius."""
        return self.radius


@dataclass(frozen=True)
class Cylinder:
    """A cylinder about Y."""

    radius: float
    height: float

    kind = ShapeKind.CYLINDER
    rounding = 0.0
    middle = _MIDDLE

    @property
    def half(self) -> Floats:
        """As in `Box`: the box round it."""
        return np.array([self.radius, 0.5 * self.height, self.radius])


@dataclass(frozen=True)
class Hull:
    """The convex hull of some points; they must not lie in a plane (`hulls.surface_of` tells)."""

    points: tuple[Vector, ...]

    kind = ShapeKind.HULL
    rounding = 0.0

    @cached_property
    def array(self) -> Floats:
        """The points (P, 3)."""
        return np.array(self.points)

    @property
    def half(self) -> Floats:
        """As in `Box`: the box round it, about `middle`."""
        half: Floats = 0.5 * np.ptp(self.array, axis=0)
        return half

    @property
    def middle(self) -> Floats:
        """The middle (3,) of the box round it."""
        middle: Floats = 0.5 * (self.array.min(axis=0) + self.array.max(axis=0))
        return middle


@dataclass(frozen=True, eq=False)
class Mesh:
    """Triangles, closed or not: their surface from both sides, and what lies within it where it is closed.

    Raises `InputError` where corners are no numbers, or a triangle names a corner that is not there.
    """

    vertices: Floats  # (V, 3) corners
    faces: Longs  # (F, 3) of each triangle the numbers of its corners; counter-clockwise seen from outside if closed

    kind = ShapeKind.MESH
    rounding = 0.0

    def __post_init__(self) -> None:
        vertices = np.array(self.vertices, np.float64).reshape(-1, 3)
        faces = np.array(self.faces, np.int64).reshape(-1, 3)
        if not len(faces):
            raise InputError("a mesh has no triangles; it needs one at least")
        if not np.isfinite(vertices).all():
            raise InputError("a mesh has a corner that is not a finite number")
        if faces.min() < 0 or faces.max() >= len(vertices):
            raise InputError(f"a mesh's triangle names a corner that is not there; there are {len(vertices)}")
        vertices.flags.writeable = faces.flags.writeable = False
        object.__setattr__(self, "vertices", vertices)
        object.__setattr__(self, "faces", faces)

    @cached_property
    def corners(self) -> Floats:
        """The corners (F, 3, 3) of its triangles."""
        corners: Floats = self.vertices[self.faces]
        return corners

    @cached_property
    def half(self) -> Floats:
        """As in `Box`: the box round it, about `middle`."""
        half: Floats = 0.5 * (self.corners.max(axis=(0, 1)) - self.corners.min(axis=(0, 1)))
        return half

    @cached_property
    def middle(self) -> Floats:
        """The middle (3,) of the box round it."""
        middle: Floats = 0.5 * (self.corners.max(axis=(0, 1)) + self.corners.min(axis=(0, 1)))
        return middle


Shape = Box | Sphere | Capsule | Cylinder | Hull | Mesh


def extents_of(shape: Shape) -> Floats:
    """Half lengths (3,) of a box about the shape's origin, along its axes, that holds it."""
    extents: Floats = np.abs(shape.middle) + shape.half + shape.rounding
    return extents
