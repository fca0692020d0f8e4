"""What of a place lies within its closed solids, where nobody stands: undersides of blocks, floors inside them."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.world.obstacles.meshes.solids import enclosing_triangles
from elbowroom.world.obstacles.shapes import Mesh
from elbowroom.world.places.place import Place

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

_ABOVE = 0.05  # metres over a surface: what lies there tells whether it is inside


def solid_triangles(place: Place) -> Floats:
    """The triangles (T, 3, 3) of all closed solids that stand in a place, counter-clockwise seen from outside."""
    standing = (part for part in place.parts if part.stands and len(part.faces))
    found = [enclosing_triangles(Mesh(part.vertices, part.faces)) for part in standing]
    return np.concatenate([np.empty((0, 3, 3)), *found])


def enclosed(cells: Ints, heights: Floats, triangles: Floats, cell: float, shape: tuple[int, int]) -> Flags:
    """Which surfaces (S,), over cells of a grid and at heights, have the inside of a solid over them.

    `triangles` (T, 3, 3) are those of the solids, from the grid's corner on. Counted is how often they wind round a
    place over the cell's middle.
    """
    size = np.array([cell, 1.0, cell])
    count = _crossings(triangles / size, shape[0], shape[1], np.empty(0, np.int64), np.empty(0), np.empty(0))
    where, over, turns = np.empty(count, np.int64), np.empty(count), np.empty(count)
    _crossings(triangles / size, shape[0], shape[1], where, over, turns)
    order = np.lexsort((over, where))
    where, over = where[order], over[order]
    wound = np.append(0.0, np.cumsum(turns[order]))
    least = min(float(np.min(over, initial=0.0)), float(np.min(heights, initial=0.0)))
    tall = max(float(np.max(over, initial=0.0)), float(np.max(heights, initial=0.0))) - least + 1.0
    below = np.searchsorted(where * tall + over - least, cells * tall + heights + _ABOVE - least, side="right")
    first = np.searchsorted(where, cells)
    inside: Flags = wound[below] - wound[first] > 0.5
    return inside


@exact_kernel
def _crossings(triangles: Floats, width: int, depth: int, where: Ints, over: Floats, turns: Floats) -> int:
    """Where the upright lines through cells' middles pass triangles, as far as the arrays hold; how many there are.

    Lengths along x and z are in cells. Told are the cell, the height, and 1 where one comes in from below, -1 where one
    goes out. A line through a common edge passes one of its triangles.
    """
    count = 0
    for t in range(triangles.shape[0]):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        area = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2])
        if area == 0.0:
            continue
        low, high = min(a[0], b[0], c[0]), max(a[0], b[0], c[0])
        for ix in range(max(int(low - 0.5), 0), min(int(high + 0.5) + 1, width)):
            x, begin, end = ix + 0.5, np.inf, -np.inf
            for e in range(3):
                p, q = triangles[t, e], triangles[t, (e + 1) % 3]
                if (p[0] <= x) != (q[0] <= x):
                    z = _at(p, q, x) if p[0] < q[0] else _at(q, p, x)
                    begin, end = min(begin, z), max(end, z)
            if begin >= end:
                continue
            for iz in range(max(int(begin - 0.5), 0), min(int(end + 0.5) + 1, depth)):
                z = iz + 0.5
                if not begin <= z < end:
                    continue
                if count < where.shape[0]:
                    u = ((z - a[2]) * (c[0] - a[0]) - (x - a[0]) * (c[2] - a[2])) / area
                    v = ((b[2] - a[2]) * (x - a[0]) - (b[0] - a[0]) * (z - a[2])) / area
                    where[count] = ix * depth + iz
                    over[count] = a[1] + u * (b[1] - a[1]) + v * (c[1] - a[1])
                    turns[count] = -1.0 if area > 0.0 else 1.0
                count += 1
    return count


@exact_kernel
def _at(p: Floats, q: Floats, x: float) -> float:
    """z of an edge at x, the same to the bit for both of its triangles."""
    return float(p[2] + (x - p[0]) / (q[0] - p[0]) * (q[2] - p[2]))
