"""A tree of boxes round the triangles of a mesh, sixteen to a node and sixteen triangles to a leaf: a vector each.

For who asks about many capsules anywhere about a large mesh; what is near a walker already needs no tree.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import helper, inner_kernel
from elbowroom.world.obstacles.layout import LANES
from elbowroom.world.obstacles.meshes.clusters import clusters_of

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Ints = NDArray[np.int32]

NODE = 6 * LANES  # numbers of a node: the least and the greatest corner of each box below it
LEAF = 9 * LANES  # of a leaf: a corner of each triangle and two sides
_DEEP = 256  # nodes that may wait: enough for 16^8 leaves
_FAR = 1e6  # metres: where boxes and triangles are that are none
_LANES, _NODE, _LEAF = np.uint64(LANES), np.uint64(NODE), np.uint64(LEAF)
_ZERO: Any = np.float32(0.0)
_ONE: Any = np.float32(1.0)
_BIG: Any = np.float32(1e30)
_TINY: Any = np.float32(1e-20)
_STILL: Any = np.float32(1e-9)


class MeshTree(NamedTuple):
    """Nodes and leaves; the first node is the root. Metres, about an origin near the mesh."""

    boxes: Floats32  # (nodes * NODE,)
    below: Ints  # (nodes * LANES,) the nodes there, or the leaves: -1 for the first, -2, ...
    leaves: Floats32  # (leaves * LEAF,)


def mesh_tree(corners: Floats) -> MeshTree:
    """The tree of triangles (T, 3, 3)."""
    leaf = clusters_of(corners, np.zeros(len(corners), np.int64), LANES, LANES, np.inf)
    order = np.argsort(leaf, kind="stable")
    a, b, c = np.moveaxis(corners[order], 1, 0)
    many, place = int(leaf.max()) + 1, _rank(leaf[order])
    leaves = np.zeros((many, 9, LANES))
    leaves[:, :3] = _FAR
    leaves[leaf[order], :, place] = np.concatenate([a, b - a, c - a], axis=1)
    low, high = _bounds(corners.min(axis=1), corners.max(axis=1), leaf)
    return _nodes_over(low, high, leaves)


def _nodes_over(low: Floats, high: Floats, leaves: Floats) -> MeshTree:
    """Nodes over leaves in boxes from `low` to `high` (L, 3), level by level up to the root."""
    boxes: list[Floats] = []
    below: list[NDArray[np.int64]] = []
    number, count = -1 - np.arange(len(low)), 0
    while not boxes or len(low) > 1:
        parent = clusters_of(
            np.stack([low, 0.5 * (low + high), high], axis=1), np.zeros_like(number), LANES, LANES, 9e9
        )
        many, order = int(parent.max()) + 1, np.argsort(parent, kind="stable")
        place = _rank(parent[order])
        box, child = np.full((many, 6, LANES), _FAR), np.zeros((many, LANES), np.int64)
        box[parent[order], :, place] = np.concatenate([low, high], axis=1)[order]
        child[parent[order], place] = number[order]
        boxes.append(box)
        below.append(child)
        low, high = _bounds(low, high, parent)
        number = count + np.arange(many)
        count += many
    # The root comes first: levels from the top, numbers of nodes turned round.
    flat, children = np.concatenate(boxes)[::-1], np.concatenate(below)[::-1]
    children = np.where(children >= 0, count - 1 - children, children)
    children[flat[:, 0] == _FAR] = 0
    single = (part.astype(np.float32).ravel() for part in (flat, leaves))
    return MeshTree(next(single), np.ascontiguousarray(children, np.int32).ravel(), next(single))


def _rank(group: NDArray[np.int64]) -> NDArray[np.int64]:
    """The place of each within its group, of those that stand sorted."""
    counts = np.bincount(group)
    rank: NDArray[np.int64] = np.arange(len(group)) - np.repeat(np.cumsum(counts) - counts, counts)
    return rank


def _bounds(low: Floats, high: Floats, group: NDArray[np.int64]) -> tuple[Floats, Floats]:
    """The boxes round the boxes of each group."""
    order = np.argsort(group, kind="stable")
    starts = np.searchsorted(group[order], np.arange(int(group.max()) + 1))
    return np.minimum.reduceat(low[order], starts), np.maximum.reduceat(high[order], starts)


@helper
def _from_side(begin: Any, step: Any, dd: Any, side: Any) -> Any:
    """Squared distance of an axis, seen from where a side begins, from the side; `dd` is the step's square."""
    px, py, pz = begin
    dx, dy, dz = step
    ex, ey, ez = side
    ee, de = ex * ex + ey * ey + ez * ez, dx * ex + dy * ey + dz * ez
    er, dr = ex * px + ey * py + ez * pz, dx * px + dy * py + dz * pz
    per = _ONE / max(ee, _TINY)
    s = max(min((de * er - dr * ee) / max(dd * ee - de * de, _TINY), _ONE), _ZERO)
    t = max(min((de * s + er) * per, _ONE), _ZERO)
    s = max(min((de * t - dr) / max(dd, _TINY), _ONE), _ZERO)
    t = max(min((de * s + er) * per, _ONE), _ZERO)
    x, y, z = px + s * dx - t * ex, py + s * dy - t * ey, pz + s * dz - t * ez
    return x * x + y * y + z * z


