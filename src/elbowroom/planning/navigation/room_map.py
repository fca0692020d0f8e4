"""The room that there is over the ground: how far away what stands is, below and above the height that one ducks to."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import kernel
from elbowroom.kept_arrays import Arrays, kept
from elbowroom.planning.navigation.girth import Girth
from elbowroom.planning.navigation.surfaces import Surfaces, one_plane, over_ground, to_edges
from elbowroom.world.ground.ground import EVEN_STAIR, STEP, Ground, tops_about
from elbowroom.world.ground.steepness import grades_about
from elbowroom.world.obstacles.clearance import lower_clearance
from elbowroom.world.obstacles.from_above import ball_radius, heights_of, place_of
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.rows import how_many, row_of
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

CELL = 0.06  # metres between points
FARTHEST = 0.6  # metres: more room is not told apart
_LOW = 0.03  # metres above a plane: what is lower is stood on
_LESS = 0.08  # of a step less than a slim body above what can be stepped onto: from there on things are in the way
_OVER = np.float32(0.06)  # metres by which a body may be over an edge: ankles stay on the ground
_IN_IT = 0.01  # metres: what is nearer than this to the middle of a place hangs over it
_MANY = 100  # obstacles: among fewer a map is made at once
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
    """Room at N places to stand, over the points of a grid over a part of the ground; what moves is not in it."""

    area: Rectangle
    surfaces: Surfaces
    room: Floats32  # (N,) metres to the nearest edge of the floor and to what stands, up to where one ducks
    above: Floats32  # (N,) metres to what stands above that, up to the top of the head
    steep: Floats32  # (N,) metres that the ground rises in a metre

    @property
    def cell(self) -> float:
        """Metres between points."""
        return self.surfaces.cell

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of the grid, along z and along x."""
        return (len(self.surfaces.starts) - 1) // self.surfaces.columns, self.surfaces.columns

    def in_grid(self, x: float, z: float) -> tuple[float, float]:
        """Row and column of a place, and shares of them; those of the border from outside."""
        rows, columns = self.shape
        row, column = (z - self.area.low_z) / self.cell, (x - self.area.low_x) / self.cell
        return min(max(row, 0.0), rows - 1.0), min(max(column, 0.0), columns - 1.0)

    def next_to(self, x: float, z: float, height: float) -> int | None:
        """The place to stand over the point next to a place that is nearest to a height; None where there is none."""
        first, last = self._over(x, z)
        if first == last:
            return None
        return first + int(np.argmin(np.abs(self.surfaces.heights[first:last] - height)))

    def heights_at(self, x: float, z: float) -> list[float]:
        """The heights of the floors over the point next to a place, from the lowest up, metres."""
        first, last = self._over(x, z)
        heights: list[float] = self.surfaces.heights[first:last].tolist()
        return heights

    def _over(self, x: float, z: float) -> tuple[int, int]:
        """The first place over the point next to a place, and the one after the last."""
        row, column = (round(each) for each in self.in_grid(x, z))
        first, last = self.surfaces.starts[row * self.surfaces.columns + column :][:2].tolist()
        return int(first), int(last)

    @property
    def places(self) -> Floats:
        """The places (N, 3): x, height, z."""
        rows, columns = np.divmod(self.surfaces.points, self.surfaces.columns)
        x, z = self.area.low_x + self.cell * columns, self.area.low_z + self.cell * rows
        return np.stack([x, self.surfaces.heights, z], axis=1)

    def lengths(self, nodes: NDArray[np.int64]) -> Floats:
        """Metres over the ground (N - 1,) from each of some places (N,) to the next."""
        rows, columns = np.divmod(self.surfaces.points[nodes], self.surfaces.columns)
        apart: Floats = self.cell * np.hypot(np.diff(rows), np.diff(columns))
        return apart

    def place(self, n: int) -> tuple[float, float, float]:
        """One of the places: x, height, z."""
        row, column = divmod(int(self.surfaces.points[n]), self.surfaces.columns)
        height = float(self.surfaces.heights[n])
        return self.area.low_x + self.cell * column, height, self.area.low_z + self.cell * row


def room_map(scene: Scene, girth: Girth, area: Rectangle) -> RoomMap:
    """The room over a part of a scene's ground for somebody; kept on disk where much stands there."""
    standing, ground = scene.obstacles.standing, scene.ground
    if len(standing.rows) < _MANY:
        return _made(scene, girth, area)
    floor = () if scene.place is None or scene.place.floor is None else (scene.place.floor.there,)
    about = np.array(
        [*girth, *area, *scene.ground_center, *scene.ground_size, ground.cell, *ground.corner, ground.step]
    )
    whole = (about, *standing, ground.starts, ground.members, ground.triangles, ground.level, *floor)
    found = kept(__file__, whole, lambda: _written(_made(scene, girth, area)))
    columns, cell, step = found["grid"].tolist()
    surfaces = Surfaces(int(columns), cell, step, found["starts"], found["points"], found["heights"])
    return RoomMap(area, surfaces, found["room"], found["above"], found["steep"])


def _written(room: RoomMap) -> Arrays:
    on = room.surfaces
    grid = np.array([on.columns, on.cell, on.step])
    arrays = {"grid": grid, "starts": on.starts, "points": on.points, "heights": on.heights}
    return arrays | {"room": room.room, "above": room.above, "steep": room.steep}


