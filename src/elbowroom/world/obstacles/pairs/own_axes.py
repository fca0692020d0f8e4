"""Sixteen axes in an obstacle's own axes, for the kernels that work on them in several passes."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import inner_kernel
from elbowroom.world.obstacles.layout import LANES

STATE = 9 * LANES  # what is known of sixteen axes: begin (3), step (3), two places along them, a squared distance

_LANES = np.uint64(LANES)
_ZERO: Any = np.float32(0.0)
_ONE: Any = np.float32(1.0)

Floats32 = NDArray[np.float32]


@inner_kernel
def may_be_nearer(
    tiles: Floats32, tile: Any, rows: Floats32, row: Any, squares: Floats32, least: Any, state: Floats32
) -> bool:
    """Whether any axis of the tile at `tile` may be nearer to the obstacle at `row` than `squares` say at `least`.

    So the boxes round axis and obstacle tell. The axes are written to `state` (STATE,), with 0 and 1 for their ends.
    """
    cx, cy, cz = rows[row], rows[row + 1], rows[row + 2]
    m0, m1, m2, m3, m4 = rows[row + 3], rows[row + 4], rows[row + 5], rows[row + 6], rows[row + 7]
    m5, m6, m7, m8 = rows[row + 8], rows[row + 9], rows[row + 10], rows[row + 11]
    hx, hy, hz = rows[row + 12], rows[row + 13], rows[row + 14]
    for i in range(_LANES):
        at = tile + i
        ax, ay, az = tiles[at], tiles[at + _LANES], tiles[at + np.uint64(2) * _LANES]
        sx, sy, sz = (
            tiles[at + np.uint64(3) * _LANES] - ax,
            tiles[at + np.uint64(4) * _LANES] - ay,
            tiles[at + np.uint64(5) * _LANES] - az,
        )
        ux, uy, uz = ax - cx, ay - cy, az - cz
        bx, by, bz = m0 * ux + m1 * uy + m2 * uz, m3 * ux + m4 * uy + m5 * uz, m6 * ux + m7 * uy + m8 * uz
        dx, dy, dz = m0 * sx + m1 * sy + m2 * sz, m3 * sx + m4 * sy + m5 * sz, m6 * sx + m7 * sy + m8 * sz
        state[i], state[i + _LANES], state[i + np.uint64(2) * _LANES] = bx, by, bz
        state[i + np.uint64(3) * _LANES], state[i + np.uint64(4) * _LANES] = dx, dy
        state[i + np.uint64(5) * _LANES] = dz
        state[i + np.uint64(6) * _LANES], state[i + np.uint64(7) * _LANES] = _ZERO, _ONE
        # The box round the axis is at least so far from the box round the hull.
        x = max(min(bx, bx + dx) - hx, -hx - max(bx, bx + dx), _ZERO)
        y = max(min(by, by + dy) - hy, -hy - max(by, by + dy), _ZERO)
        z = max(min(bz, bz + dz) - hz, -hz - max(bz, bz + dz), _ZERO)
        state[i + np.uint64(8) * _LANES] = x * x + y * y + z * z
    near = 0
    for i in range(_LANES):
        near += state[i + np.uint64(8) * _LANES] < squares[least + i]
    return near > 0
