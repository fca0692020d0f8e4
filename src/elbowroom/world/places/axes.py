"""Which way is up in a model and how long its unit is: as its format says, as it looks, or as the user tells."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.models.kinds import ModelKind
from elbowroom.formats.models.said import Said
from elbowroom.world.places.options import PlaceOptions

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

# Turns that bring an axis of the file up: rows are x, y, z of the place in the file's.
_TURNS = {
    "x": ((0, -1, 0), (1, 0, 0), (0, 0, 1)),
    "y": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "z": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
    "-x": ((0, 1, 0), (-1, 0, 0), (0, 0, 1)),
    "-y": ((1, 0, 0), (0, -1, 0), (0, 0, -1)),
    "-z": ((1, 0, 0), (0, 0, -1), (0, 1, 0)),
}
_LEVEL = 0.98  # cosine between a face's normal and an axis at which it lies across the axis
_LOW = 0.2  # share of the height in which a floor is looked for
_NO_FLOOR, _A_FLOOR = 0.25, 0.6  # share of the ground that level faces cover there
_UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "foot": 0.3048}
_LOWEST, _HIGHEST = 1.9, 50.0  # metres of a room, a house or a level: a model of so many units is taken to be in metres
_LIKELY_HEIGHT = 3.0  # metres of a room or a house
_SMALLEST, _LARGEST = 1.0, 1000.0  # metres a place is wide


@dataclass(frozen=True, eq=False)
class ModelAxes:
    """How a model is stood up."""

    up: str
    metre: float
    turn: Floats  # (3, 3)
    told: tuple[str, ...]
    notes: tuple[str, ...]


def axes_of(
    vertices: Floats, faces: Ints, kind: ModelKind, options: PlaceOptions, said: Said | None = None
) -> ModelAxes:
    """Stand a model up: vertices (V, 3) in the file's axes and units, faces (F, 3); `said` is what the file says."""
    up, why_up = _up_of(vertices, faces, kind, options, said)
    turn = np.array(_TURNS[up], np.float64)
    extents = np.ptp(vertices @ turn.T, axis=0)
    broad = float(max(extents[0], extents[2]))
    metre, why_metre = _metre_of(float(extents[1]), broad, kind, options, said)
    wide = metre * broad
    notes: tuple[str, ...] = ()
    if not _SMALLEST <= wide <= _LARGEST:
        notes = (f"it is {wide:.3g} m wide, which is odd for a place: tell its unit with --scale",)
    return ModelAxes(up, metre, turn, (why_up, why_metre), notes)


def _up_of(vertices: Floats, faces: Ints, kind: ModelKind, options: PlaceOptions, said: Said | None) -> tuple[str, str]:
    if options.up is not None:
        return options.up, f"{_signed(options.up)} is up, as told"
    if said is not None:
        return said.up, f"{_signed(said.up)} is up, as the file says"
    y, z = _floor_share(vertices, faces, 1), _floor_share(vertices, faces, 2)
    if y < _NO_FLOOR and z > _A_FLOOR:
        odd = ", although the format says +Y" if kind.says_its_unit else ""
        return "z", f"+Z is up: only across it there is a floor{odd} (--up tells otherwise)"
    why = "as the format says" if kind.says_its_unit else "as in most files"
    return "y", f"+Y is up, {why}"


def _signed(axis: str) -> str:
    return axis.upper() if axis.startswith("-") else f"+{axis.upper()}"


def _floor_share(vertices: Floats, faces: Ints, axis: int) -> float:
    """How much of the ground below the model is covered by faces across an axis that lie low along it."""
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    least, extents = vertices[:, axis].min(), np.ptp(vertices, axis=0)
    low = corners[:, :, axis].max(axis=1) <= least + _LOW * extents[axis]
    level = np.abs(normals[:, axis]) > _LEVEL * areas
    ground = float(np.prod(np.delete(extents, axis)))
    covered = 0.5 * float(areas[low & level].sum())
    return covered / ground if ground > 0.0 else 0.0


def _metre_of(
    height: float, broad: float, kind: ModelKind, options: PlaceOptions, said: Said | None
) -> tuple[float, str]:
    if options.scale is not None:
        return options.scale, f"a unit is {options.scale:g} m, as told"
    if said is not None:
        return said.metre, f"a unit is {said.metre:g} m, as the file says"
    if kind.says_its_unit:
        return 1.0, "a unit is 1 m, as the format says"
    tall = max(height, 1e-9)
    name = _likely_unit(tall, broad)
    return _UNITS[name], (
        f"a unit is taken for 1 {name}: so the place is {tall * _UNITS[name]:.3g} m high (--scale tells otherwise)"
    )


def _likely_unit(tall: float, broad: float) -> str:
    """A metre where that is as high as places are; else what comes nearest to a room, of those not odd in breadth."""
    if _LOWEST <= tall <= _HIGHEST:
        return "m"
    fitting = [name for name, metre in _UNITS.items() if _SMALLEST <= metre * broad <= _LARGEST] or ["m"]
    return min(fitting, key=lambda name: abs(np.log(tall * _UNITS[name] / _LIKELY_HEIGHT)) * _doubt(name))


def _doubt(unit: str) -> float:
    """Inches and feet are seldom: they must fit much better."""
    return 3.0 if unit in ("inch", "foot") else 1.0
