"""Which obstacles a tile of axes passes by: told by boxes along the frame's axes, before anything is looked into.

Of all that stands about somebody most is far from each of his capsules. To tell that by six numbers costs a tenth of
what it costs to see sixteen axes from an obstacle.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import inner_kernel
from elbowroom.world.obstacles.extents import reach_along
from elbowroom.world.obstacles.layout import KIND, LANES, PER_METRE, TILE, Nearby, ShapeKind

Floats32 = NDArray[np.float32]

_AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_LANES, _TILE = np.uint64(LANES), np.uint64(TILE)
_METRES: Any = np.float32(1.0 / PER_METRE)
_SOON = float(ShapeKind.ROUNDED)  # up to this kind they are boxes, with sharp or rounded edges
_SLACK: Any = np.float32(1e-3)  # metres by which a box is larger than it must be: more than any rounding


class Boxes(NamedTuple):
    """The boxes round B obstacles, along the frame's axes."""

    sides: Floats32  # (6, B) metres: their least coordinates, then their greatest
    dear: bool  # whether any is dear to look into: else one may as well look into all


@inner_kernel
def boxes_round(near: Nearby) -> Boxes:
    """The boxes round obstacles, a little larger than they must be."""
    sides, dear = np.empty((6, near.rows.shape[0]), np.float32), False
    for b in range(near.rows.shape[0]):
        dear = dear or near.rows[b, KIND] > _SOON
        for i in range(3):
            reach = reach_along(near, b, _AXES[i]) + _SLACK
            sides[i, b], sides[3 + i, b] = near.rows[b, i] - reach, near.rows[b, i] + reach
    return Boxes(sides, dear)


@inner_kernel
def apart_from(tiles: Floats32, t: int, squares: Floats32, sides: Floats32, apart: Floats32) -> None:
    """Write to `apart` (B,) how far obstacles in boxes, by their `sides`, lie outside of what may be nearer to tile t.

    Nearer than `squares` say: squared distances of axes in units of the tiles. Positive for what it passes by.
    """
    first, at, most = np.uint64(t) * _LANES, np.uint64(t) * _TILE, squares[t * LANES]
    for n in range(_LANES):
        most = max(most, squares[first + n])
    away = math.sqrt(most) * _METRES + _SLACK
    apart[:] = -away
    for i in range(3):
        begin, end = at + np.uint64(i) * _LANES, at + np.uint64(3 + i) * _LANES
        low, high = tiles[begin], tiles[begin]
        for n in range(_LANES):
            low, high = (
                min(low, tiles[begin + n], tiles[end + n]),
                max(high, tiles[begin + n], tiles[end + n]),
            )
        low, high = low - away, high + away
        for b in range(np.uint64(apart.shape[0])):
            apart[b] = max(apart[b], sides[i, b] - high, low - sides[3 + i, b])
