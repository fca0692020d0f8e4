"""The shapes that obstacles have, each about its own origin and along its own axes. Metres."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.obstacles.layout import Kind

Floats = NDArray[np.float64]
Vector = tuple[float, float, float]

_MIDDLE = np.zeros(3)


@dataclass(frozen=True)
class Box:
    """A box."""

    size: Vector  # full lengths along X, Y, Z

    kind = Kind.BOX
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

    kind = Kind.ROUNDED
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

    kind = Kind.ROUNDED
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

    kind = Kind.CYLINDER
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

    kind = Kind.HULL
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


Shape = Box | Sphere | Capsule | Cylinder | Hull


def extents_of(shape: Shape) -> Floats:
    """Half lengths (3,) of a box about the shape's origin, along its axes, that holds it."""
    extents: Floats = np.abs(shape.middle) + shape.half + shape.rounding
    return extents
