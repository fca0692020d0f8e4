"""Squared distances of capsules' axes from cylinders, sixteen at a time.

In the axes of a cylinder about Y the squared distance of a point is that from the disc, seen from above, plus that from
the slab between top and bottom. Along an axis q(t) = n + t d it is convex, and half its slope grows steadily: its zero
is held in an interval that is halved a number of times; in what is left the slope is nearly straight.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import helper, inner_kernel
from elbowroom.world.obstacles.layout import LANES, ROW, TILE
from elbowroom.world.obstacles.pairs.own_axes import STATE, may_be_nearer

_LANES, _TILE = np.uint64(LANES), np.uint64(TILE)
_HALVINGS = 12
_ZERO: Any = np.float32(0.0)
_HALF: Any = np.float32(0.5)
_ONE: Any = np.float32(1.0)
_TINY: Any = np.float32(1e-20)

Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]
Vector = tuple[float, float, float]


@helper
def _slope(t: Any, n: Vector, d: Vector, radius: Any, half: Any) -> Any:
    """Half the slope of the squared distance at t, times the distance from Y: that spares a division."""
    x, y, z = n[0] + t * d[0], n[1] + t * d[1], n[2] + t * d[2]
    across = math.sqrt(x * x + z * z) + _TINY
    return (x * d[0] + z * d[2]) * max(across - radius, _ZERO) + d[1] * (y - max(min(y, half), -half)) * across


@inner_kernel
def lower_from_cylinders(tiles: Floats32, rows: Floats32, pairs: Longs, count: int, squares: Floats32) -> None:
    """Lower the squared distances of tiles to those from cylinders; arguments as in `lower_from_boxes`."""
    state = np.empty(STATE, np.float32)
    for p in range(count):
        tile, least, row = np.uint64(pairs[p, 0]) * _TILE, np.uint64(pairs[p, 0]) * _LANES, pairs[p, 1] * ROW
        if not may_be_nearer(tiles, tile, rows, row, squares, least, state):
            continue
        radius, half = rows[row + 12], rows[row + 13]
        for _ in range(_HALVINGS):
            for i in range(_LANES):
                nx, ny, nz = state[i], state[i + _LANES], state[i + np.uint64(2) * _LANES]
                dx, dy, dz = (
                    state[i + np.uint64(3) * _LANES],
                    state[i + np.uint64(4) * _LANES],
                    state[i + np.uint64(5) * _LANES],
                )
                low, high = state[i + np.uint64(6) * _LANES], state[i + np.uint64(7) * _LANES]
                middle = _HALF * (low + high)
                rising = _slope(middle, (nx, ny, nz), (dx, dy, dz), radius, half) > _ZERO
                state[i + np.uint64(6) * _LANES] = low if rising else middle
                state[i + np.uint64(7) * _LANES] = middle if rising else high
        for i in range(_LANES):
            nx, ny, nz = state[i], state[i + _LANES], state[i + np.uint64(2) * _LANES]
            dx, dy, dz = (
                state[i + np.uint64(3) * _LANES],
                state[i + np.uint64(4) * _LANES],
                state[i + np.uint64(5) * _LANES],
            )
            low, high = state[i + np.uint64(6) * _LANES], state[i + np.uint64(7) * _LANES]
            begin = _slope(low, (nx, ny, nz), (dx, dy, dz), radius, half)
            end = _slope(high, (nx, ny, nz), (dx, dy, dz), radius, half)
            share = max(min(-begin / max(end - begin, _TINY), _ONE), _ZERO)
            t = low + share * (high - low)
            x, y, z = nx + t * dx, ny + t * dy, nz + t * dz
            across, along = max(math.sqrt(x * x + z * z) - radius, _ZERO), max(abs(y) - half, _ZERO)
            squares[least + i] = min(squares[least + i], across * across + along * along)
