"""Scenes as JSON documents: the run-time reader and writer of what `data/scene.schema.json` publishes.

A test holds reader and schema together on many broken documents.
"""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from numbers import Real
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RootState
from elbowroom.errors import InputError, in_a_line
from elbowroom.geometry import quaternion
from elbowroom.world.ground.making import walked_over
from elbowroom.world.json_place import JsonPlace
from elbowroom.world.limits import FARTHEST, LARGEST, NAME, read_angle, read_color
from elbowroom.world.moving_format import read_moving, write_moving
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Hull, Shape
from elbowroom.world.obstacles.tracks.moving import Moving
from elbowroom.world.place_format import read_place_field, write_place
from elbowroom.world.places.scene_place import with_more
from elbowroom.world.scene import Gate, Scene, on_ground
from elbowroom.world.shape_format import FIELDS, MOST_POINTS_TOGETHER, read_shape, type_of, write_shape
from elbowroom.world.stops import read_tour, write_tour

FORMAT = "elbowroom-scene"
VERSION = 1

MAX_OBSTACLES = 10_000
_TITLE, _PROSE = 200, 4000  # characters
_AROUND = 8.0  # metres of ground around start and finish, where nobody says how much

# What a start must leave free: a slim standing figure's legs and pelvis, metres.
_STANCE_LOW, _STANCE_HIGH, _STANCE_RADIUS = 0.1, 1.0, 0.12

_ALWAYS = ("format", "version", "name")
_FOUND = ("ground", "start", "finish", "obstacles")  # in a model of a place, where the scene has one
_TURNS = ("rotation", "yaw", "euler")


def read_scene(document: Any, source: str, folder: Path | None = None) -> Scene:
    """The scene in a parsed JSON document; raises `InputError` at the first wrong field.

    `folder` is where the model of a place lies that it may name.
    """
    placed = isinstance(document, dict) and "place" in document
    needed, possible = (_ALWAYS, ("place", *_FOUND)) if placed else ((*_ALWAYS, *_FOUND), ())
    fields = JsonPlace(source, "$", document).fields(
        needed, ("$schema", "title", "description", "moving", "tour", *possible)
    )
    fields["format"].constant(FORMAT)
    fields["version"].constant(VERSION)
    if "$schema" in fields:
        fields["$schema"].text(_TITLE)
    name = fields["name"].text(NAME, least=1)
    found = read_place_field(fields["place"], folder) if placed else _EMPTY
    standing = _read_obstacles(fields["obstacles"]) if "obstacles" in fields else Obstacles()
    colors = _read_colors(fields.get("obstacles"), standing.standing_names)
    standing = replace(standing, moving=read_moving(fields["moving"]) if "moving" in fields else Moving())
    center, size = _read_ground(fields["ground"]) if "ground" in fields else (found.ground_center, found.ground_size)
    scene = Scene(
        name=name,
        title=fields["title"].text(_TITLE) if "title" in fields else name,
        description=fields["description"].text(_PROSE) if "description" in fields else found.description,
        ground_center=center,
        ground_size=size,
        start=_read_start(fields["start"]) if "start" in fields else found.start,
        finish=_read_gate(fields["finish"]) if "finish" in fields else found.finish,
        obstacles=_in_place(found, standing) if placed else standing,
        colors=colors | _read_colors(fields.get("moving"), standing.moving.names),
        place=found.place,
        tour=read_tour(fields["tour"]) if "tour" in fields else (),
    )
    _refuse_off_the_ground(scene, fields)
    _refuse_start_in_obstacle(scene, fields.get("start", fields.get("place", fields["name"])))
    return scene


def _in_place(found: Scene, more: Obstacles) -> Obstacles:
    """What stands in a place, and what a scene adds to it."""
    return walked_over(with_more(found.obstacles, more), found.place.floor if found.place else None)


def _read_ground(place: JsonPlace) -> tuple[tuple[float, float], tuple[float, float]]:
    """The middle of the ground and its size."""
    fields = place.fields(("size",), ("center",))
    center = _pair(fields["center"].vector(2, -FARTHEST, FARTHEST)) if "center" in fields else (0.0, 0.0)
    return center, _pair(fields["size"].vector(2, 0.0, LARGEST, above=True))


_EMPTY = Scene("", "", "", (0.0, 0.0), (1.0, 1.0), RootState(), Gate((0.0, 1.0)))


def _pair(values: list[float]) -> tuple[float, float]:
    return values[0], values[1]


