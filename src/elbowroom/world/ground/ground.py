"""The ground under feet, for kernels: how high it is at a place, and about a place.

Ground is the level plane at height 0 and every surface that is level enough to stand on, whatever it belongs to: floors
above one another, treads, ramps, sills, kerbs. So a place has many heights, and each question says near which height it
is meant: nothing is ground that lies more than a step from there. Surfaces are triangles, held exactly: the grid only
finds them. Where nothing but the plane can be reached by steps, the ground is plain and costs a look at a flag.

Gaps no wider than a foot is long are spanned (`gaps.py`): a body goes over them as over ground, but no foot stands
there.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference
from elbowroom.jit import brief_exact_kernel, exact_kernel, helper, inner_exact_kernel

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

STEP = 0.25  # metres: higher is climbed, not walked
STEEPEST = math.radians(30.0)  # of a surface that one walks on
PLACE = 0.1  # metres between places that a way over the ground is looked at
SPANS = 9  # a column of triangles
FIRM, SPANNED = 0.5, 1.5  # of what `SPANS` tells: ground alone, or gaps that are spanned too
_NEXT = np.uint64(1)
_NONE = -math.inf
RELIEF = 1e-3  # metres: what lies no lower than this under the highest ground about it is level
_ABOUT = 0.1  # metres by which a body's height may differ from the ground about it
_INSIDE = 1e-9  # m², by which a place may lie outside of a triangle
_EASED, _AROUND, _RINGS = 0.36, 10, 4  # metres about a body whose ground counts for its height; places there
_ANGLES = 2.0 * math.pi * (np.arange(_AROUND) + 0.5) / _AROUND
_ASIDE, _ONWARD = np.sin(_ANGLES), np.cos(_ANGLES)  # (_AROUND,) directions in which they lie
_SQUARES = 0.5 * _AROUND * _EASED**2 * (_RINGS + 1) * (2 * _RINGS + 1) / (6 * _RINGS)  # of how far these are along x
EVEN_STAIR = 0.65  # metres that a stair of the usual kind rises in a metre, at most
_LIFTED, _MOST_LIFTED = 0.3, 0.12  # metres that a body is carried higher where it is steeper by one in one; at most
_TREADS = 0.04  # metres that ground is uneven by where it is all treads
_CARRIED = 0.24  # of a step that a body is above the ground at its place, in the middle of what it may be


@by_reference
class Ground(NamedTuple):
    """Surfaces over the cells of a grid; `ground_of` a scene makes it. Metres."""

    plain: bool  # there is only the plane: the rest is not looked at
    step: float  # nothing farther up or down is reached
    corner: tuple[float, float]  # x, z of the grid
    cell: float
    shape: tuple[int, int]  # cells along x and z
    starts: Longs  # (cells + 1,) where the triangles over each cell, numbered ix * shape[1] + iz, begin
    members: Longs  # (M,) their numbers, the same several times; of each cell those first that begin higher there
    bottoms: Floats32  # (M,) how low they come in the cell, at least, and
    tops: Floats32  # (M,) how high they and all that follow them in the cell reach, at most
    triangles: Floats  # (T, 10), as `planes_of` has them
    level: Bools  # (cells,) where the plane at height 0 is ground
    beyond: bool  # whether it is, outside of the grid
    even_starts: Longs  # (cells + 1,) where the even heights of each cell begin
    evens: Floats  # (E,) tops of ground that is level all over a cell, with nothing up to a step above


PLAIN = Ground(
    True, STEP, (0.0, 0.0), 1.0, (0, 0), np.zeros(1, np.int64), np.zeros(0, np.int64), np.zeros(0, np.float32),
    np.zeros(0, np.float32), np.zeros((0, 10)), np.zeros(0, np.bool_), True, np.zeros(1, np.int64), np.zeros(0),
)  # fmt: skip


@helper
def _is_over(t: Floats, px: float, pz: float) -> bool:
    """Whether a place, seen from a triangle's first corner, is over it."""
    bx, bz, cx, cz = t[3] - t[0], t[4] - t[1], t[5] - t[0], t[6] - t[1]
    third = (cz - bz) * (px - bx) - (cx - bx) * (pz - bz)
    return bool(min(bz * px - bx * pz, cx * pz - cz * px, third) >= -_INSIDE)


