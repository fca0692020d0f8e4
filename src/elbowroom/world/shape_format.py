"""Shapes in scene documents: the part of reader and writer that knows them, standing or moving."""

from collections.abc import Callable
from typing import Any

import numpy as np

from elbowroom.errors import InputError
from elbowroom.world.json_place import JsonPlace
from elbowroom.world.limits import LARGEST
from elbowroom.world.obstacles.meshes.hulls import THINNEST, FlatHullError, surface_of
from elbowroom.world.obstacles.shapes import Box, Capsule, Cylinder, Hull, Mesh, Shape, Sphere, Vector

FEWEST_POINTS, MOST_POINTS = 4, 128  # of a hull
MOST_POINTS_TOGETHER = 100_000  # of all hulls of a scene that stand
FEWEST_VERTICES, MOST_VERTICES, MOST_FACES = 3, 20_000, 40_000  # of a mesh

# The fields of each type, besides those of every obstacle.
FIELDS: dict[str, tuple[str, ...]] = {
    "box": ("size",),
    "sphere": ("radius",),
    "capsule": ("radius", "length"),
    "cylinder": ("radius", "height"),
    "hull": ("points",),
    "mesh": ("vertices", "faces"),
}


def type_of(place: JsonPlace) -> str:
    """The type of an obstacle; a box where it has none, so that what lacks is told as for a box."""
    if not isinstance(place.value, dict) or "type" not in place.value:
        return "box"
    named = JsonPlace(place.source, f"{place.path}.type", place.value["type"])
    if not isinstance(named.value, str) or named.value not in FIELDS:
        named.fail(f"must be one of {', '.join(FIELDS)}")
    return named.value


def read_shape(kind: str, fields: dict[str, JsonPlace]) -> Shape:
    """The shape of a type from an obstacle's fields."""
    return _READERS[kind](fields)


def write_shape(shape: Shape) -> dict[str, Any]:
    """The fields of a shape, its type first."""
    match shape:
        case Box(size):
            return {"type": "box", "size": list(size)}
        case Sphere(radius):
            return {"type": "sphere", "radius": radius}
        case Capsule(radius, length):
            return {"type": "capsule", "radius": radius, "length": length}
        case Cylinder(radius, height):
            return {"type": "cylinder", "radius": radius, "height": height}
        case Hull(points):
            return {"type": "hull", "points": [list(point) for point in points]}
        case Mesh():
            return {"type": "mesh", "vertices": shape.vertices.tolist(), "faces": shape.faces.tolist()}


def _length(place: JsonPlace) -> float:
    return place.number(0.0, LARGEST, above=True)


def _vector(values: list[float]) -> Vector:
    x, y, z = values
    return x, y, z


def _read_hull(fields: dict[str, JsonPlace]) -> Hull:
    place = fields["points"]
    points = [item.vector(3, -LARGEST, LARGEST) for item in place.items(MOST_POINTS)]
    if len(points) < FEWEST_POINTS:
        raise InputError(
            f"{place.source}: {place.path} has {len(points)} points; a hull has {FEWEST_POINTS} to {MOST_POINTS}"
        )
    hull = Hull(tuple(_vector(point) for point in points))
    try:
        surface_of(hull)
    except FlatHullError:
        raise InputError(
            f"{place.source}: {place.path} lie in a plane, or nearly; a hull must be {THINNEST * 1e3:g} mm thick"
        ) from None
    return hull


def _read_mesh(fields: dict[str, JsonPlace]) -> Mesh:
    corners, triangles = fields["vertices"], fields["faces"]
    vertices = [item.vector(3, -LARGEST, LARGEST) for item in corners.items(MOST_VERTICES)]
    if len(vertices) < FEWEST_VERTICES:
        raise InputError(f"{corners.source}: {corners.path} has {len(vertices)} corners; a mesh has 3 at least")
    faces = [_corner_numbers(item, len(vertices) - 1) for item in triangles.items(MOST_FACES)]
    if not faces:
        raise InputError(f"{triangles.source}: {triangles.path} has no triangles; a mesh has 1 to {MOST_FACES}")
    return Mesh(np.array(vertices), np.array(faces))


def _corner_numbers(place: JsonPlace, last: int) -> list[int]:
    """The numbers of a triangle's corners."""
    numbers = place.vector(3, 0, MOST_VERTICES - 1)
    if not all(number.is_integer() for number in numbers):
        place.fail("must be a list of 3 whole numbers: which of the vertices are its corners")
    if max(numbers) > last:
        place.fail(f"it names a corner that is not there; the vertices are 0 to {last}")
    return [int(number) for number in numbers]


_READERS: dict[str, Callable[[dict[str, JsonPlace]], Shape]] = {
    "box": lambda fields: Box(_vector(fields["size"].vector(3, 0.0, LARGEST, above=True))),
    "sphere": lambda fields: Sphere(_length(fields["radius"])),
    "capsule": lambda fields: Capsule(_length(fields["radius"]), _length(fields["length"])),
    "cylinder": lambda fields: Cylinder(_length(fields["radius"]), _length(fields["height"])),
    "hull": _read_hull,
    "mesh": _read_mesh,
}