def _read_start(place: JsonPlace) -> RootState:
    fields = place.fields(("position",), ("heading",))
    x, z = fields["position"].vector(2, -FARTHEST, FARTHEST)
    return RootState(x=x, z=z, heading=read_angle(fields["heading"]) if "heading" in fields else 0.0)


def _read_gate(place: JsonPlace) -> Gate:
    fields = place.fields(("position",), ("heading", "width"))
    return Gate(
        position=_pair(fields["position"].vector(2, -FARTHEST, FARTHEST)),
        heading=read_angle(fields["heading"]) if "heading" in fields else 0.0,
        width=fields["width"].number(0.0, LARGEST, above=True) if "width" in fields else Gate.width,
    )


def _read_obstacles(place: JsonPlace) -> Obstacles:
    rows = [_read_obstacle(item, i) for i, item in enumerate(place.items(MAX_OBSTACLES))]
    if not rows:
        return Obstacles()
    names, shapes, centers, rotations = zip(*rows, strict=True)
    together = sum(len(shape.points) for shape in shapes if isinstance(shape, Hull))
    if together > MOST_POINTS_TOGETHER:
        most = f"at most {MOST_POINTS_TOGETHER} are allowed"
        raise InputError(f"{place.source}: the hulls in {place.path} have {together} points together; {most}")
    return Obstacles(shapes, np.array(centers), np.array(rotations), names)


def _read_colors(place: JsonPlace | None, names: Sequence[str]) -> dict[str, str]:
    """The colours in a list of obstacles that have been read, by their names."""
    if place is None:
        return {}
    colored = [(i, name) for i, name in enumerate(names) if "color" in place.value[i]]
    return {
        name: read_color(JsonPlace(place.source, f"{place.path}[{i}].color", place.value[i]["color"]))
        for i, name in colored
    }


def _read_obstacle(place: JsonPlace, index: int) -> tuple[str, Shape, list[float], NDArray[np.float64]]:
    """One obstacle: name, shape, centre, rotation. Its type decides which fields it has."""
    kind = type_of(place)
    fields = place.fields(("type", "center", *FIELDS[kind]), ("name", "color", *(_TURNS if kind != "sphere" else ())))
    name = fields["name"].text(NAME, least=1) if "name" in fields else f"{kind} {index + 1}"
    center = fields["center"].vector(3, -FARTHEST, FARTHEST)
    rotation = _read_rotation(place, fields)
    return name, read_shape(kind, fields), center, rotation


def _read_rotation(place: JsonPlace, fields: dict[str, JsonPlace]) -> NDArray[np.float64]:
    given = [name for name in _TURNS if name in fields]
    if len(given) > 1:
        raise InputError(f"{place.source}: {place.path} has both {' and '.join(given)}; give one of them")
    if "yaw" in fields:
        return quaternion.about_axis(1, read_angle(fields["yaw"]))
    if "euler" in fields:
        return _from_euler([read_angle(item) for item in _three(fields["euler"])])
    if "rotation" in fields:
        return _unit_quaternion(fields["rotation"])
    return quaternion.IDENTITY


def _three(place: JsonPlace) -> list[JsonPlace]:
    if not isinstance(place.value, list) or len(place.value) != 3:
        place.fail("must be a list of 3 angles in radians, about X, Y and Z")
    return list(place.items(3))


def _from_euler(angles: list[float]) -> NDArray[np.float64]:
    """Rotation Ry(y) Rx(x) Rz(z): the order "YXZ" of three.js."""
    about_x, about_y, about_z = (quaternion.about_axis(axis, angle) for axis, angle in enumerate(angles))
    return quaternion.multiply(about_y, quaternion.multiply(about_x, about_z))


def _unit_quaternion(place: JsonPlace) -> NDArray[np.float64]:
    """Four numbers that are nearly a unit quaternion: one of them is at least a half, as in every unit quaternion."""
    values = np.array(place.vector(4, -1.0, 1.0))
    if np.max(np.abs(values)) < 0.49:
        place.fail("must be a unit quaternion x, y, z, w")
    if abs(np.linalg.norm(values) - 1.0) < 1e-9:
        return values  # as written, so that writing and reading change nothing
    return quaternion.normalize(values)