@exact_kernel
def heights_at(ground: Ground, x: float, z: float, out: Floats) -> int:
    """Write all heights at which there is ground at a place, from the lowest up, as many as `out` holds; how many.

    Of those less than a step apart the highest. Spanned gaps are ground.
    """
    ix, iz = math.floor((x - ground.corner[0]) / ground.cell), math.floor((z - ground.corner[1]) / ground.cell)
    inside = not ground.plain and 0 <= ix < ground.shape[0] and 0 <= iz < ground.shape[1]
    cell, count = int(ix) * ground.shape[1] + int(iz) if inside else 0, 0
    if ground.level[cell] if inside else ground.beyond:
        out[0], count = 0.0, 1
    for m in range(ground.starts[cell], ground.starts[cell + 1] if inside else ground.starts[cell]):
        t = ground.triangles[ground.members[m]]
        px, pz = x - t[0], z - t[1]
        if count < out.shape[0] and _is_over(t, px, pz):
            out[count] = t[2] + t[7] * px + t[8] * pz
            count += 1
    out[:count].sort()
    kept = 0
    for i in range(count):
        if i + 1 == count or out[i + 1] - out[i] > ground.step:
            out[kept] = out[i]
            kept += 1
    return kept


@helper
def first_within(bottoms: Floats32, first: Any, last: Any, high: float) -> Any:
    """The first of a cell's parts, those from `first` on and before `last`, that begins no higher than `high`."""
    m, above = first, last
    while m < above:
        middle = (m + above) >> _NEXT
        if bottoms[middle] > high:
            m = middle + _NEXT
        else:
            above = middle
    return m


@helper
def _highest(ground: Ground, x: float, z: float, near: float, kinds: float) -> float:
    """The highest ground at a place that is no more than a step from the height `near`; minus infinity without any.

    It has one way out: with more Numba counts who holds the arrays of `ground`, which takes longer than all else.
    """
    ix, iz = math.floor((x - ground.corner[0]) / ground.cell), math.floor((z - ground.corner[1]) / ground.cell)
    inside = 0 <= ix < ground.shape[0] and 0 <= iz < ground.shape[1] and not ground.plain
    cell = np.uint64(int(ix) * ground.shape[1] + int(iz) if inside else 0)
    there, low, high = ground.level[cell] if inside else ground.beyond, near - ground.step, near + ground.step
    best = 0.0 if ground.plain or (there and low <= 0.0 <= high) else _NONE
    m, last = np.uint64(ground.starts[cell]), np.uint64(ground.starts[cell + _NEXT] if inside else ground.starts[cell])
    m = first_within(ground.bottoms, m, last, high)
    while m < last and ground.tops[m] > max(best, low - _INSIDE):
        t = np.uint64(ground.members[m])
        m += _NEXT
        if ground.triangles[t, SPANS] < kinds:
            px, pz = x - ground.triangles[t, 0], z - ground.triangles[t, 1]
            height = ground.triangles[t, 2] + ground.triangles[t, 7] * px + ground.triangles[t, 8] * pz
            if best < height and low <= height <= high and _is_over(ground.triangles[t], px, pz):
                best = height
    return best


@exact_kernel
def height_at(ground: Ground, x: float, z: float, near: float) -> float:
    """The highest ground at a place that is no more than a step from the height `near`; minus infinity without any.

    Gaps that are spanned are ground.
    """
    return _highest(ground, x, z, near, SPANNED)


@exact_kernel
def firm_at(ground: Ground, x: float, z: float, near: float) -> float:
    """The same of ground that feet can stand on: gaps that are spanned are none."""
    return _highest(ground, x, z, near, FIRM)


