"""Courses of other shapes: boxes are cut down to what is round or pointed, so their certificate stays free."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.gauntlet.course import Course
from elbowroom.experiment.gauntlet.draw import GRAIN, Draw
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Box, Capsule, Cylinder, Hull, Shape, Sphere, Vector

Floats = NDArray[np.float64]

_SHARE = 0.75  # of the boxes
_CUBE = 1.6  # times as long as wide at most: a ball says the same
_CUT = 0.3  # of the least edge, off every edge of a box
_OWN = 7  # a stream of its own: the course itself is drawn as it was
_UPRIGHT = (
    quaternion.about_axis(2, -0.5 * np.pi),  # what stands along Y lies along X
    quaternion.IDENTITY,
    quaternion.about_axis(0, 0.5 * np.pi),
)


def in_shapes(course: Course) -> Course:
    """The same course with most boxes cut down to spheres, capsules, cylinders and hulls inside of them."""
    draw, scene = Draw(course.level, course.seed, _OWN), course.scene
    rows = [
        (name, *_cut(draw, shape, rotation))
        if isinstance(shape, Box) and draw.chance(_SHARE)
        else (name, shape, rotation)
        for name, shape, _, rotation in scene.obstacles
    ]
    names, shapes, rotations = zip(*rows, strict=True)
    obstacles = Obstacles(shapes, scene.obstacles.centers, np.array(rotations), names)
    return replace(course, scene=replace(scene, name=f"{scene.name}-shapes", obstacles=obstacles))


def _cut(draw: Draw, box: Box, rotation: Floats) -> tuple[Shape, Floats]:
    """A shape within a box, and how it is turned."""
    along = int(np.argmax(box.size))
    longest, widest = box.size[along], sorted(box.size)[1]
    thin = min(box.size)
    turned = quaternion.multiply(rotation, _UPRIGHT[along])
    kinds = ["hull", "hull"]
    if longest <= _CUBE * thin:
        kinds += ["sphere"]
    if widest <= _CUBE * thin:
        kinds += ["cylinder", "capsule"]
    kind = draw.one_of(kinds)
    if kind == "sphere":
        return Sphere(0.5 * thin), rotation
    if kind == "cylinder":
        return Cylinder(0.5 * thin, longest), turned
    if kind == "capsule" and longest > thin:
        return Capsule(0.5 * thin, round(longest - thin, GRAIN)), turned
    return _bevelled(box), rotation


def _bevelled(box: Box) -> Hull:
    """A box without its edges."""
    half, cut = 0.5 * np.array(box.size), 0.5 * _CUT * min(box.size)
    points: list[Vector] = []
    for axis in range(3):
        for signs in np.ndindex(2, 2, 2):
            corner = (2.0 * np.array(signs) - 1.0) * (half - cut * (np.arange(3) != axis))
            x, y, z = (round(float(value), 6) for value in corner)
            points.append((x, y, z))
    return Hull(tuple(points))
