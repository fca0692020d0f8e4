"""Whether capsules touch a large mesh, for many of them anywhere about it: exact, and mostly without a triangle.

Cells of a grid know how far their middles are from the surface, or at least are. The distance from a surface changes by
no more than one moves: so a cell's number, less the way from its middle, is a bound for every point in it. Along an
axis one strides from bound to bound. Where a stride ends and nothing is proven the tree of triangles is asked.

No bound is a guess: what is said to be free is free.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.ndimage import distance_transform_edt

from elbowroom.jit import exact_kernel, helper, kernel
from elbowroom.world.obstacles.meshes.mesh_tree import MeshTree, least_square, mesh_tree, within_reach
from elbowroom.world.obstacles.shapes import Mesh

Ints = NDArray[np.int32]
Bools = NDArray[np.bool_]
Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_CELL = 0.0125  # metres
_CELLS = 8_000_000  # where there would be more they are larger: 32 MB
_AROUND = 0.3  # metres of grid beyond the mesh
_EXACT = 0.12  # metres from the surface to which cells know more than a bound
_ROUNDING = np.float32(4e-6)  # metres: by so much capsules are taken to be thicker
_THICKER = np.float32(2.0) * _ROUNDING
_BLOCK = 512  # axes
_WIDE = np.uint64(_BLOCK)
_AY, _AZ, _BX, _BY, _BZ, _AT, _ROOM = (np.uint64(k * _BLOCK) for k in range(1, 8))  # where rows of a block begin
_TOGETHER = 6  # strides of all axes of a block, a vector each
_STRIDES = 32  # along one axis, before the tree is asked
_ZERO: Any = np.float32(0.0)
_ONE: Any = np.float32(1.0)
_HALF: Any = np.float32(0.5)
_TWO: Any = np.float32(2.0)
_STILL: Any = np.float32(1e-9)
_HALF_DIAGONAL: Any = np.float32(0.5 * np.sqrt(3.0) + 1e-6)


class _Grid(NamedTuple):
    low: Floats32  # (3,) metres, where the first cell begins
    cell: Any  # metres
    per_cell: Any
    distances: Floats32  # (X, Y, Z) metres of the middles from the surface, or less


class Touching:
    """What touches a mesh; frozen once made, threads may share it. Rounding stays below 4 µm in a mesh of 20 m."""

    def __init__(self, mesh: Mesh) -> None:
        """Cells and tree about the middle of the mesh, in its own axes: a few seconds for 100,000 triangles."""
        self._middle = mesh.middle
        corners = mesh.corners - mesh.middle
        self._tree = mesh_tree(corners)
        self._grid = _grid(corners, mesh.half, self._tree)

    def touches(self, segments: ArrayLike, radii: ArrayLike) -> Bools:
        """Whether capsules touch the surface, (C, N): axes (C, 6, N), `radii` (C,), metres, in the mesh's axes."""
        axes = np.asarray(segments, np.float64) - np.tile(self._middle, 2)[:, None]
        return self.touches_about_middle(axes.astype(np.float32), np.ascontiguousarray(radii, np.float32))

    def touches_about_middle(self, segments: Floats32, radii: Floats32) -> Bools:
        """The same, of axes as seen from the middle of the mesh: without a copy."""
        out = np.empty((segments.shape[0], segments.shape[2]), np.bool_)
        _touches(self._grid, self._tree, segments, radii, out)
        return out

    def touches_a_triangle(self, segments: Floats32, radii: Floats32) -> Bools:
        """The same by the tree alone."""
        out = np.empty((segments.shape[0], segments.shape[2]), np.bool_)
        _touches_a_triangle(self._tree, segments, radii, out)
        return out


def _grid(corners: Floats, half: Floats, tree: MeshTree) -> _Grid:
    """The cells round triangles (T, 3, 3) about the middle of a box with half lengths (3,)."""
    size = 2.0 * (half + _AROUND)
    cell = max(_CELL, float(np.cbrt(size.prod() / _CELLS)))
    shape = np.ceil(size / cell).astype(np.int64)
    low: Floats = -0.5 * cell * shape.astype(np.float64)
    met = np.zeros(shape, np.bool_)
    _meet(np.ascontiguousarray(corners), low, cell, met)
    # A point of the surface is within half a diagonal of the middle of a cell that it meets.
    bound = distance_transform_edt(~met) * cell - 0.5 * np.sqrt(3.0) * cell
    distances = np.maximum(bound, 0.0).astype(np.float32)
    grid = _Grid(low.astype(np.float32), np.float32(cell), np.float32(1.0 / cell), distances)
    _refine(grid, tree)
    return grid