@helper
def _even_in(ground: Ground, ix: int, iz: int, about: float, within: float) -> float:
    """The even height of a cell that is so near to another one; minus infinity without any."""
    found = _NONE
    if 0 <= ix < ground.shape[0] and 0 <= iz < ground.shape[1]:
        cell = ix * ground.shape[1] + iz
        for e in range(ground.even_starts[cell], ground.even_starts[cell + 1]):
            if abs(ground.evens[e] - about) <= within:
                found = ground.evens[e]
    elif ground.beyond and abs(about) <= within:
        found = 0.0
    return found


@inner_exact_kernel
def level_over(
    ground: Ground, place: tuple[float, float], course: float, half: tuple[float, float], near: float
) -> float:
    """The top of the ground if it is level in a rectangle about a place (x, z), about the height `near`.

    It lies along a course, which is a yaw, and is twice `half` as long and as wide. Ground may lie lower by `RELIEF` in
    a cell, and by so much more from cell to cell. Minus infinity where it is not level, or that is not known.
    """
    sine, cosine, (along, across) = math.sin(course), math.cos(course), half
    x, z, spare = place[0] - ground.corner[0], place[1] - ground.corner[1], abs(sine) + abs(cosine)
    wide, deep = along * abs(sine) + across * abs(cosine), along * abs(cosine) + across * abs(sine)
    along, across = along + 0.5 * ground.cell * spare, across + 0.5 * ground.cell * spare
    found, lowest = _NONE, math.inf
    for ix in range(math.floor((x - wide) / ground.cell), math.floor((x + wide) / ground.cell) + 1):
        for iz in range(math.floor((z - deep) / ground.cell), math.floor((z + deep) / ground.cell) + 1):
            dx, dz = ground.cell * (ix + 0.5) - x, ground.cell * (iz + 0.5) - z
            if abs(dx * sine + dz * cosine) <= along and abs(dx * cosine - dz * sine) <= across:
                within = RELIEF if found > _NONE else _ABOUT
                here = _even_in(ground, ix, iz, near if found == _NONE else found, within)
                lowest, found = min(lowest, here), max(found, here)
                if found - lowest > RELIEF or here == _NONE:
                    return _NONE
    return found


@exact_kernel
def level_about(ground: Ground, x: float, z: float, reach: float, near: float) -> float:
    """The same as far as `reach` metres from a place along x and z."""
    return level_over(ground, (x, z), 0.0, (reach, reach), near)


@exact_kernel
def under_body(ground: Ground, x: float, height: float, z: float) -> float:
    """The ground under a body that is carried at a height (`eased_height`); that height where there is none."""
    found = height_at(ground, x, z, height - _CARRIED * ground.step)
    return found if found > _NONE else height


@exact_kernel
def height_along(ground: Ground, start: tuple[float, float, float], x: float, z: float) -> float:
    """The ground at a place as one comes to it from `start` (x, height, z), step by step; minus infinity without any.

    Where there is none on the way, the last height is kept.
    """
    if ground.plain:
        return 0.0
    dx, dz, near = x - start[0], z - start[2], start[1]
    count, found = math.ceil(math.sqrt(dx * dx + dz * dz) / PLACE) + 1, near
    for i in range(1, count + 1):
        share = i / count
        found = height_at(ground, start[0] + share * dx, start[2] + share * dz, near)
        if found > _NONE:
            near = found
    return found


