"""A place as columns over a grid on the ground: at which heights there is a surface, and whether it is level."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.jit import exact_kernel, helper, inner_exact_kernel, plain
from elbowroom.world.clipping import clipped
from elbowroom.world.places.enclosed import enclosed, solid_triangles
from elbowroom.world.places.place import Place

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

FINEST_CELL = 0.05  # metres
_MOST_CELLS = 400_000
_X, _Z, _CORNERS = plain(0), plain(2), plain(3)  # axes over the ground, and what a triangle has
_LEVEL = 0.85  # of a normal's upright part: what is less level (32 degrees) is no floor
_STEP = 0.01  # metres between heights that are told apart
_HEIGHT_BITS = 21  # of a height in steps
_HEIGHTS = 2**_HEIGHT_BITS - 1
_AT_ONCE = 20_000  # triangles
_MOST_SURFACES = 30_000_000


@dataclass(frozen=True, eq=False)
class Columns:
    """S surfaces over the cells of a grid, ordered by cell and then by height: what lies in that cell."""

    origin: tuple[float, float]  # x, z of the grid's corner, metres
    cell: float  # metres
    shape: tuple[int, int]  # cells along x and z
    cells: Ints  # (S,) ix * shape[1] + iz
    low: Floats  # (S,) metres: from here
    high: Floats  # (S,) to here; the same where one could stand on it
    level: Flags  # (S,) whether one could
    inside: Flags  # (S,) whether a closed solid goes on over it: nobody is there

    def grid(self, chosen: Flags) -> Flags:
        """The cells (nx, nz) that any of the chosen surfaces (S,) lies over."""
        found = np.zeros(self.shape[0] * self.shape[1], bool)
        found[self.cells[chosen]] = True
        return found.reshape(self.shape)

    def middle(self, ix: float, iz: float) -> tuple[float, float]:
        """The place (x, z) of a cell's middle."""
        return self.origin[0] + (ix + 0.5) * self.cell, self.origin[1] + (iz + 0.5) * self.cell


def columns_of(place: Place, progress: Callable[[float], None] = lambda _share: None) -> Columns:
    """Cut a place's triangles at the cells' borders; raises `InputError` if they are too many."""
    least, most = place.bounds
    wide, deep = float(most[0] - least[0]), float(most[2] - least[2])
    cell = max(FINEST_CELL, float(np.sqrt(wide * deep / _MOST_CELLS)), (wide + deep) / _MOST_CELLS)
    shape = (int(wide / cell) + 1, int(deep / cell) + 1)
    standing = [part for part in place.parts if part.stands]
    triangles = np.concatenate([np.empty((0, 3, 3)), *(part.vertices[part.faces] for part in standing)])
    triangles = np.unique(triangles.reshape(-1, 9), axis=0).reshape(-1, 3, 3)  # copies of a thing in one place are one
    found, count = [np.empty(0, np.int64)], 0
    for start in range(0, len(triangles), _AT_ONCE):
        progress(start / len(triangles))
        keys = surface_keys(triangles[start : start + _AT_ONCE] - least, cell, shape)
        count += _MOST_SURFACES + 1 if keys is None else len(keys)
        if keys is None or count > _MOST_SURFACES:
            raise InputError(f"{place.name}: has too much surface to be looked over; is its unit right (--scale)?")
        found.append(keys)
    keys = _distinct(np.concatenate(found))
    cells, low, above = keys >> 2 * _HEIGHT_BITS + 1, (keys >> _HEIGHT_BITS + 1) & _HEIGHTS, (keys >> 1) & _HEIGHTS
    base = float(least[1])
    inside = enclosed(cells, low * _STEP, solid_triangles(place) - least, cell, shape)
    return Columns(
        origin=(float(least[0]), float(least[2])),
        cell=cell,
        shape=shape,
        cells=cells,
        low=base + low * _STEP,
        high=base + (low + above) * _STEP,
        level=(keys & 1) > 0,
        inside=inside,
    )


def surface_keys(triangles: Floats, cell: float, shape: tuple[int, int], most: int = _MOST_SURFACES) -> Ints | None:
    """What triangles (T, 3, 3) put over cells, each as one number: cell, lowest step, steps above it, whether level.

    None if they put more than `most` there.
    """
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    size = np.sqrt(np.einsum("ti,ti->t", normals, normals))
    level = (np.abs(normals[:, 1]) >= _LEVEL * size) & (size > 0.0)
    scale = np.array([cell, _STEP, cell])
    count = _fill(triangles / scale, level, *shape, most, np.empty(0, np.int64))
    if count > most:
        return None
    out = np.empty(count, np.int64)
    _fill(triangles / scale, level, *shape, most, out)
    return _distinct(out)


def _distinct(numbers: Ints) -> Ints:
    """Each number once, increasing; NumPy's own takes several times as long for so many."""
    ordered = np.sort(numbers)
    return ordered[np.append(True, np.diff(ordered) > 0)] if len(ordered) else ordered


@exact_kernel
def _fill(triangles: Floats, level: Flags, width: int, depth: int, most: int, out: Ints) -> int:
    """Write the numbers of `surface_keys` for triangles in cells and steps, as far as `out` holds; how many.

    It ends soon after `most`.
    """
    count = 0
    strip, piece, part = np.empty((9, 3)), np.empty((9, 3)), np.empty((9, 3))
    for t in range(len(triangles)):
        triangle = triangles[t]
        first, last = _range_of(triangle, _CORNERS, _X, width)
        for ix in range(first, last + 1):
            corners = clipped(triangle, _CORNERS, _X, float(ix), 1.0, part)
            corners = clipped(part, corners, _X, float(ix + 1), -1.0, strip)
            if corners == 0:
                continue
            low_z, high_z = _range_of(strip, corners, _Z, depth)
            for iz in range(low_z, high_z + 1):
                left = clipped(strip, corners, _Z, float(iz), 1.0, part)
                left = clipped(part, left, _Z, float(iz + 1), -1.0, piece)
                if left == 0:
                    continue
                if count < len(out):
                    out[count] = _number(piece[:left, 1], ix * depth + iz, level[t])
                count += 1
            if count > most:
                return count
    return count


@inner_exact_kernel
def _range_of(points: Floats, count: int, axis: int, cells: int) -> tuple[int, int]:
    """The first and the last cell along an axis that `count` points reach into."""
    least, most = points[0, axis], points[0, axis]
    for i in range(1, count):
        least, most = min(least, points[i, axis]), max(most, points[i, axis])
    return max(0, min(cells - 1, int(least))), max(0, min(cells - 1, int(most)))


@helper
def _number(heights: Floats, cell: int, level: bool) -> int:
    """A cell, and the heights over it, as one number."""
    least, most = heights[0], heights[0]
    for height in heights[1:]:
        least, most = min(least, height), max(most, height)
    low, above = round(least), 0
    if level:
        low = round(0.5 * (least + most))
    else:
        above = round(most) - low
    number: int = (((cell << _HEIGHT_BITS) + low << _HEIGHT_BITS) + above << 1) + (1 if level else 0)
    return number
