"""Obstacles of every shape, for tests."""

from collections.abc import Callable

import numpy as np

from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.layout import Nearby, Spans
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Box, Capsule, Cylinder, Hull, Mesh, Shape, Sphere

Rng = np.random.Generator


def _number(rng: Rng, low: float, high: float) -> float:
    return float(rng.uniform(low, high))


def random_hull(rng: Rng, points: int, size: float = 0.3) -> Hull:
    """Points in a ball, not round the origin."""
    rows = rng.normal(size=(points, 3)) * size / 2.0 + rng.uniform(-size, size, 3) / 2.0
    return Hull(tuple((x, y, z) for x, y, z in rows.tolist()))


def box_hull(half: tuple[float, float, float]) -> Hull:
    """The corners of a box: its faces are squares."""
    a, b, c = half
    return Hull(tuple((x, y, z) for x in (-a, a) for y in (-b, b) for z in (-c, c)))


def soup(rng: Rng, triangles: int, size: float = 0.3) -> Mesh:
    """Triangles anywhere in a ball, not round the origin."""
    middles = rng.normal(size=(triangles, 1, 3)) * size + rng.uniform(-size, size, 3)
    corners = middles + rng.normal(size=(triangles, 3, 3)) * 0.4 * size
    return Mesh(corners.reshape(-1, 3), np.arange(3 * triangles).reshape(-1, 3))


RANDOM: dict[str, Callable[[Rng], Shape]] = {
    "box": lambda rng: Box((_number(rng, 0.05, 0.6), _number(rng, 0.05, 0.6), _number(rng, 0.05, 0.6))),
    "sphere": lambda rng: Sphere(_number(rng, 0.02, 0.4)),
    "capsule": lambda rng: Capsule(_number(rng, 0.02, 0.3), _number(rng, 0.02, 0.8)),
    "cylinder": lambda rng: Cylinder(_number(rng, 0.02, 0.4), _number(rng, 0.02, 0.8)),
    "hull": lambda rng: random_hull(rng, int(rng.integers(4, 40))),
    "mesh": lambda rng: soup(rng, int(rng.integers(1, 40)), 0.1),
}


def stacked(nears: list[Nearby]) -> Spans:
    """The same number of obstacles in one span after the other."""
    return Spans(np.stack([near.rows for near in nears]), nears[0].packed)


def obstacles_of(shapes: list[Shape], rng: Rng) -> Obstacles:
    """Obstacles of these shapes, somewhere within a metre, turned at random."""
    count = len(shapes)
    turns = quaternion.normalize(rng.normal(size=(count, 4)))
    names = tuple(f"thing {i}" for i in range(count))
    return Obstacles(tuple(shapes), rng.uniform(-1.0, 1.0, (count, 3)), turns, names, ground=-9.0)


def some_obstacles(rng: Rng, each: int) -> Obstacles:
    """So many of each shape."""
    return obstacles_of([make(rng) for make in RANDOM.values() for _ in range(each)], rng)


def box_mesh(half: tuple[float, float, float]) -> Mesh:
    """The surface of a box as twelve triangles, counter-clockwise seen from outside."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * np.array(half)
    faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1],
             [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]  # fmt: skip
    return Mesh(corners, np.array(faces))
