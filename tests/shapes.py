"""Obstacles of every shape, for tests."""

from collections.abc import Callable

import numpy as np

from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.layout import Nearby, Spans
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Box, Capsule, Cylinder, Hull, Shape, Sphere

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


RANDOM: dict[str, Callable[[Rng], Shape]] = {
    "box": lambda rng: Box((_number(rng, 0.05, 0.6), _number(rng, 0.05, 0.6), _number(rng, 0.05, 0.6))),
    "sphere": lambda rng: Sphere(_number(rng, 0.02, 0.4)),
    "capsule": lambda rng: Capsule(_number(rng, 0.02, 0.3), _number(rng, 0.02, 0.8)),
    "cylinder": lambda rng: Cylinder(_number(rng, 0.02, 0.4), _number(rng, 0.02, 0.8)),
    "hull": lambda rng: random_hull(rng, int(rng.integers(4, 40))),
}


def stacked(nears: list[Nearby]) -> Spans:
    """The same number of obstacles in one span after the other."""
    return Spans(np.stack([near.rows for near in nears]), nears[0].hulls)


def obstacles_of(shapes: list[Shape], rng: Rng) -> Obstacles:
    """Obstacles of these shapes, somewhere within a metre, turned at random."""
    count = len(shapes)
    turns = quaternion.normalize(rng.normal(size=(count, 4)))
    names = tuple(f"thing {i}" for i in range(count))
    return Obstacles(tuple(shapes), rng.uniform(-1.0, 1.0, (count, 3)), turns, names)


def some_obstacles(rng: Rng, each: int) -> Obstacles:
    """So many of each shape."""
    return obstacles_of([make(rng) for make in RANDOM.values() for _ in range(each)], rng)