@exact_kernel
def _meet(corners: Floats, low: Floats, cell: float, met: Bools) -> None:
    """Note the cells that triangles may meet: by the box round each, and by its plane."""
    first, last = np.empty(3, np.int64), np.empty(3, np.int64)
    for t in range(corners.shape[0]):
        own = corners[t]
        for i in range(3):
            least, most = min(own[0, i], own[1, i], own[2, i]), max(own[0, i], own[1, i], own[2, i])
            first[i] = max(int(np.floor((least - low[i]) / cell - 1e-6)), 0)
            last[i] = min(int(np.floor((most - low[i]) / cell + 1e-6)), met.shape[i] - 1)
        normal = np.cross(own[1] - own[0], own[2] - own[0])
        reach = 0.5 * (abs(normal[0]) + abs(normal[1]) + abs(normal[2])) * cell * (1.0 + 1e-6) + 1e-12
        for i in range(first[0], last[0] + 1):
            for j in range(first[1], last[1] + 1):
                for k in range(first[2], last[2] + 1):
                    x = low[0] + (i + 0.5) * cell - own[0, 0]
                    y = low[1] + (j + 0.5) * cell - own[0, 1]
                    z = low[2] + (k + 0.5) * cell - own[0, 2]
                    if abs(normal[0] * x + normal[1] * y + normal[2] * z) <= reach:
                        met[i, j, k] = True


@kernel
def _refine(grid: _Grid, tree: MeshTree) -> None:
    """Have the cells near the surface know how far it is."""
    axis, waiting, lanes = np.zeros(6, np.float32), np.empty(256, np.int32), np.empty(16, np.float32)
    x, y, z = grid.distances.shape
    for i in range(x):
        for j in range(y):
            for k in range(z):
                if grid.distances[i, j, k] < _EXACT:
                    axis[0] = grid.low[0] + (np.float32(i) + _HALF) * grid.cell
                    axis[1] = grid.low[1] + (np.float32(j) + _HALF) * grid.cell
                    axis[2] = grid.low[2] + (np.float32(k) + _HALF) * grid.cell
                    most = grid.distances[i, j, k] + np.float32(2.0) * grid.cell
                    found = np.sqrt(least_square(tree, axis, most, waiting, lanes))
                    while found >= most:  # the cell only seemed to be met
                        most *= np.float32(4.0)
                        found = np.sqrt(least_square(tree, axis, most, waiting, lanes))
                    grid.distances[i, j, k] = found


@kernel
def _touches(grid: _Grid, tree: MeshTree, segments: Floats32, radii: Floats32, out: Bools) -> None:
    axis, waiting, lanes = np.empty(6, np.float32), np.empty(256, np.int32), np.empty(16, np.float32)
    block, cells = np.empty(8 * _BLOCK, np.float32), np.empty(_BLOCK, np.int32)
    flat = grid.distances.reshape(grid.distances.size)
    for c in range(segments.shape[0]):
        reach = radii[c] + _ROUNDING
        for start in range(0, segments.shape[2], _BLOCK):
            count = min(_BLOCK, segments.shape[2] - start)
            for k in range(6):
                for n in range(_BLOCK):
                    block[k * _BLOCK + n] = segments[c, k, start + min(n, count - 1)]
            _stride_together(grid, flat, block, cells, reach)
            for n in range(count):
                at = block[6 * _BLOCK + n]
                if at > _ONE:
                    out[c, start + n] = False
                    continue
                for i in range(3):
                    axis[i] = segments[c, i, start + n]
                    axis[i + 3] = segments[c, i + 3, start + n] - segments[c, i, start + n]
                found = _stride(grid, flat, axis, reach, at)
                out[c, start + n] = found > 0 if found != 0 else within_reach(tree, axis, reach, waiting, lanes)


@kernel
def _touches_a_triangle(tree: MeshTree, segments: Floats32, radii: Floats32, out: Bools) -> None:
    axis, waiting, lanes = np.empty(6, np.float32), np.empty(256, np.int32), np.empty(16, np.float32)
    for c in range(segments.shape[0]):
        for n in range(segments.shape[2]):
            for i in range(3):
                axis[i] = segments[c, i, n]
                axis[i + 3] = segments[c, i + 3, n] - segments[c, i, n]
            out[c, n] = within_reach(tree, axis, radii[c], waiting, lanes)


