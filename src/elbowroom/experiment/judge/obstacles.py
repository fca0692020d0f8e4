"""A scene's obstacles as another library knows them, and in which oriented box each of them lies."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.experiment.judge.pieces import MeshPiece, pieces_of
from elbowroom.experiment.judge.poses import Posed
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.meshes.hulls import surface_of
from elbowroom.world.obstacles.meshes.parts import above_ground
from elbowroom.world.obstacles.shapes import Box, Capsule, Cylinder, Hull, Mesh, Shape, Sphere
from elbowroom.world.obstacles.tracks.moving import Track
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]


def distance_between(low: Floats, high: Floats, centers: Floats, halves: Floats) -> Floats:
    """Distance (...) of boxes with corners `low`, `high` (..., 3) from others along the same axes, metres."""
    gap = np.maximum(np.maximum(low - centers, centers - high) - halves, 0.0)
    distance: Floats = np.sqrt(np.einsum("...i,...i->...", gap, gap))
    return distance


@dataclass(frozen=True, eq=False)
class Obstacle:
    """An obstacle, or a piece of a mesh: the library's shape and place, and a box round it for finding what is near."""

    name: str
    made_of: Any  # coal.CollisionGeometry, or the piece
    place: Any  # coal.Transform3s
    center: Floats  # (3,) of the box round it, in the world
    to_box: Floats  # (3, 3) world to box axes
    half_size: Floats  # (3,)

    @cached_property
    def shape(self) -> Any:
        """The library's shape; that of a piece is made when it is first asked for: most are never near."""
        return _library_mesh(self.made_of.mesh) if isinstance(self.made_of, MeshPiece) else self.made_of

    @cached_property
    def triangles(self) -> Floats:
        """Corners (T, 3, 3) in the world of a piece of a mesh."""
        corners: Floats = self.made_of.mesh.corners @ self.place.getRotation().T + self.place.getTranslation()
        return corners

    @property
    def reach(self) -> Floats:
        """Half lengths (3,) along the world's axes of the box along these that it lies in, metres."""
        reach: Floats = np.abs(self.to_box.T) @ self.half_size
        return reach

    def box_distance(self, low: Floats, high: Floats) -> Floats:
        """Distance (...) from the box round the obstacle to boxes along its axes with corners `low`, `high` (..., 3).

        Corners are in the box's frame. Whatever lies between them is at least so far from the obstacle.
        """
        return distance_between(low, high, np.zeros(3), self.half_size)

    def world_distance(self, low: Floats, high: Floats) -> Floats:
        """The same of boxes along the world's axes with corners `low`, `high` (..., 3) in the world; quick and wide."""
        return distance_between(low, high, self.center, self.reach)

    def seen_from(self, points: Floats) -> Floats:
        """World points (..., 3) in the frame of the box round the obstacle."""
        seen: Floats = (points - self.center) @ self.to_box.T
        return seen


def coal_library() -> Any:
    """The collision library; raises `InputError` where it is not installed."""
    try:
        import coal
    except ImportError:
        raise InputError("the judge needs the collision library coal: pip install 'elbowroom[judge]'") from None
    return coal


@dataclass(frozen=True, eq=False)
class Surroundings:
    """Obstacles that keep their places to each other, seen from where they are."""

    obstacles: tuple[Obstacle, ...]
    track: Track | None  # by which they move; None: they stand still

    def near(self, posed: Posed, times: Floats, within: float) -> slice:
        """The poses of N, from the first to the last, at which a joint may be nearer than so many metres."""
        if self.track is None or np.isinf(within):
            return slice(0, len(times))
        centers = self.track.poses(times)[0]
        between = posed.positions - centers[:, None]
        nearest = np.sqrt(np.einsum("nji,nji->nj", between, between).min(axis=1))
        around = max(float(np.linalg.norm(one.center) + np.linalg.norm(one.half_size)) for one in self.obstacles)
        rows = np.flatnonzero(nearest <= within + around)
        return slice(int(rows[0]), int(rows[-1]) + 1) if len(rows) else slice(0, 0)

    def seen(self, posed: Posed, times: Floats) -> Posed:
        """The joints of N poses at the scene's times (N,) as seen from the moving frame."""
        if self.track is None:
            return posed
        centers, yaws = self.track.poses(times)
        to_frame = np.swapaxes(quaternion.to_matrix(_about_y(yaws)), -1, -2)
        positions = np.einsum("nij,nkj->nki", to_frame, posed.positions - centers[:, None])
        return Posed(positions, np.einsum("nij,nkjl->nkil", to_frame, posed.rotations))


