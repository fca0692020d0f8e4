"""Squared distances of capsules' axes from convex hulls, sixteen at a time.

An axis that is apart from a hull is closest to it with one of its ends above a face, or somewhere along an edge. So
each end is held against every triangle of the surface, and the axis against every edge; the least is the distance. The
axis enters the hull where a piece of it is behind the planes of all triangles: then the distance is 0.

A tile that the box round the hull shows to be farther than what is known already is left out.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import helper, inner_kernel
from elbowroom.world.obstacles.layout import EDGE, LANES, LINE, ROW, TILE
from elbowroom.world.obstacles.pairs.axis_edge import hold_against_edge
from elbowroom.world.obstacles.pairs.own_axes import STATE, may_be_nearer

_LANES, _TILE, _LINE, _EDGE = np.uint64(LANES), np.uint64(TILE), np.uint64(LINE), np.uint64(EDGE)
_ZERO: Any = np.float32(0.0)
_ONE: Any = np.float32(1.0)
_TWO: Any = np.float32(2.0)
_FAR: Any = np.float32(1e30)
_TINY: Any = np.float32(1e-20)
_SLACK: Any = np.float32(3e-5)  # units of a tile, a micrometre: two triangles of one face leave no gap between them

Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]


@helper
def _hold_against_triangle(packed: Floats32, at: Any, state: Floats32) -> None:
    """Where sixteen axes are behind the plane of a triangle, and how far those of their ends are that lie above it."""
    nx, ny, nz, offset = packed[at], packed[at + np.uint64(1)], packed[at + np.uint64(2)], packed[at + np.uint64(3)]
    px, py, pz, po = (
        packed[at + np.uint64(4)], packed[at + np.uint64(5)], packed[at + np.uint64(6)], packed[at + np.uint64(7)],
    )  # fmt: skip
    qx, qy, qz, qo = (
        packed[at + np.uint64(8)], packed[at + np.uint64(9)], packed[at + np.uint64(10)], packed[at + np.uint64(11)],
    )  # fmt: skip
    rx, ry, rz, ro = (
        packed[at + np.uint64(12)], packed[at + np.uint64(13)], packed[at + np.uint64(14)], packed[at + np.uint64(15)],
    )  # fmt: skip
    for i in range(_LANES):
        x, y, z = state[i], state[i + _LANES], state[i + np.uint64(2) * _LANES]
        dx, dy, dz = (
            state[i + np.uint64(3) * _LANES],
            state[i + np.uint64(4) * _LANES],
            state[i + np.uint64(5) * _LANES],
        )
        begin, rise = nx * x + ny * y + nz * z - offset, nx * dx + ny * dy + nz * dz
        end = begin + rise
        meets = begin / (begin - end if abs(begin - end) > _TINY else _TINY)
        enters = (meets if end < begin else _TWO) if begin > _ZERO else _ZERO
        leaves = meets if begin <= _ZERO and end > _ZERO else _ONE
        state[i + np.uint64(6) * _LANES] = max(state[i + np.uint64(6) * _LANES], enters)
        state[i + np.uint64(7) * _LANES] = min(state[i + np.uint64(7) * _LANES], leaves)
        p, q, r = px * x + py * y + pz * z - po, qx * x + qy * y + qz * z - qo, rx * x + ry * y + rz * z - ro
        first = max(p, q, r)
        p, q, r = p + px * dx + py * dy + pz * dz, q + qx * dx + qy * dy + qz * dz, r + rx * dx + ry * dy + rz * dz
        second = max(p, q, r)
        one = begin * begin if begin > _ZERO and first < _SLACK else _FAR
        other = end * end if end > _ZERO and second < _SLACK else _FAR
        state[i + np.uint64(8) * _LANES] = min(state[i + np.uint64(8) * _LANES], one, other)


@inner_kernel
def lower_from_hulls(
    tiles: Floats32, rows: Floats32, packed: Floats32, pairs: Longs, count: int, squares: Floats32
) -> None:
    """Lower the squared distances of tiles to those from hulls, packed as `pack_hulls` does.

    The other arguments are as in `lower_from_boxes`.
    """
    state = np.empty(STATE, np.float32)
    for p in range(count):
        tile, least, row = np.uint64(pairs[p, 0]) * _TILE, np.uint64(pairs[p, 0]) * _LANES, pairs[p, 1] * ROW
        if not may_be_nearer(tiles, tile, rows, row, squares, least, state):
            continue
        for i in range(_LANES):
            state[i + np.uint64(8) * _LANES] = _FAR
        head = np.uint64(int(rows[row + 17])) * _LINE
        triangles, edges = int(packed[head]), int(packed[head + np.uint64(1)])
        at = head + _LINE
        for _ in range(triangles):
            _hold_against_triangle(packed, at, state)
            at += _LINE
        for _ in range(edges):
            hold_against_edge(packed, at, state)
            at += _EDGE
        for i in range(_LANES):
            inside = state[i + np.uint64(6) * _LANES] <= state[i + np.uint64(7) * _LANES]
            square = _ZERO if inside else state[i + np.uint64(8) * _LANES]
            squares[least + i] = min(squares[least + i], square)