@brief_exact_kernel
def eased_height(ground: Ground, start: tuple[float, float, float], x: float, z: float) -> float:
    """How high a body is that walks there from `start` (x, height, z): the mean of the ground about the place.

    On treads steeper than an even stair's it is higher: soles lie on the highest that they are over, and legs that
    stand are to be as straight as on the plane, or shins come into the next treads. Minus infinity where there is no
    ground. What is not reached step by step from the middle counts as what is before it.
    """
    if ground.plain:
        return 0.0
    reach = _EASED + max(abs(x - start[0]), abs(z - start[2]))
    level = level_about(ground, x, z, reach, start[1])
    if level > _NONE:
        return level
    middle = height_along(ground, (start[0], under_body(ground, start[0], start[1], start[2]), start[2]), x, z)
    total, squares, along_x, along_z = 0.0, 0.0, 0.0, 0.0
    for i in range(_AROUND):
        near = middle
        for j in range(_RINGS):
            away = _EASED * (j + 1.0) / _RINGS
            dx, dz = away * _ASIDE[i], away * _ONWARD[i]
            found = height_at(ground, x + dx, z + dz, near)
            if found > _NONE:
                near = found
            above = near - middle
            total, squares = total + above, squares + above * above
            along_x, along_z = along_x + dx * above, along_z + dz * above
    if middle == _NONE:
        return middle
    count = 1.0 + _AROUND * _RINGS
    mean, steep = total / count, math.hypot(along_x, along_z) / _SQUARES
    uneven = math.sqrt(max(squares / count - mean * mean - steep * steep * _SQUARES / count, 0.0))
    lifted = min(_LIFTED * max(steep - EVEN_STAIR, 0.0), _MOST_LIFTED)
    return middle + mean + lifted * min(uneven / _TREADS, 1.0)


@inner_exact_kernel
def top_about(ground: Ground, x: float, height: float, z: float, radius: float) -> float:
    """The highest ground as far as `radius` metres about a place, as one comes to it from there step by step."""
    top = height
    if ground.plain or level_about(ground, x, z, radius, height) > _NONE:
        return top
    for i in range(_AROUND):
        near = height
        for j in range(_RINGS):
            away = radius * (j + 1.0) / _RINGS
            found = height_at(ground, x + away * _ASIDE[i], z + away * _ONWARD[i], near)
            if found > _NONE:
                near = found
            top = max(top, near)
    return top


@exact_kernel
def tops_about(ground: Ground, heights: Floats, places: Floats, radius: float) -> Floats:
    """The highest ground (N,) about places (N, 2) at `heights` (N,), as `top_about` has it."""
    out = np.empty(places.shape[0])
    for n in range(places.shape[0]):
        out[n] = top_about(ground, places[n, 0], heights[n], places[n, 1], radius)
    return out


@exact_kernel
def heights_along(ground: Ground, height: float, places: Floats) -> Floats:
    """The ground at places (N, 2), x and z, as one comes to each from the one before.

    At the first a body is at a `height`. Minus infinity where there is none; from there one comes at the height before.
    """
    out, x, z = np.empty(places.shape[0]), places[0, 0], places[0, 1]
    near = 0.0 if ground.plain else under_body(ground, x, height, z)
    for n in range(places.shape[0]):
        out[n] = height_along(ground, (x, near, z), places[n, 0], places[n, 1])
        if out[n] > _NONE:
            near = out[n]
        x, z = places[n, 0], places[n, 1]
    return out


@exact_kernel
def heights_beside(ground: Ground, height: float, first: int, places: Floats) -> Floats:
    """The ground (rows, columns) at places (rows, columns, 2), as one comes to each from the one before.

    One begins in the middle of the row `first`, where a body is at a `height`, goes along the middle to the other
    rows, and from there aside. Minus infinity where there is none; from there one comes at the height before.
    """
    rows, columns = places.shape[0], places.shape[1]
    out, middle = np.zeros((rows, columns)), columns // 2
    if ground.plain:
        return out
    begin = under_body(ground, places[first, middle, 0], height, places[first, middle, 1])
    for along in (1, -1):
        near, i = begin, first
        while 0 <= i < rows:
            out[i, middle] = height_at(ground, places[i, middle, 0], places[i, middle, 1], near)
            near = out[i, middle] if out[i, middle] > _NONE else near
            for aside in (1, -1):
                beside, j = near, middle + aside
                while 0 <= j < columns:
                    out[i, j] = height_at(ground, places[i, j, 0], places[i, j, 1], beside)
                    beside = out[i, j] if out[i, j] > _NONE else beside
                    j += aside
            i += along
    return out
