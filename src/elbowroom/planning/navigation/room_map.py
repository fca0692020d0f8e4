"""The room that there is over the ground: how far away what stands is, below and above the height that one ducks to."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.navigation.girth import Girth
from elbowroom.world.scene import Scene
from elbowroom.world.walkable import Stance, walkable_window

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

CELL = 0.06  # metres between points
FARTHEST = 0.6  # metres: more room is not told apart
_LOW = 0.03  # metres above the ground: what is lower is stood on
_MOST_POINTS = 2_000_000  # of a map: where it needs more its points lie farther apart


class Rectangle(NamedTuple):
    """A part of the ground, metres."""

    low_x: float
    low_z: float
    high_x: float
    high_z: float

    def holds(self, other: "Rectangle") -> bool:
        """Whether the other lies within."""
        low = self.low_x <= other.low_x and self.low_z <= other.low_z
        return low and self.high_x >= other.high_x and self.high_z >= other.high_z

    def around(self, margin: float, within: "Rectangle") -> "Rectangle":
        """So much larger to all sides, as far as another goes."""
        return Rectangle(
            max(self.low_x - margin, within.low_x),
            max(self.low_z - margin, within.low_z),
            min(self.high_x + margin, within.high_x),
            min(self.high_z + margin, within.high_z),
        )


def ground_of(scene: Scene) -> Rectangle:
    """The ground of a scene."""
    (x, z), (wide, deep) = scene.ground_center, scene.ground_size
    return Rectangle(x - 0.5 * wide, z - 0.5 * deep, x + 0.5 * wide, z + 0.5 * deep)


@dataclass(frozen=True, eq=False)
class RoomMap:
    """Room at the points of a grid over a part of the ground; what moves is not in it."""

    area: Rectangle
    cell: float  # metres between points
    room: Floats32  # (nz, nx) metres to the nearest edge of the floor and to what stands, up to where one ducks
    above: Floats32  # (nz, nx) metres to what stands above that, up to the top of the head

    def points(self, places: Floats) -> NDArray[np.int64]:
        """The points (..., 2), row and column, next to places (..., 2), x and z; those of the border from outside."""
        own = np.rint((places[..., ::-1] - (self.area.low_z, self.area.low_x)) / self.cell).astype(np.int64)
        return np.clip(own, 0, np.array(self.room.shape) - 1)

    def places(self, points: NDArray[np.int64]) -> Floats:
        """The places (..., 2), x and z, of points (..., 2), row and column."""
        found: Floats = np.array([self.area.low_x, self.area.low_z]) + self.cell * points[..., ::-1]
        return found


def room_map(scene: Scene, girth: Girth, area: Rectangle) -> RoomMap:
    """The room over a part of a scene's ground for somebody."""
    wide, deep = area.high_x - area.low_x, area.high_z - area.low_z
    cell = max(CELL, float(np.sqrt(wide * deep / _MOST_POINTS)))
    shape, origin = (int(deep / cell) + 1, int(wide / cell) + 1), (area.low_x, area.low_z)
    near = scene.obstacles.near(np.array(area[:2]) - FARTHEST, np.array(area[2:]) + FARTHEST)
    below, above = (
        walkable_window(near, Stance(0.0, low, high), origin, 0.0, shape, cell, FARTHEST).clearance
        for low, high in ((_LOW, girth.stooped - girth.slim), (girth.stooped, girth.tall))
    )
    return RoomMap(area, cell, _within_floor(below, scene, area, cell), above)


def _within_floor(room: Floats32, scene: Scene, area: Rectangle, cell: float) -> Floats32:
    """The room (nz, nx) where a floor ends is no more than what is left to its edge."""
    from scipy import ndimage  # slow to import, and not needed on a plain

    floor = None if scene.place is None else scene.place.floor
    if floor is None:
        return room
    rows, columns = (np.arange(float(size)) for size in room.shape)
    there = floor.holds(*np.broadcast_arrays(area.low_x + cell * columns, area.low_z + cell * rows[:, None]))
    if there.all():
        return room
    left = cell * ndimage.distance_transform_edt(there)
    within: Floats32 = np.minimum(room, left.astype(np.float32))
    return within
