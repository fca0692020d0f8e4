"""`Obstacles`: all that stands or moves in the way, and whatever anybody may ask about it."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.around_body import Standing
from elbowroom.world.obstacles.broad_phase import Grids, grids_of, meeting
from elbowroom.world.obstacles.clearance import (
    clearance,
    clearance_from_each,
    clearance_of,
    pairwise_clearance,
)
from elbowroom.world.obstacles.closest_points import closest_points
from elbowroom.world.obstacles.free_map import FreeMap
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.lent_map import LentMap
from elbowroom.world.obstacles.meshes.kept_parts import kept_parts
from elbowroom.world.obstacles.meshes.packed import Packed, pack
from elbowroom.world.obstacles.meshes.parts import ObstacleParts
from elbowroom.world.obstacles.rows import about, bounds_of, corners_of, joined, one_of, rows_of
from elbowroom.world.obstacles.shapes import Box, Hull, Mesh, Shape, extents_of
from elbowroom.world.obstacles.tracks.along import Along, Place, along
from elbowroom.world.obstacles.tracks.moving import Moving

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

Span = tuple[float, float]  # the least and the greatest of some heights, metres

EVERY_HEIGHT: Span = (-np.inf, np.inf)
_NEAR, _WIDER, _FAR = 2.0, 4.0, 1e6  # metres: where the nearest is looked for first, how many times farther, at most
_NEARER, _MANY = 0.5, 500  # metres: and where there are so many


@dataclass(frozen=True, eq=False)
class Obstacles:
    """Obstacles that stand, N of them, and those that move; they never change.

    Where they are told by number, those that stand come first. A mesh that stands has a number for each of its pieces,
    so these may be more: B.
    """

    shapes: tuple[Shape, ...] = ()
    centers: Floats = field(default_factory=lambda: np.empty((0, 3)))  # (N, 3) of the shapes' origins, metres
    rotations: Floats = field(default_factory=lambda: np.empty((0, 4)))  # (N, 4) shape-to-world quaternions, xyzw
    standing_names: tuple[str, ...] = ()
    moving: Moving = field(default_factory=Moving)
    # Metres, how high the level ground is: triangles that do not rise from it are not in the way; all are at -inf.
    ground: float = 0.0

    @classmethod
    def boxes(
        cls, centers: ArrayLike, rotations: ArrayLike, half_sizes: ArrayLike, names: Sequence[str] | None = None
    ) -> "Obstacles":
        """Oriented boxes: centres (B, 3), quaternions (B, 4), half lengths (B, 3)."""
        sizes = 2.0 * np.asarray(half_sizes, np.float64).reshape(-1, 3)
        shapes = tuple(Box((float(x), float(y), float(z))) for x, y, z in sizes)
        called = tuple(names) if names is not None else tuple(f"box {i + 1}" for i in range(len(shapes)))
        places = np.asarray(centers, np.float64).reshape(-1, 3)
        return cls(shapes, places, np.asarray(rotations, np.float64).reshape(-1, 4), called)

    def __len__(self) -> int:
        return len(self.shapes) + len(self.moving)

    def __iter__(self) -> Iterator[tuple[str, Shape, Floats, Floats]]:
        """Name, shape, centre and rotation of each that stands."""
        return zip(self.standing_names, self.shapes, self.centers, self.rotations, strict=True)

    @cached_property
    def names(self) -> tuple[str, ...]:
        """What they are called, by number."""
        return tuple(self.standing_names[owner] for owner in self._parts.owners.tolist()) + self.moving.names

    @property
    def half_sizes(self) -> Floats:
        """Half lengths (N, 3) of boxes about the origins of those that stand, along their axes, that hold them."""
        halves: Floats = np.array([extents_of(shape) for shape in self.shapes]).reshape(-1, 3)
        return halves

    @cached_property
    def standing(self) -> Nearby:
        """Those that stand."""
        return rows_of(self._parts.shapes, self._parts.centers, self._parts.rotations, self._packed)

    @cached_property
    def _parts(self) -> ObstacleParts:
        return kept_parts(self.shapes, self.centers, self.rotations, self.ground)

    @cached_property
    def _packed(self) -> Packed:
        return pack((*self._parts.shapes, *(track.shape for track in self.moving.tracks)))

    @cached_property
    def _movers(self) -> Nearby:
        return self.moving.about_origin(self._packed)

    @cached_property
    def _grids(self) -> Grids:
        least, most = bounds_of(self.standing)
        return grids_of(least[:, [0, 2]], most[:, [0, 2]])

    @cached_property
    def _heights(self) -> Floats:
        """The lowest and the highest point (B, 2) of boxes round those that stand."""
        least, most = bounds_of(self.standing)
        return np.stack([least[:, 1], most[:, 1]], axis=1)

    @cached_property
    def about_bodies(self) -> Standing:
        """Those that stand, for kernels that ask how far the capsules of a body are from them."""
        return Standing(self.standing, self._grids, np.ascontiguousarray(self._heights))

    @cached_property
    def corners(self) -> Floats:
        """The corners (B, 8, 3) of boxes round those that stand."""
        return corners_of(self.standing)

    @property
    def outlines(self) -> Iterator[tuple[str, Floats]]:
        """The name of each of those that stand, and points (P, 3) in the convex hull of which it lies.

        These are the corners of a hull, of a piece of a mesh, or of a box.
        """
        parts = self._parts
        for i, (shape, center, turn) in enumerate(zip(parts.shapes, parts.centers, parts.rotations, strict=True)):
            points = shape.array if isinstance(shape, Hull) else shape.vertices if isinstance(shape, Mesh) else None
            yield self.names[i], self.corners[i] if points is None else center + quaternion.rotate(turn, points)

    def numbers_near(
        self, least: Sequence[float] | Floats, most: Sequence[float] | Floats, heights: Span = EVERY_HEIGHT
    ) -> Longs:
        """The numbers, in order, of those that stand over a rectangle on the ground, or nearly: corners x and z.

        Those that reach into a span of heights.
        """
        return _numbers_near(self.about_bodies, least, most, heights)

    def near(
        self, least: Sequence[float] | Floats, most: Sequence[float] | Floats, heights: Span = EVERY_HEIGHT
    ) -> Nearby:
        """Those that stand over a rectangle on the ground, or nearly: corners x and z; those in a span of heights."""
        return _near(self.about_bodies, least, most, heights)

    def picked(self, numbers: Longs) -> Nearby:
        """Those that stand, by their numbers."""
        return _picked(self.standing, numbers)

    @property
    def free_map(self) -> FreeMap:
        """How far away those that stand are, over the plane: one map for all who walk here, while they hold it."""
        return self._lent_map.take()

    @cached_property
    def _lent_map(self) -> LentMap:
        return LentMap(partial(_near, self.about_bodies))  # which does not hold the obstacles that hold it

    def along(
        self,
        times: Floats,
        ground: tuple[Place, Place],
        others: Moving | None = None,
        heights: Span = EVERY_HEIGHT,
    ) -> Along:
        """What is in the way between `times` (n+1,) over a rectangle on the ground, `others` that move included.

        Of what stands, that which reaches into a span of heights.
        """
        moving = self.moving + others if others else self.moving
        numbers = self.numbers_near(*ground, heights)
        return along(self.picked(numbers), numbers, len(self.standing.rows), moving, times, ground)

    def at(self, time: float) -> Nearby:
        """All of them, as they stand at a time."""
        return joined(self.standing, self.moving.at(time, self._movers)) if len(self.moving) else self.standing

    def first_bounds(self) -> tuple[Floats, Floats]:
        """The least and the greatest corners (B, 3) of boxes along the world's axes that hold all of them at time 0.

        Found without a kernel: scenes are read before any is compiled.
        """
        centers, yaws = self.moving.poses(0.0)
        turns = quaternion.about_axis(1, yaws[0])
        moved = rows_of([track.shape for track in self.moving.tracks], centers[0], turns, self._packed)
        return bounds_of(joined(self.standing, moved))

    def clearance(
        self,
        segments: Floats32,
        radii: ArrayLike,
        origin: Sequence[float] | Floats,
        time: float,
        floor: float = -np.inf,
    ) -> float:
        """The least clearance, metres, of capsules (C, 6, N) about a place on the ground (x, z), at a time.

        The capsules' coordinates are relative to that place, so that single precision holds anywhere. What stands and
        does not rise above the height `floor` is left out. Infinite where there is nothing.
        """
        x, z = float(origin[0]), float(origin[1])
        found = np.inf
        if len(self.moving):
            found = _least(segments, radii, about(self.moving.at(time, self._movers), x, z))
        for reach, numbers in self._wider_and_wider(segments, radii, x, z, floor):
            if len(numbers):
                found = min(found, _least(segments, radii, about(self.picked(numbers), x, z)))
            if found <= reach:
                break
        return float(found)

    def nearest(
        self, segments: ArrayLike, radii: ArrayLike, origin: Sequence[float] | Floats, time: float
    ) -> "Nearest | None":
        """The closest pair of a capsule (C, 6), about a place as in `clearance`, and an obstacle; None without any."""
        axes = np.asarray(segments, np.float64)
        pair = self.nearest_pair(axes, radii, origin, time)
        if pair is None:
            return None
        on_axis, on_obstacle = closest_points(axes[pair.capsule], pair.there)
        shift = np.array([origin[0], 0.0, origin[1]], np.float64)
        return Nearest(pair.capsule, pair.obstacle, pair.distance, on_axis[0] + shift, on_obstacle[0] + shift)

    def nearest_pair(
        self, segments: ArrayLike, radii: ArrayLike, origin: Sequence[float] | Floats, time: float
    ) -> "Pair | None":
        """The same without its points: a tenth of the work."""
        x, z = float(origin[0]), float(origin[1])
        axes, best = np.asarray(segments, np.float64), None
        if len(self.moving):
            best = _nearest(axes, radii, about(self.moving.at(time, self._movers), x, z))
            best = best._replace(obstacle=best.obstacle + len(self.standing.rows))
        for reach, numbers in self._wider_and_wider(axes, radii, x, z):
            if len(numbers):
                found = _nearest(axes, radii, about(self.picked(numbers), x, z))
                if best is None or found.distance < best.distance:
                    best = found._replace(obstacle=int(numbers[found.obstacle]))
            if best is not None and best.distance <= reach:
                break
        return best

    def _wider_and_wider(
        self, segments: ArrayLike, radii: ArrayLike, x: float, z: float, floor: float = -np.inf
    ) -> Iterator[tuple[float, Longs]]:
        """The numbers of those that stand within so many metres of capsules (C, 6, ...), and at last all.

        Those that rise above a floor.
        """
        many = len(self.standing.rows)
        if not many:
            return
        axes = np.asarray(segments, np.float64)
        ends = np.moveaxis(axes.reshape(len(axes), 2, 3, -1), 2, -1).reshape(-1, 3)
        widest = float(np.max(radii, initial=0.0))
        least, most = ends.min(axis=0) - widest, ends.max(axis=0) + widest
        reach = _NEAR if many < _MANY else _NEARER
        while reach < _FAR:
            low, high = (x + least[0] - reach, z + least[2] - reach), (x + most[0] + reach, z + most[2] + reach)
            numbers = self.numbers_near(low, high)
            lowest, highest = self._heights[numbers].T
            if len(numbers) == many:
                yield reach, numbers[highest > floor]
                return
            within = (lowest <= most[1] + reach) & (highest >= least[1] - reach)
            yield reach, numbers[within & (highest > floor)]
            reach *= _WIDER


class Pair(NamedTuple):
    """A capsule and the obstacle that is closest to it."""

    capsule: int
    obstacle: int
    distance: float  # metres; negative where they overlap
    there: Nearby  # the obstacle by itself, as seen from the place that was asked about


class Nearest(NamedTuple):
    """A capsule and the obstacle that is closest to it."""

    capsule: int
    obstacle: int
    distance: float  # metres; negative where they overlap
    on_axis: Floats  # (3,) the point of the capsule's axis
    on_obstacle: Floats  # (3,)


def _numbers_near(
    standing: Standing, least: Sequence[float] | Floats, most: Sequence[float] | Floats, heights: Span
) -> Longs:
    """As `Obstacles.numbers_near`."""
    numbers = meeting(standing.grids, (float(least[0]), float(least[1])), (float(most[0]), float(most[1])))
    if heights == EVERY_HEIGHT or not len(numbers):
        return numbers
    own = standing.heights[numbers]
    return numbers[(own[:, 0] <= heights[1]) & (own[:, 1] >= heights[0])]


def _picked(standing: Nearby, numbers: Longs) -> Nearby:
    """As `Obstacles.picked`."""
    if len(numbers) == len(standing.rows):
        return standing
    return Nearby(standing.rows[numbers], standing.packed)


def _near(standing: Standing, least: Sequence[float] | Floats, most: Sequence[float] | Floats, heights: Span) -> Nearby:
    """As `Obstacles.near`."""
    return _picked(standing.near, _numbers_near(standing, least, most, heights))


def _least(segments: Floats32, radii: ArrayLike, near: Nearby) -> float:
    """The least clearance of capsules (C, 6, N)."""
    if segments.shape[2] == 1:
        return clearance_of(segments[:, :, 0], radii, near)
    return float(clearance(segments, radii, near).min(initial=np.inf))


def _nearest(axes: Floats, radii: ArrayLike, near: Nearby) -> Pair:
    """The closest pair of capsules and obstacles, of each at least one."""
    obstacle = int(np.argmin(clearance_from_each(axes, radii, near)))
    there = one_of(near, obstacle)
    gaps = pairwise_clearance(axes[:, :, None], radii, there)[:, 0, 0]
    capsule = int(np.argmin(gaps))
    return Pair(capsule, obstacle, float(gaps[capsule]), there)