def _made(scene: Scene, girth: Girth, area: Rectangle) -> RoomMap:
    wide, deep = area.high_x - area.low_x, area.high_z - area.low_z
    cell = max(CELL, float(np.sqrt(wide * deep / _MOST_POINTS)))
    shape, corner = (int(deep / cell) + 1, int(wide / cell) + 1), (area.low_x, area.low_z)
    plain = scene.ground.plain
    surfaces = one_plane(shape, cell) if plain else over_ground(scene.ground, corner, shape, cell, girth.stooped)
    low = _LOW if plain else scene.ground.step + girth.slim - _LESS * scene.ground.step
    rises, steep = _climbs(scene.ground, surfaces, corner, girth.slim)
    near = scene.obstacles.near(np.array(area[:2]) - FARTHEST, np.array(area[2:]) + FARTHEST)
    climbed = steep > EVEN_STAIR
    ducked, top = (
        np.where(climbed, girth.bowed, girth.stooped),
        np.full(len(steep), max(girth.stooped - girth.slim, low)),
    )
    below, above, over = (np.full(len(steep), FARTHEST, np.float32) for _ in range(3))
    _lower(near, surfaces, corner, (np.minimum(low + rises, top), top), below)
    _lower(near, surfaces, corner, (ducked, np.full_like(ducked, girth.tall)), above)
    if climbed.any():
        _lower(near, surfaces, corner, (np.where(climbed, top, np.inf), ducked), over)
        below[over < _IN_IT] = 0.0
    edges = _to_edge(scene, area, shape, cell) if plain else to_edges(surfaces, FARTHEST)
    room = below if edges is None else np.minimum(below, edges + _OVER)
    return RoomMap(area, surfaces, room, above, steep)


def _climbs(ground: Ground, surfaces: Surfaces, corner: tuple[float, float], radius: float) -> tuple[Floats, Floats32]:
    """How far the treads about each place (N,) rise above a step from it, and how steep it is there (N,).

    What is stood on is not in the way. Where ground rises by no more than one step, as one walks, it is no stair, and
    not steep.
    """
    if ground.plain:
        return np.zeros(len(surfaces.points)), np.zeros(len(surfaces.points), np.float32)
    rows, columns = np.divmod(surfaces.points, surfaces.columns)
    places = np.stack([corner[0] + surfaces.cell * columns, corner[1] + surfaces.cell * rows], axis=1)
    tops = tops_about(ground, surfaces.heights, places, radius)
    rises: Floats = np.maximum(tops - surfaces.heights - ground.step, 0.0)
    steep = grades_about(ground, surfaces.heights, places, radius)
    steeper = np.flatnonzero(steep > EVEN_STAIR)
    heights = surfaces.heights[steeper]
    one_step = tops_about(ground, heights, places[steeper], 2.0 * radius) - heights <= min(ground.step, STEP)
    steep[steeper[one_step]] = EVEN_STAIR
    return rises, steep.astype(np.float32)


@kernel
def _lower(
    near: Nearby, surfaces: Surfaces, corner: tuple[float, float], span: tuple[Floats, Floats], out: Floats32
) -> None:
    """Lower `out` (N,) to the distance of upright lines over the places, from one height (N,) to another, from things.

    The places around one thing are one batch of the clearance kernel.
    """
    columns, cell = surfaces.columns, surfaces.cell
    rows, thin = (surfaces.starts.shape[0] - 1) // columns, np.zeros(1, np.float32)
    for b in range(how_many(near)):
        x, z = place_of(near, b)
        bottom, top = heights_of(near, b)
        reach = (ball_radius(near, b) + FARTHEST) / cell + 1.0
        i, j = (z - corner[1]) / cell, (x - corner[0]) / cell
        first_i, last_i = max(0, int(i - reach)), min(rows, int(i + reach) + 1)
        first_j, last_j = max(0, int(j - reach)), min(columns, int(j + reach) + 1)
        if last_i <= first_i or last_j <= first_j:
            continue
        most = 0
        for i in range(first_i, last_i):
            most += surfaces.starts[i * columns + last_j] - surfaces.starts[i * columns + first_j]
        segments, owners, count = np.empty((1, 6, most), np.float32), np.empty(most, np.int64), 0
        for i in range(first_i, last_i):
            for n in range(surfaces.starts[i * columns + first_j], surfaces.starts[i * columns + last_j]):
                height = surfaces.heights[n]
                low, high = height + span[0][n], height + span[1][n]
                if low > top + FARTHEST or high < bottom - FARTHEST:
                    continue
                segments[0, 0, count] = segments[0, 3, count] = corner[0] + cell * (surfaces.points[n] % columns)
                segments[0, 1, count], segments[0, 4, count] = low, high
                segments[0, 2, count] = segments[0, 5, count] = corner[1] + cell * i
                owners[count] = n
                count += 1
        if count > 0:
            least = out[owners[:count]]
            lower_clearance(np.ascontiguousarray(segments[:, :, :count]), thin, row_of(near, b), least)
            for k in range(count):
                out[owners[k]] = least[k]


def _to_edge(scene: Scene, area: Rectangle, shape: tuple[int, int], cell: float) -> Floats32 | None:
    """How far the places (N,) of a plane are from the edge of its floor; None where it has none."""
    from scipy import ndimage  # slow to import, and not needed on a plain

    floor = None if scene.place is None else scene.place.floor
    if floor is None:
        return None
    rows, columns = (np.arange(float(size)) for size in shape)
    there = floor.holds(*np.broadcast_arrays(area.low_x + cell * columns, area.low_z + cell * rows[:, None]))
    if there.all():
        return None
    left: Floats32 = (cell * ndimage.distance_transform_edt(there)).astype(np.float32).reshape(-1)
    return left