def _refuse_off_the_ground(scene: Scene, fields: dict[str, JsonPlace]) -> None:
    """Start and finish lie on the ground, and the way from the one to the other is not over before it begins."""
    for name, point in (("start", (scene.start.x, scene.start.z)), ("finish", scene.finish.position)):
        edges = zip(point, scene.ground_center, scene.ground_size, strict=True)
        beyond = max(abs(at - middle) - 0.5 * size for at, middle, size in edges)
        if beyond > 0.0:
            place = JsonPlace(fields["name"].source, f"$.{name}.position", list(point))
            place.fail(f"it lies {beyond:.3g} m off the ground; move it or make the ground larger")
    if scene.finished(scene.start):
        fields.get("finish", fields["name"]).fail(
            "the start lies behind it already; turn its heading or move one of them"
        )


def _refuse_start_in_obstacle(scene: Scene, place: JsonPlace) -> None:
    """What is no higher than a step is stood on where the ground is not plain."""
    x, z, ground = scene.start.x, scene.start.z, scene.ground
    height = on_ground(scene, scene.start).height
    bottom = height + (_STANCE_LOW if ground.plain else ground.step + 2.0 * _STANCE_RADIUS)
    top = height + _STANCE_HIGH
    least, most = scene.obstacles.first_bounds()
    low, high = np.array([x, bottom, z]) - _STANCE_RADIUS, np.array([x, top, z]) + _STANCE_RADIUS
    if not np.any(np.all((least <= high) & (most >= low), axis=1)):
        return  # told without a kernel, which may have to be compiled
    legs = np.array([[0.0, bottom, 0.0, 0.0, top, 0.0]])
    found = scene.obstacles.nearest(legs, [_STANCE_RADIUS], (x, z), 0.0)
    if found is not None and found.distance < 0.0:
        name = scene.obstacles.names[found.obstacle]
        here = JsonPlace(place.source, f"{place.path}.position", [x, z])
        here.fail(f"it stands in the obstacle {name!r}; move one of them")


def scene_document(
    name: str,
    obstacles: Sequence[Mapping[str, Any]],
    start: tuple[float, float],
    finish: tuple[float, float],
    moving: Sequence[Mapping[str, Any]] = (),
) -> dict[str, Any]:
    """The document of a scene from `start` straight to `finish` (x, z, metres), on ground `_AROUND` both."""
    for what, place in (("start", start), ("finish", finish)):
        if not _is_spot(place):
            raise InputError(f"{name}: {what} is {in_a_line(place)}: it must be (x, z) in metres")
    heading = math.atan2(finish[0] - start[0], finish[1] - start[1])
    document = {
        "format": FORMAT,
        "version": VERSION,
        "name": name,
        "ground": {
            "size": [abs(b - a) + 2.0 * _AROUND for a, b in zip(start, finish, strict=True)],
            "center": [0.5 * (a + b) for a, b in zip(start, finish, strict=True)],
        },
        "start": {"position": list(start), "heading": heading},
        "finish": {"position": list(finish), "heading": heading},
        "obstacles": [dict(obstacle) for obstacle in obstacles],
    }
    return document | ({"moving": [dict(thing) for thing in moving]} if moving else {})


def _is_spot(place: object) -> bool:
    return isinstance(place, Collection) and len(place) == 2 and all(isinstance(length, Real) for length in place)


def write_scene(scene: Scene) -> dict[str, Any]:
    """The JSON document of a scene."""
    document = {
        "format": FORMAT,
        "version": VERSION,
        "name": scene.name,
        "title": scene.title,
        "description": scene.description,
        "ground": {"size": list(scene.ground_size), "center": list(scene.ground_center)},
        "start": {"position": [scene.start.x, scene.start.z], "heading": scene.start.heading},
        "finish": {
            "position": list(scene.finish.position),
            "heading": scene.finish.heading,
            "width": scene.finish.width,
        },
        "obstacles": [
            _written(*row) | _color(scene, row[0])
            for row in list(scene.obstacles)[scene.place.parts if scene.place else 0 :]
        ],
    }
    moving = scene.obstacles.moving
    placed = {"place": write_place(scene.place, scene.obstacles)} if scene.place else {}
    tracks = [track | _color(scene, track["name"]) for track in write_moving(moving)]
    tour = {"tour": write_tour(scene.tour)} if scene.tour else {}
    return document | placed | ({"moving": tracks} if tracks else {}) | tour


def _color(scene: Scene, name: str) -> dict[str, str]:
    return {"color": scene.colors[name]} if name in scene.colors else {}


def _written(name: str, shape: Shape, center: NDArray[np.float64], rotation: NDArray[np.float64]) -> dict[str, Any]:
    fields = write_shape(shape)
    turned = {} if fields["type"] == "sphere" else {"rotation": rotation.tolist()}
    return {"type": fields.pop("type"), "name": name, "center": center.tolist(), **fields, **turned}
