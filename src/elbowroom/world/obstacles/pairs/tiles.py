"""Tiles of sixteen capsules against obstacles of every kind: each pair goes to the kernel of its shape.

All of them lower squared distances of axes, so that one capsule's obstacles may be of any kind: an axis that enters a
shape has distance 0. A new shape is a kind, its file, and a branch here.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import helper, kernel
from elbowroom.world.obstacles.layout import KIND, PER_METRE, ROW, TURN, ShapeKind
from elbowroom.world.obstacles.pairs.capsule_box import lower_from_boxes, lower_from_rounded
from elbowroom.world.obstacles.pairs.capsule_cylinder import lower_from_cylinders
from elbowroom.world.obstacles.pairs.capsule_hull import lower_from_hulls
from elbowroom.world.obstacles.pairs.capsule_mesh import lower_from_meshes

_BOX, _ROUNDED, _CYLINDER, _HULL = (
    int(ShapeKind.BOX),
    int(ShapeKind.ROUNDED),
    int(ShapeKind.CYLINDER),
    int(ShapeKind.HULL),
)
_SCALE: Any = np.float32(PER_METRE)
_METRES: Any = np.float32(1.0 / PER_METRE)

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]


@kernel
def fill_tile_rows(table: Floats, count: int, rows: Floats32) -> None:
    """The first `count` rows of a table, flat and in the units of `lower_squares`; centres stay in metres."""
    for b in range(count):
        for k in range(ROW):
            scaled = TURN <= k < KIND
            rows[b * ROW + k] = table[b, k] * _SCALE if scaled else table[b, k]


@kernel
def lower_squares(
    tiles: Floats32, rows: Floats32, packed: Floats32, pairs: Longs, count: int, squares: Floats32
) -> None:
    """Lower the squared distances of tiles to those from obstacles, for the first `count` of `pairs` of tile and row.

    All of these obstacles are of one kind. `tiles` (T * TILE,), `rows` (B * ROW,) as `fill_tile_rows` leaves them,
    `packed` as in `Nearby`, `pairs` (P, 2), `squares` (T * LANES,) in units of their own.
    """
    kind = int(rows[pairs[0, 1] * ROW + KIND]) if count > 0 else _BOX
    if kind == _BOX:
        lower_from_boxes(tiles, rows, pairs, count, squares)
    elif kind == _ROUNDED:
        lower_from_rounded(tiles, rows, pairs, count, squares)
    elif kind == _CYLINDER:
        lower_from_cylinders(tiles, rows, pairs, count, squares)
    elif kind == _HULL:
        lower_from_hulls(tiles, rows, packed, pairs, count, squares)
    else:
        lower_from_meshes(tiles, rows, packed, pairs, count, squares)


@helper
def same_kind(rows: Floats32, one: int, other: int) -> bool:
    """Whether two rows may stand in one list of pairs."""
    return int(rows[one * ROW + KIND]) == int(rows[other * ROW + KIND])


@kernel
def lower_to_squares(squares: Floats32, radius: float, out: Floats32) -> None:
    """out[i] = min(out[i], clearance in metres), of capsules of one radius whose axes have these squared distances."""
    for i in range(np.uint64(out.shape[0])):
        out[i] = min(out[i], math.sqrt(squares[i]) * _METRES - radius)
