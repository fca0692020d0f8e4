"""The ground of places, kept on disk: a large one takes seconds to make, and a place is opened more than once."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.kept_arrays import Arrays, kept
from elbowroom.world.ground.ground import Ground
from elbowroom.world.places.floor_area import FloorArea

Floats = NDArray[np.float64]

_MANY = 2000  # triangles: fewer, as a scene's own shapes have them, are made ground at once
_LONE: dict[str, Callable[[Any], Any]] = {
    "plain": bool,
    "step": float,
    "cell": float,
    "beyond": bool,
}  # fields that are one number
_PAIRS: dict[str, Callable[[Any], Any]] = {"corner": float, "shape": int}  # and two


def kept_ground(
    source: str, triangles: Floats, floor: FloorArea | None, step: float, make: Callable[[], Ground]
) -> Ground:
    """What `make` returns, from disk if it was made of the same before; `source` is the file of who makes it.

    It is made of triangles (T, 3, 3), of where a place has its `floor`, and of the highest `step`.
    """
    if floor is None and len(triangles) < _MANY:
        return make()
    area = () if floor is None else (floor.there, np.array([*floor.origin, floor.cell]))
    return _read(kept(source, (np.array([step]), triangles, *area), lambda: _written(make())))


def _written(ground: Ground) -> Arrays:
    return {name: np.asarray(value) for name, value in zip(ground._fields, ground, strict=True)}


def _read(arrays: Arrays) -> Ground:
    fields: dict[str, Any] = dict(arrays)
    for name, kind in _LONE.items():
        fields[name] = kind(arrays[name])
    for name, kind in _PAIRS.items():
        fields[name] = tuple(map(kind, arrays[name].tolist()))
    return Ground(**fields)