@inner_kernel
def leaf_square(leaves: Floats32, leaf: int, axis: Floats32, squares: Floats32) -> Any:
    """The least squared distance of an axis (6,), begin and step, from the triangles of a leaf; `squares` (16,)."""
    at = np.uint64(leaf) * _LEAF
    own = leaves[at : at + _LEAF]
    x, y, z, dx, dy, dz = axis[0], axis[1], axis[2], axis[3], axis[4], axis[5]
    dd = dx * dx + dy * dy + dz * dz
    for i in range(_LANES):
        px, py, pz = x - own[i], y - own[i + _LANES], z - own[i + np.uint64(2) * _LANES]
        ux, uy, uz = (
            own[i + np.uint64(3) * _LANES], own[i + np.uint64(4) * _LANES], own[i + np.uint64(5) * _LANES],
        )  # fmt: skip
        vx, vy, vz = (
            own[i + np.uint64(6) * _LANES], own[i + np.uint64(7) * _LANES], own[i + np.uint64(8) * _LANES],
        )  # fmt: skip
        least = min(
            _from_side((px, py, pz), (dx, dy, dz), dd, (ux, uy, uz)),
            _from_side((px, py, pz), (dx, dy, dz), dd, (vx, vy, vz)),
            _from_side((px - ux, py - uy, pz - uz), (dx, dy, dz), dd, (vx - ux, vy - uy, vz - uz)),
        )
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        square = nx * nx + ny * ny + nz * nz
        per = _ONE / max(square, _TINY)
        fx, fy, fz = vy * nz - vz * ny, vz * nx - vx * nz, vx * ny - vy * nx
        gx, gy, gz = ny * uz - nz * uy, nz * ux - nx * uz, nx * uy - ny * ux
        height, rise = px * nx + py * ny + pz * nz, dx * nx + dy * ny + dz * nz
        f, df = (px * fx + py * fy + pz * fz) * per, (dx * fx + dy * fy + dz * fz) * per
        g, dg = (px * gx + py * gy + pz * gz) * per, (dx * gx + dy * gy + dz * gz) * per
        flat = _ZERO if square > _TINY else -_ONE
        over = min(f, g, _ONE - f - g, flat)
        after = min(f + df, g + dg, _ONE - f - df - g - dg, flat)
        end = height + rise
        t = -height / (rise if abs(rise) > _TINY else _TINY)
        through = min(f + t * df, g + t * dg, _ONE - f - g - t * (df + dg), t, _ONE - t, flat)
        first = height * height * per if over >= _ZERO else _BIG
        second = end * end * per if after >= _ZERO else _BIG
        squares[i] = _ZERO if through >= _ZERO else min(least, first, second)
    found = squares[0]
    for i in range(1, LANES):
        found = min(found, squares[i])
    return found


@inner_kernel
def _boxes_within(boxes: Floats32, node: int, axis: Floats32, reach: Any, gaps: Floats32) -> None:
    """Which boxes of a node an axis may come within reach of: negative `gaps` (16,)."""
    at = np.uint64(node) * _NODE
    own = boxes[at : at + _NODE]
    x, y, z = axis[0], axis[1], axis[2]
    ix = _ONE / (axis[3] if abs(axis[3]) > _STILL else _STILL)
    iy = _ONE / (axis[4] if abs(axis[4]) > _STILL else _STILL)
    iz = _ONE / (axis[5] if abs(axis[5]) > _STILL else _STILL)
    for i in range(_LANES):
        a, b = (own[i] - reach - x) * ix, (own[i + np.uint64(3) * _LANES] + reach - x) * ix
        first, last = max(min(a, b), _ZERO), min(max(a, b), _ONE)
        a, b = (own[i + _LANES] - reach - y) * iy, (own[i + np.uint64(4) * _LANES] + reach - y) * iy
        first, last = max(min(a, b), first), min(max(a, b), last)
        a, b = (own[i + np.uint64(2) * _LANES] - reach - z) * iz, (own[i + np.uint64(5) * _LANES] + reach - z) * iz
        gaps[i] = max(min(a, b), first) - min(max(a, b), last)


@inner_kernel
def within_reach(tree: MeshTree, axis: Floats32, reach: Any, waiting: Ints, lanes: Floats32) -> bool:
    """Whether an axis (6,), begin and step, comes within reach of a triangle; `waiting` (256,), `lanes` (16,)."""
    count, waiting[0] = 1, 0
    while count > 0:
        count -= 1
        node = waiting[count]
        if node < 0:
            if leaf_square(tree.leaves, -1 - node, axis, lanes) <= reach * reach:
                return True
            continue
        _boxes_within(tree.boxes, node, axis, reach, lanes)
        for i in range(LANES):
            if lanes[i] <= _ZERO and count < _DEEP:
                waiting[count] = tree.below[node * LANES + i]
                count += 1
    return False


@inner_kernel
def least_square(tree: MeshTree, axis: Floats32, most: Any, waiting: Ints, lanes: Floats32) -> Any:
    """The least squared distance of an axis (6,) from a triangle, `most` squared if none is nearer than `most`."""
    count, waiting[0], found = 1, 0, most * most
    while count > 0:
        count -= 1
        node = waiting[count]
        if node < 0:
            found = min(found, leaf_square(tree.leaves, -1 - node, axis, lanes))
            continue
        _boxes_within(tree.boxes, node, axis, np.sqrt(found), lanes)
        for i in range(LANES):
            if lanes[i] <= _ZERO and count < _DEEP:
                waiting[count] = tree.below[node * LANES + i]
                count += 1
    return found
