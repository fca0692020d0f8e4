"""A spiral stair of open treads that taper, as in many houses, and the floor that it leads to, a gap beyond."""

import math
from typing import Any

from elbowroom.world.scene import Scene

TREADS = 15
RISE, TURN, NOSE = 0.177, math.radians(16.0), math.radians(6.0)  # of a tread; and how far each reaches under the next
POLE, WIDE = 0.1, 0.85  # metres from the axis to where treads begin and end
THICK, GAP, DEEP = 0.06, 0.2, 2.0  # metres; the floor ends so far beyond the last tread
_FIRST = math.radians(270.0)  # where the first begins: one comes from -X


def tread_top(number: int) -> float:
    """The height of a tread, from 1 on; the floor is as high as the last."""
    return RISE * number


def _at(radius: float, angle: float) -> tuple[float, float]:
    return radius * math.cos(angle), radius * math.sin(angle)


def _plate(corners: list[tuple[float, float]], top: float, name: str) -> dict[str, Any]:
    """A level plate of corners x and z."""
    points = [[x, height, z] for x, z in corners for height in (top - THICK, top)]
    return {"type": "hull", "name": name, "points": points, "center": [0.0, 0.0, 0.0]}


def _floor() -> list[tuple[float, float]]:
    """The corners of the floor, which begins a gap beyond the end of the last tread."""
    last = _FIRST + TURN * TREADS + NOSE
    (x, z), (ahead_x, ahead_z) = _at(1.0, last), _at(1.0, last + 0.5 * math.pi)
    return [
        (x * radius + far * ahead_x, z * radius + far * ahead_z)
        for radius, far in ((0.5 * POLE, GAP), (2.0, GAP), (2.0, DEEP), (0.5 * POLE, DEEP))
    ]


BEFORE = (-1.5, -0.5)  # the stair, x and z
ON_FLOOR = tuple(sum(corner[k] for corner in _floor()) / 4 for k in (0, 1))


def spiral_stair(ceiling: float | None = None) -> Scene:
    """The stair alone, with no rail; with a slab over its first five treads, if the height of its underside is told."""
    obstacles: list[dict[str, Any]] = [
        {"type": "cylinder", "name": "pole", "center": [0.0, 2.0, 0.0], "radius": POLE, "height": 4.0}
    ]
    for i in range(TREADS):
        begin, end = _FIRST + TURN * i, _FIRST + TURN * (i + 1) + NOSE
        corners = [_at(POLE, begin), _at(WIDE, begin), _at(WIDE, 0.5 * (begin + end)), _at(WIDE, end), _at(POLE, end)]
        obstacles.append(_plate(corners, tread_top(i + 1), f"tread {i + 1}"))
    obstacles.append(_plate(_floor(), tread_top(TREADS), "floor"))
    if ceiling is not None:
        slab = {"type": "box", "name": "slab", "center": [0.6, ceiling + 0.1, -0.6], "size": [1.2, 0.2, 1.2]}
        obstacles.append(slab)
    return Scene.of("spiral stair", obstacles, start=BEFORE, finish=(ON_FLOOR[0], ON_FLOOR[1]))