@helper
def _stride_together(grid: _Grid, flat: Floats32, block: Floats32, cells: Ints, reach: Any) -> None:
    """How far along each of a block's axes it is proven to be out of reach, up to a few strides; beyond 1 to its end.

    `block` (8 * _BLOCK,) holds axes, the answer, and scratch; `cells` (_BLOCK,) is scratch.
    """
    most_x, most_y = np.float32(grid.distances.shape[0] - 1), np.float32(grid.distances.shape[1] - 1)
    most_z, strip = np.float32(grid.distances.shape[2] - 1), np.int32(grid.distances.shape[2])
    slab = np.int32(grid.distances.shape[1] * grid.distances.shape[2])
    low_x, low_y, low_z, per_cell = grid.low[0], grid.low[1], grid.low[2], grid.per_cell
    margin = _HALF_DIAGONAL * grid.cell + reach
    for i in range(_WIDE):
        block[_AT + i] = _ZERO
    for _ in range(_TOGETHER):
        for i in range(_WIDE):
            t, ax, ay, az = min(block[_AT + i], _ONE), block[i], block[_AY + i], block[_AZ + i]
            x = max(min((ax + t * (block[_BX + i] - ax) - low_x) * per_cell, most_x), _ZERO)
            y = max(min((ay + t * (block[_BY + i] - ay) - low_y) * per_cell, most_y), _ZERO)
            z = max(min((az + t * (block[_BZ + i] - az) - low_z) * per_cell, most_z), _ZERO)
            cells[i] = np.int32(x) * slab + np.int32(y) * strip + np.int32(z)
        for i in range(_WIDE):
            block[_ROOM + i] = flat[np.uint64(cells[i])]
        for i in range(_WIDE):
            dx, dy, dz = block[_BX + i] - block[i], block[_BY + i] - block[_AY + i], block[_BZ + i] - block[_AZ + i]
            room, t = max(block[_ROOM + i] - margin, _ZERO), block[_AT + i]
            step = room / (math.sqrt(dx * dx + dy * dy + dz * dz) + _STILL)
            # At the end with room to spare: proven. Before it: on, but not past the end, which must be looked at.
            block[_AT + i] = _TWO if t >= _ONE and (room > _ZERO or t > _ONE) else min(t + step, _ONE)


@helper
def _stride(grid: _Grid, flat: Floats32, axis: Floats32, reach: Any, begin: Any) -> int:
    """-1 where an axis is proven to be out of reach of the surface, 1 where it is proven to be within, else 0.

    It is known to be out of reach up to `begin`. Where nothing is proven `axis` becomes the part that may be in reach.
    """
    sx, sy, sz = grid.distances.shape
    per_length = _ONE / (np.sqrt(axis[3] * axis[3] + axis[4] * axis[4] + axis[5] * axis[5]) + _STILL)
    t, first, last = min(begin, _ONE), _TWO, _ZERO
    for _ in range(_STRIDES):
        x = (axis[0] + t * axis[3] - grid.low[0]) * grid.per_cell
        y = (axis[1] + t * axis[4] - grid.low[1]) * grid.per_cell
        z = (axis[2] + t * axis[5] - grid.low[2]) * grid.per_cell
        i = int(min(max(x, _ZERO), np.float32(sx - 1)))
        j = int(min(max(y, _ZERO), np.float32(sy - 1)))
        k = int(min(max(z, _ZERO), np.float32(sz - 1)))
        x, y, z = x - np.float32(i) - _HALF, y - np.float32(j) - _HALF, z - np.float32(k) - _HALF
        off, distance = np.sqrt(x * x + y * y + z * z) * grid.cell, flat[(i * sy + j) * sz + k]
        room = distance - off - reach
        ahead = min(t + max(room, _HALF * grid.cell) * per_length, _ONE)
        if room <= _ZERO:
            if distance < _EXACT and distance + off < reach - _THICKER:
                return 1
            first, last = min(first, t), ahead
        if t >= _ONE:
            break
        t = ahead
    if t >= _ONE and first > _ONE:
        return -1
    last = _ONE if t < _ONE else last
    first = min(first, t)
    for n in range(3):
        axis[n] += first * axis[n + 3]
        axis[n + 3] *= last - first
    return 0
