"""Squared distances of capsules' axes from triangle meshes, sixteen at a time.

A mesh is a surface and nothing more: both sides of a triangle count, and nothing has to be closed (`solids.py` sees to
what lies within a closed one). An axis that does not pierce a triangle is closest to it with one of its ends over it,
or somewhere along an edge; one that pierces it has distance 0.

Triangles lie packed in clusters of a few, each with a box round it. Tiles that this box shows to be farther than what
is known already pass the cluster by.
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
_FAR: Any = np.float32(1e30)
_TINY: Any = np.float32(1e-20)
_SLACK: Any = np.float32(3e-5)  # units of a tile, a micrometre: two triangles of one face leave no gap between them

Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]


@helper
def _hold_against_triangle(packed: Floats32, at: Any, state: Floats32) -> None:
    """How far the ends of sixteen axes are that lie over a triangle, on either side; 0 where the axis pierces it."""
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
        p, q, r = px * x + py * y + pz * z - po, qx * x + qy * y + qz * z - qo, rx * x + ry * y + rz * z - ro
        dp, dq, dr = px * dx + py * dy + pz * dz, qx * dx + qy * dy + qz * dz, rx * dx + ry * dy + rz * dz
        first, second = max(p, q, r), max(p + dp, q + dq, r + dr)
        t = begin / (begin - end if abs(begin - end) > _TINY else _TINY)
        through = max(p + t * dp, q + t * dq, r + t * dr)
        pierced = begin * end <= _ZERO and t >= _ZERO and t <= _ONE and through < _SLACK
        one = begin * begin if first < _SLACK else _FAR
        other = end * end if second < _SLACK else _FAR
        least = _ZERO if pierced else min(one, other)
        state[i + np.uint64(8) * _LANES] = min(state[i + np.uint64(8) * _LANES], least)


@helper
def _may_be_nearer(packed: Floats32, head: Any, state: Floats32, gaps: Floats32) -> bool:
    """Whether any of sixteen axes may be nearer to a cluster than what is known: as the boxes round both tell."""
    cx, cy, cz = packed[head + np.uint64(2)], packed[head + np.uint64(3)], packed[head + np.uint64(4)]
    hx, hy, hz = packed[head + np.uint64(5)], packed[head + np.uint64(6)], packed[head + np.uint64(7)]
    for i in range(_LANES):
        x, y, z = state[i] - cx, state[i + _LANES] - cy, state[i + np.uint64(2) * _LANES] - cz
        dx, dy, dz = (
            state[i + np.uint64(3) * _LANES],
            state[i + np.uint64(4) * _LANES],
            state[i + np.uint64(5) * _LANES],
        )
        u = max(min(x, x + dx) - hx, -hx - max(x, x + dx), _ZERO)
        v = max(min(y, y + dy) - hy, -hy - max(y, y + dy), _ZERO)
        w = max(min(z, z + dz) - hz, -hz - max(z, z + dz), _ZERO)
        gaps[i] = u * u + v * v + w * w - state[i + np.uint64(8) * _LANES]
    nearer = 0
    for i in range(_LANES):
        nearer += gaps[i] < _ZERO
    return nearer > 0


@inner_kernel
def lower_from_meshes(
    tiles: Floats32, rows: Floats32, packed: Floats32, pairs: Longs, count: int, squares: Floats32
) -> None:
    """Lower the squared distances of tiles to those from meshes, packed as `meshes.py` does.

    The other arguments are as in `lower_from_boxes`.
    """
    state, gaps = np.empty(STATE, np.float32), np.empty(LANES, np.float32)
    for p in range(count):
        tile, least, row = np.uint64(pairs[p, 0]) * _TILE, np.uint64(pairs[p, 0]) * _LANES, pairs[p, 1] * ROW
        if not may_be_nearer(tiles, tile, rows, row, squares, least, state):
            continue
        for i in range(_LANES):
            state[i + np.uint64(8) * _LANES] = squares[least + i]
        at = np.uint64(int(rows[row + 17])) * _LINE
        clusters = int(packed[at])
        at += _LINE
        for _ in range(clusters):
            triangles, edges = np.uint64(int(packed[at])), np.uint64(int(packed[at + np.uint64(1)]))
            nearer, at = _may_be_nearer(packed, at, state, gaps), at + _LINE
            if nearer:
                for k in range(triangles):
                    _hold_against_triangle(packed, at + k * _LINE, state)
                for k in range(edges):
                    hold_against_edge(packed, at + triangles * _LINE + k * _EDGE, state)
            at += (triangles + (edges + np.uint64(1)) // np.uint64(2)) * _LINE
        for i in range(_LANES):
            squares[least + i] = state[i + np.uint64(8) * _LANES]