def obstacles_of(scene: Scene) -> tuple[Obstacle, ...]:
    """Every obstacle of a scene that stands still: of a mesh, what is above the ground, in pieces."""
    found, ground = list[Obstacle](), scene.obstacles.ground
    for name, shape, center, turn in scene.obstacles:
        standing = above_ground(shape, center, turn, ground) if isinstance(shape, Mesh) else shape
        if standing is not None:
            found += _obstacles(name, standing, center, quaternion.to_matrix(turn))
    return tuple(found)


def surroundings_of(scene: Scene) -> tuple[Surroundings, ...]:
    """Every obstacle of a scene: those that stand still together, each moving one by itself."""
    moving = [
        Surroundings(tuple(_obstacles(track.name, track.shape, np.zeros(3), np.eye(3))), track)
        for track in scene.obstacles.moving.tracks
    ]
    return (Surroundings(obstacles_of(scene), None), *moving)


def _obstacles(name: str, shape: Shape, origin: Floats, turn: Floats) -> Iterator[Obstacle]:
    """A shape about an origin (3,), turned by a matrix (3, 3); a mesh in its pieces, which all have its name."""
    if isinstance(shape, Mesh):
        place = coal_library().Transform3s(turn, origin)
        for piece in pieces_of(shape):
            center, to_box = origin + turn @ piece.middle, piece.to_box @ turn.T
            yield Obstacle(name, piece, place, center, to_box, piece.half_size)
        return
    made, to_made = _library_shape(shape)
    place, center = coal_library().Transform3s(turn @ to_made, origin), origin + turn @ shape.middle
    yield Obstacle(name, made, place, center, turn.T, shape.half + shape.rounding)


def _library_shape(shape: Box | Sphere | Capsule | Cylinder | Hull) -> tuple[Any, Floats]:
    """The library's own shape, and how it is turned in ours: its capsules and cylinders lie along Z."""
    coal, along_y = coal_library(), np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    match shape:
        case Box(size):
            return coal.Box(*size), np.eye(3)
        case Sphere(radius):
            return coal.Sphere(radius), np.eye(3)
        case Capsule(radius, length):
            return coal.Capsule(radius, length), along_y
        case Cylinder(radius, height):
            return coal.Cylinder(radius, height), along_y
        case Hull():
            return _library_hull(shape), np.eye(3)


def _library_hull(hull: Hull) -> Any:
    """A hull by its corners and triangles, as the library wants it."""
    return coal_library().Convex(*_library_triangles(*surface_of(hull)))


def _library_mesh(mesh: Mesh) -> Any:
    """A mesh as a tree of boxes round its triangles."""
    made = coal_library().BVHModelOBBRSS()
    made.beginModel(len(mesh.faces), len(mesh.vertices))
    made.addSubModel(*_library_triangles(mesh.vertices, mesh.faces))
    made.endModel()
    return made


def _library_triangles(corners: Floats, triangles: Longs) -> tuple[Any, Any]:
    coal = coal_library()
    points, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for corner in corners:
        points.append(corner)
    for a, b, c in triangles.tolist():
        faces.append(coal.Triangle(a, b, c))
    return points, faces


def _about_y(yaws: Floats) -> Floats:
    zero = np.zeros_like(yaws)
    return np.stack([zero, np.sin(0.5 * yaws), zero, np.cos(0.5 * yaws)], axis=-1)
