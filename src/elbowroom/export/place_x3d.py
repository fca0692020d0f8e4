"""A scene as X3D 4: a Transform for each obstacle, what moves there by interpolators (ISO/IEC 19775-1:2023)."""

from collections.abc import Iterator
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.export.place import COLORS, color_of
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.shapes import Box, Cylinder, Shape, Sphere
from elbowroom.world.obstacles.tracks.moving import Repeat, Track
from elbowroom.world.obstacles.triangles import triangles_of
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

_HEAD = """<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE X3D PUBLIC "ISO//Web3D//DTD X3D 4.0//EN" "https://www.web3d.org/specifications/x3d-4.0.dtd">
<X3D profile="Immersive" version="4.0">
<head><meta name="generator" content="Elbowroom"/></head>
<Scene>"""
_THIN = 0.002  # metres: how thick ground and finish are


def place_x3d(scene: Scene) -> bytes:
    """The scene, metres, Y up: ground, finish and obstacles by their names."""
    x, z = scene.ground_center
    wide, deep = scene.ground_size
    gate = scene.finish
    turn = quaternion.about_axis(1, gate.heading)
    lines = [
        _HEAD,
        _transform("ground", (x, -_THIN, z), None, _shape(Box((wide, _THIN, deep)), COLORS["ground"])),
        _transform(
            "finish",
            (gate.position[0], 0.0, gate.position[1]),
            turn,
            _shape(Box((gate.width, _THIN, 0.1)), COLORS["finish"]),
        ),
    ]
    for name, shape, center, rotation in scene.obstacles:
        lines.append(_transform(name, center, rotation, _shape(shape, color_of(scene, name, "standing"))))
    for number, track in enumerate(scene.obstacles.moving.tracks):
        lines += _moving(track, f"moving_{number}", color_of(scene, track.name, "moving"))
    return "\n".join([*lines, "</Scene>", "</X3D>", ""]).encode()


def _moving(track: Track, used: str, color: tuple[float, float, float]) -> Iterator[str]:
    """A thing on its track: there and back again is one round of the clock."""
    times, centers, yaws = track.times, track.centers, track.yaws
    if track.repeat is Repeat.PINGPONG:
        times = np.concatenate([times, 2.0 * times[-1] - times[-2::-1]])
        centers, yaws = np.concatenate([centers, centers[-2::-1]]), np.concatenate([yaws, yaws[-2::-1]])
    yield _transform(track.name, centers[0], quaternion.about_axis(1, float(yaws[0])), _shape(track.shape, color), used)
    loop = "false" if track.repeat is Repeat.ONCE else "true"
    yield f'<TimeSensor DEF="{used}_clock" cycleInterval="{times[-1]:.8g}" loop="{loop}"/>'
    keys = _numbers(times / times[-1])
    turns = np.stack([np.zeros_like(yaws), np.ones_like(yaws), np.zeros_like(yaws), yaws], axis=1)
    for kind, field, values in (("Position", "translation", centers), ("Orientation", "rotation", turns)):
        name = f"{used}_{field}"
        yield f'<{kind}Interpolator DEF="{name}" key="{keys}" keyValue="{_numbers(values)}"/>'
        yield f'<ROUTE fromNode="{used}_clock" fromField="fraction_changed" toNode="{name}" toField="set_fraction"/>'
        yield f'<ROUTE fromNode="{name}" fromField="value_changed" toNode="{used}" toField="set_{field}"/>'


def _transform(name: str, center: ArrayLike, rotation: Floats | None, shape: str, used: str = "") -> str:
    turn = f' rotation="{_numbers(_axis_angle(rotation))}"' if rotation is not None else ""
    mark = f' DEF="{used}"' if used else ""
    told = f'<MetadataString name="name" value={quoteattr(_quoted(name))}/>'
    return f'<Transform{mark} translation="{_numbers(center)}"{turn}>{told}{shape}</Transform>'


def _quoted(name: str) -> str:
    """A text among those of an MFString."""
    escaped = name.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def _shape(shape: Shape, color: tuple[float, float, float]) -> str:
    look = f'<Appearance><Material diffuseColor="{_numbers(color)}"/></Appearance>'
    return f"<Shape>{look}{_geometry(shape)}</Shape>"


def _geometry(shape: Shape) -> str:
    match shape:
        case Box(size):
            return f'<Box size="{_numbers(size)}"/>'
        case Sphere(radius):
            return f'<Sphere radius="{radius:.8g}"/>'
        case Cylinder(radius, height):
            return f'<Cylinder radius="{radius:.8g}" height="{height:.8g}"/>'
        case _:
            points = _numbers(triangles_of(shape).reshape(-1, 3))
            return f'<TriangleSet solid="false"><Coordinate point="{points}"/></TriangleSet>'


def _axis_angle(rotation: Floats) -> Floats:
    """Axis and angle (4,) of a rotation (4,)."""
    sine = float(np.linalg.norm(rotation[:3]))
    axis = rotation[:3] / sine if sine > 1e-12 else np.array([0.0, 1.0, 0.0])
    return np.append(axis, 2.0 * np.arctan2(sine, rotation[3]))


def _numbers(values: ArrayLike) -> str:
    return " ".join(f"{value:.8g}" for value in np.ravel(np.asarray(values, np.float64)).tolist())
