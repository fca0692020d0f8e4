"""Squared distances of capsules' axes from oriented boxes, sixteen at a time: the innermost loop of all planning.

A tile is one capsule in sixteen configurations, seven rows of sixteen: ax, ay, az, bx, by, bz, radius. Which tile is
held against which box is a list of pairs, so that a kernel may leave out the pairs that it knows to be far apart and
still enter the loop once. Everything is flat, with distances known to the compiler: then it needs no proof that the
rows do not overlap, and sixteen lanes become one instruction where vectors are that wide, a few where they are not.

The distance. In the axes of a box f(t) = |q(t) - clamp(q(t))|^2 along the axis q(t) = t d - n is convex. Coordinate i
is between its faces while t is in [in_i, out_i], and half the derivative of f is the sum of d_i^2 (t - clamp(t, in_i,
out_i)): f is least where each coordinate pulls t into its own span with the weight d_i^2. Let t be where only two pull,
the span that ends first and the one that begins last. If these two overlap then so do all three, and any t between the
two is within all. If not, then t lies before the one and after the other, and for the third coordinate the minimum is
on the same side as t: either t is in its span, or it pulls t towards its nearer end, but no farther than there. So the
weighted mean of t clamped to each span is the minimum on the whole line; for the axis it is clamped to [0, 1]. No
branch, no search; two divisions.

A coordinate that the axis does not move along has no span. Its weight is a tiny number instead, and its span one place;
this moves no point of the axis by as much as rounding does. Instead of t, its product with the three weights is
handled, which saves three divisions. Lengths are in parts of a metre such that products of four weights keep within
single precision for steps from a micrometre to a kilometre.

Spheres and capsules are boxes with rounded edges: a box without any size, or without width and depth, and a radius to
every side. Their distance is that from the box less the radius.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import helper, inner_kernel, kernel
from elbowroom.world.obstacles.layout import LANES, ROW, TILE

_LANES, _TILE = np.uint64(LANES), np.uint64(TILE)
_ZERO: Any = np.float32(0.0)  # single precision on purpose: a bare 0.0 would widen the whole loop
_ONE: Any = np.float32(1.0)
_TINY: Any = np.float32(1e-9)

Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]
Span = tuple[float, float]
Vector = tuple[float, float, float]
Matrix = tuple[float, float, float, float, float, float, float, float, float]


@helper
def _beyond(x: Any, h: Any) -> Any:
    """How far a coordinate lies beyond the faces at -h and h; 0 between them."""
    return x - max(min(x, h), -h)


@helper
def _span(n: Any, d: Any, h: Any, factor: Any) -> Span:
    """The least and the greatest t, times d * factor, at which t d - n is between -h and h."""
    along = d * factor
    middle, reach = n * along, h * abs(along)
    return middle - reach, middle + reach


@helper
def _squared_distance(n: Vector, d: Vector, h: Vector) -> Any:
    """Squared distance of the axis t d - n, t in [0, 1], from the box |x| <= h in its own axes."""
    u, v, w = d[0] * d[0] + _TINY, d[1] * d[1] + _TINY, d[2] * d[2] + _TINY
    uv = u * v
    in_x, out_x = _span(n[0], d[0], h[0], v * w)
    in_y, out_y = _span(n[1], d[1], h[1], u * w)
    in_z, out_z = _span(n[2], d[2], h[2], uv)
    first_out, last_in = min(out_x, out_y), max(in_x, in_y)
    out_weight, in_weight = (u if out_x < out_y else v), (u if in_x > in_y else v)
    out_weight, in_weight = (out_weight if first_out < out_z else w), (in_weight if last_in > in_z else w)
    first_out, last_in = min(first_out, out_z), max(last_in, in_z)
    t = (out_weight * first_out + in_weight * last_in) / (out_weight + in_weight)
    pulls = u * max(min(t, out_x), in_x) + v * max(min(t, out_y), in_y) + w * max(min(t, out_z), in_z)
    t = max(min(pulls / ((u + v + w) * (uv * w)), _ONE), _ZERO)
    x, y, z = _beyond(t * d[0] - n[0], h[0]), _beyond(t * d[1] - n[1], h[1]), _beyond(t * d[2] - n[2], h[2])
    return x * x + y * y + z * z


@helper
def _turned(m: Matrix, x: float, y: float, z: float) -> Vector:
    """The vector (x, y, z) in the axes of a box."""
    return m[0] * x + m[1] * y + m[2] * z, m[3] * x + m[4] * y + m[5] * z, m[6] * x + m[7] * y + m[8] * z


@helper
def _box_at(rows: Floats32, at: Any) -> tuple[Vector, Matrix, Vector]:
    """Centre, axes and half lengths of the box whose row begins at a place."""
    return (
        (rows[at], rows[at + 1], rows[at + 2]),
        (
            rows[at + 3], rows[at + 4], rows[at + 5],
            rows[at + 6], rows[at + 7], rows[at + 8],
            rows[at + 9], rows[at + 10], rows[at + 11],
        ),
        (rows[at + 12], rows[at + 13], rows[at + 14]),
    )  # fmt: skip


@helper
def _square(tiles: Floats32, at: Any, box: tuple[Vector, Matrix, Vector]) -> Any:
    """Squared distance of the axis at a place of the tiles from a box."""
    centre, matrix, half = box
    ax, ay, az = tiles[at], tiles[at + _LANES], tiles[at + np.uint64(2) * _LANES]
    bx, by, bz = (
        tiles[at + np.uint64(3) * _LANES],
        tiles[at + np.uint64(4) * _LANES],
        tiles[at + np.uint64(5) * _LANES],
    )
    start = _turned(matrix, centre[0] - ax, centre[1] - ay, centre[2] - az)
    return _squared_distance(start, _turned(matrix, bx - ax, by - ay, bz - az), half)


@kernel
def lower_from_boxes(tiles: Floats32, rows: Floats32, pairs: Longs, count: int, squares: Floats32) -> None:
    """Lower the squared distances of tiles to those from boxes, for the first `count` of `pairs` of tile and row.

    `pairs` (P, 2), `tiles` (T * TILE,), `rows` (B * ROW,) as `fill_tile_rows` leaves them, `squares` (T * LANES,) in
    units of their own.
    """
    for p in range(count):
        tile, least = np.uint64(pairs[p, 0]) * _TILE, np.uint64(pairs[p, 0]) * _LANES
        box = _box_at(rows, pairs[p, 1] * ROW)
        for i in range(_LANES):
            squares[least + i] = min(squares[least + i], _square(tiles, tile + i, box))


@inner_kernel
def lower_from_rounded(tiles: Floats32, rows: Floats32, pairs: Longs, count: int, squares: Floats32) -> None:
    """The same from boxes with rounded edges: spheres and capsules."""
    for p in range(count):
        tile, least = np.uint64(pairs[p, 0]) * _TILE, np.uint64(pairs[p, 0]) * _LANES
        box, rounding = _box_at(rows, pairs[p, 1] * ROW), rows[pairs[p, 1] * ROW + 15]
        for i in range(_LANES):
            distance = max(math.sqrt(_square(tiles, tile + i, box)) - rounding, _ZERO)
            squares[least + i] = min(squares[least + i], distance * distance)
