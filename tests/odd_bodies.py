"""Bodies made of few triangles: of boxes, of rings at the joints, with big heads; for `Recipe.body`."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.fitting.proportions import proportional_skeleton

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SKELETON = proportional_skeleton(1.7)


class Body(NamedTuple):
    """Triangles in the frame of `SKELETON` in T-pose."""

    points: Floats  # (V, 3) metres
    bones: tuple[str, ...]  # (V,) the one bone that each point hangs on
    triangles: Ints  # (T, 3)


def box_body(head: float = 0.26) -> Body:
    """Every part a box of eight points, the head a cube with such a side."""
    parts = [_box("hips", (0.0, 0.93, 0.0), (0.32, 0.16, 0.20)), _box("chest", (0.0, 1.20, 0.0), (0.36, 0.38, 0.22))]
    parts.append(_box("head", (0.0, float(_at("head")[1]) - 0.05 + 0.5 * head, 0.0), (head, head, head)))
    for side, sign in (("left", 1.0), ("right", -1.0)):
        for bone, tip, width in (
            ("UpperArm", "LowerArm", 0.09),
            ("LowerArm", "Hand", 0.08),
            ("UpperLeg", "LowerLeg", 0.14),
            ("LowerLeg", "Foot", 0.12),
        ):
            a, b = _at(side + bone), _at(side + tip)
            parts.append(_box(side + bone, 0.5 * (a + b), np.abs(b - a) + width * (np.abs(b - a) < 0.01)))
        parts.append(_box(f"{side}Hand", _at(f"{side}Hand") + _way(0.08 * sign, 0.0, 0.0), (0.16, 0.05, 0.09)))
        parts.append(
            _box(f"{side}Foot", _at(f"{side}Foot") * _way(1.0, 0.0, 1.0) + _way(0.0, 0.04, 0.05), (0.11, 0.08, 0.26))
        )
    return _joined(parts)


def ring_body(head: float = 0.11, sides: int = 6) -> Body:
    """Rings of points at the joints alone, each wholly on its joint, and straight triangles from ring to ring.

    Between hips and shoulders there is nothing but triangles. The head is an octahedron with such a radius.
    """
    trunk = [
        ("hips", _at("leftUpperLeg") * _way(0.0, 1.0, 0.0), 0.17, 0.12),
        ("upperChest", _at("upperChest"), 0.19, 0.11),
    ]
    trunk.append(("neck", _at("neck"), 0.07, 0.07))
    parts = [_tube(trunk, 1, sides)]
    for side in ("left", "right"):
        arm = [(side + bone, _at(side + bone), radius, radius) for bone, radius in
               (("UpperArm", 0.055), ("LowerArm", 0.045), ("Hand", 0.035))]  # fmt: skip
        tip = _at(f"{side}Hand") + (_at(f"{side}Hand") - _at(f"{side}LowerArm")) * 0.6
        parts.append(_tube([*arm, (f"{side}Hand", tip, 0.03, 0.03)], 0, sides))
        leg = [(side + bone, _at(side + bone), radius, radius) for bone, radius in
               (("UpperLeg", 0.085), ("LowerLeg", 0.06), ("Foot", 0.045))]  # fmt: skip
        parts.append(_tube(leg, 1, sides))
        heel = _at(f"{side}Foot") * _way(1.0, 0.0, 1.0) + _way(0.0, 0.04, -0.06)
        parts.append(
            _tube(
                [(f"{side}Foot", heel, 0.04, 0.04), (f"{side}Foot", heel + _way(0.0, 0.0, 0.24), 0.04, 0.03)], 2, sides
            )
        )
    middle = _at("head") + _way(0.0, 0.6 * head, 0.0)
    points = np.concatenate([middle + head * np.eye(3), middle - head * np.eye(3)])
    faces = [[a, b, c] for a in (0, 3) for b in (1, 4) for c in (2, 5)]
    return _joined([*parts, Body(points, ("head",) * 6, np.array(faces))])


def _way(x: float, y: float, z: float) -> Floats:
    return np.array([x, y, z])


def _at(bone: str) -> Floats:
    place: Floats = SKELETON.positions[SKELETON.index(bone)]
    return place


def _box(bone: str, centre: Floats | tuple[float, ...], size: Floats | tuple[float, ...]) -> Body:
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    triangles = [three for a, b, c, d in quads for three in ([a, b, c], [a, c, d])]
    return Body(np.array(centre) + corners * np.array(size), (bone,) * 8, np.array(triangles))


def _tube(rings: list[tuple[str, Floats, float, float]], axis: int, sides: int) -> Body:
    """A closed tube along an axis: bone, middle and two half widths of each ring."""
    angles = np.arange(sides) * 2.0 * np.pi / sides
    across = [k for k in range(3) if k != axis]
    points, bones, triangles = [], [], []
    for bone, middle, wide, deep in rings:
        ring = np.tile(np.asarray(middle, float), (sides, 1))
        ring[:, across[0]] += wide * np.cos(angles)
        ring[:, across[1]] += deep * np.sin(angles)
        points.append(ring)
        bones += [bone] * sides
    for first in range(0, (len(rings) - 1) * sides, sides):
        for i in range(sides):
            a, b = first + i, first + (i + 1) % sides
            triangles += [[a, b, a + sides], [b, b + sides, a + sides]]
    for first in (0, (len(rings) - 1) * sides):
        triangles += [[first, first + i, first + i + 1] for i in range(1, sides - 1)]
    return Body(np.concatenate(points), tuple(bones), np.array(triangles))


def _joined(parts: list[Body]) -> Body:
    starts = np.cumsum([0, *(len(part.points) for part in parts)])
    return Body(
        np.concatenate([part.points for part in parts]),
        tuple(bone for part in parts for bone in part.bones),
        np.concatenate([part.triangles + start for part, start in zip(parts, starts[:-1], strict=True)]),
    )
