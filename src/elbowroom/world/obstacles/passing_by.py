"""Which obstacles a tile of axes passes by: told by boxes along the frame's axes, before anything is looked into.

Of all that stands about somebody most is far from each of his capsules. To tell that by six numbers costs a tenth of
what it costs to see sixteen axes from an obstacle.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import inner_kernel
from elbowroom.world.obstacles.layout import HALF, KIND, LANES, PER_METRE, ROUNDING, TILE, TURN, Kind, Nearby

Floats32 = NDArray[np.float32]

SIDES = 6  # numbers of a box: its least coordinates, then its greatest
_LANES, _TILE = np.uint64(LANES), np.uint64(TILE)
_METRES: Any = np.float32(1.0 / PER_METRE)
_SOON = float(Kind.ROUNDED)  # up to this kind they are boxes, with sharp or rounded edges
_SLACK: Any = np.float32(1e-3)  # metres by which a box is larger than it must be: more than any rounding


@inner_kernel
def boxes_round(near: Nearby) -> Floats32:
    """The boxes round obstacles, (SIDES, B) in metres; (SIDES, 0) where all are boxes, which are soon looked into."""
    boxes, dear = np.empty((SIDES, near.rows.shape[0]), np.float32), False
    for b in range(near.rows.shape[0]):
        dear = dear or near.rows[b, KIND] > _SOON
        for i in range(3):
            reach = near.rows[b, ROUNDING] + _SLACK
            for k in range(3):
                reach += abs(near.rows[b, TURN + 3 * k + i]) * near.rows[b, HALF + k]
            boxes[i, b], boxes[3 + i, b] = near.rows[b, i] - reach, near.rows[b, i] + reach
    return boxes if dear else boxes[:, :0].copy()


@inner_kernel
def apart_from(tiles: Floats32, t: int, squares: Floats32, boxes: Floats32, apart: Floats32) -> None:
    """Write to `apart` (B,) how far obstacles in `boxes` (SIDES, B) lie outside of what may be nearer to tile t.

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
            apart[b] = max(apart[b], boxes[i, b] - high, low - boxes[3 + i, b])
