"""Clearance of capsules from oriented boxes: exact distances in batches, float32.

Segments are a structure of arrays: `(C, 6, N)`, rows ax, ay, az, bx, by, bz of C capsules in N configurations.
Clearance is the distance from the capsule's axis to the box less the capsule's radius: negative where they overlap.
An axis that enters a box has distance 0, so the clearance is never below minus the radius: it is no measure of how
deep the overlap is. Rounding stays below 1e-6 m while coordinates are below some 10 m, and grows with them: move
distant obstacles into a frame near the body (`tables_in_frames`).

The distance: in the axes of a box, f(t) = |q(t) - clamp(q(t))|^2 along the axis q(t) = p + t d is convex, and its
derivative is piecewise linear with six break points, where a coordinate of q meets a face. So the signs of the
derivative at the break points bracket the minimum between two neighbours, and one linear interpolation gives it
exactly, without a branch. Break points beyond the ends of the axis need no care: the derivative never falls, so their
slopes never narrow the bracket that the ends give; and where a coordinate meets its own face it adds nothing to the
slope. Lanes of the vector loop are configurations, padded to whole vectors; boxes are outside.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.jit import inlined, kernel

LANES = 16  # float32 lanes of the widest vector register
BLOCK = 512  # lanes that are treated together: their rows stay in the first-level cache
_LANE_ROWS = 7  # ax, ay, az, bx, by, bz, radius
_START = 0  # the first configuration

_ZERO: Any = np.float32(0.0)  # single precision on purpose: a bare 0.0 would widen the whole loop
_ONE: Any = np.float32(1.0)
_TINY: Any = np.float32(1e-12)
_INFINITE: Any = np.float32(np.inf)

Floats32 = NDArray[np.float32]
Vector = tuple[float, float, float]
Matrix = tuple[float, float, float, float, float, float, float, float, float]


def clearance(segments: ArrayLike, radii: ArrayLike, table: ArrayLike) -> Floats32:
    """The least clearance of every configuration, metres, shape (N,); infinite where there are no boxes or capsules.

    `segments` (C, 6, N), `radii` (C,), `table` (B, 15) as in `Boxes.table`, all in one frame.
    """
    capsules, sizes, rows = _prepared(segments, radii, table)
    out = np.empty(capsules.shape[2], np.float32)
    clearance_into(capsules, sizes, rows, out)
    return out


def clearance_of(segments: ArrayLike, radii: ArrayLike, table: ArrayLike) -> float:
    """The least clearance of one posture, `segments` (C, 6): the same check, bit for bit, with capsules as lanes."""
    lanes = np.ascontiguousarray(np.asarray(segments, np.float32).T)
    rows = np.ascontiguousarray(table, np.float32)
    return float(_posture_clearance(lanes, np.ascontiguousarray(radii, np.float32), rows))


def pairwise_clearance(segments: ArrayLike, radii: ArrayLike, table: ArrayLike) -> Floats32:
    """The clearance of every capsule from every box in every configuration, metres, shape (C, B, N)."""
    capsules, sizes, rows = _prepared(segments, radii, table)
    out = np.empty((capsules.shape[0], rows.shape[0], capsules.shape[2]), np.float32)
    _pairwise_into(capsules, sizes, rows, out)
    return out


def _prepared(segments: ArrayLike, radii: ArrayLike, table: ArrayLike) -> tuple[Floats32, Floats32, Floats32]:
    """The one array layout that the kernels are compiled for."""
    return (
        np.ascontiguousarray(segments, np.float32),
        np.ascontiguousarray(radii, np.float32),
        np.ascontiguousarray(table, np.float32),
    )


@inlined
def _beyond(x: Any, h: Any) -> Any:
    """How far a coordinate lies beyond the faces at -h and h; 0 between them."""
    return x - max(min(x, h), -h)


@inlined
def _narrowed(low: Any, low_slope: Any, high: Any, high_slope: Any, t: Any, slope: Any) -> Any:
    """The bracket of the minimum, narrowed by the slope at t."""
    falls = slope <= _ZERO
    return (
        max(low, t) if falls else low,
        max(low_slope, slope) if falls else low_slope,
        high if falls else min(high, t),
        high_slope if falls else min(high_slope, slope),
    )


@inlined
def _slope_of_two(t: Any, p: Any, d: Any, h: Any, other_p: Any, other_d: Any, other_h: Any) -> Any:
    """Half the derivative of the squared distance at t where the third coordinate meets a face."""
    return _beyond(p + t * d, h) * d + _beyond(other_p + t * other_d, other_h) * other_d


@inlined
def _squared_distance(p: Vector, d: Vector, h: Vector) -> Any:
    """Squared distance of the axis p + t d, t in [0, 1], from the box |x| <= h in its own axes."""
    first = _beyond(p[0], h[0]) * d[0] + _beyond(p[1], h[1]) * d[1] + _beyond(p[2], h[2]) * d[2]
    last = _beyond(p[0] + d[0], h[0]) * d[0] + _beyond(p[1] + d[1], h[1]) * d[1] + _beyond(p[2] + d[2], h[2]) * d[2]
    low, low_slope, high, high_slope = _ZERO, first, _ONE, last
    inverse = d[0] / (d[0] * d[0] + _TINY)
    for t in ((h[0] - p[0]) * inverse, (-h[0] - p[0]) * inverse):
        slope = _slope_of_two(t, p[1], d[1], h[1], p[2], d[2], h[2])
        low, low_slope, high, high_slope = _narrowed(low, low_slope, high, high_slope, t, slope)
    inverse = d[1] / (d[1] * d[1] + _TINY)
    for t in ((h[1] - p[1]) * inverse, (-h[1] - p[1]) * inverse):
        slope = _slope_of_two(t, p[0], d[0], h[0], p[2], d[2], h[2])
        low, low_slope, high, high_slope = _narrowed(low, low_slope, high, high_slope, t, slope)
    inverse = d[2] / (d[2] * d[2] + _TINY)
    for t in ((h[2] - p[2]) * inverse, (-h[2] - p[2]) * inverse):
        slope = _slope_of_two(t, p[0], d[0], h[0], p[1], d[1], h[1])
        low, low_slope, high, high_slope = _narrowed(low, low_slope, high, high_slope, t, slope)
    t = low - low_slope * (high - low) / max(high_slope - low_slope, _TINY)
    t = _ZERO if first >= _ZERO else (_ONE if last <= _ZERO else t)
    x, y, z = _beyond(p[0] + t * d[0], h[0]), _beyond(p[1] + t * d[1], h[1]), _beyond(p[2] + t * d[2], h[2])
    return x * x + y * y + z * z


@inlined
def _turned(m: Matrix, x: float, y: float, z: float) -> Vector:
    """The vector (x, y, z) in the axes of a box."""
    return m[0] * x + m[1] * y + m[2] * z, m[3] * x + m[4] * y + m[5] * z, m[6] * x + m[7] * y + m[8] * z


@kernel
def lower_to_box(lanes: Floats32, box: Floats32, out: Floats32) -> None:
    """out[i] = min(out[i], clearance of lane i from the box); lanes (7, n), n a multiple of the vector width."""
    ax, ay, az, bx, by, bz, radius = lanes[0], lanes[1], lanes[2], lanes[3], lanes[4], lanes[5], lanes[6]
    cx, cy, cz = box[0], box[1], box[2]
    matrix = (box[3], box[4], box[5], box[6], box[7], box[8], box[9], box[10], box[11])
    half = (box[12], box[13], box[14])
    for i in range(np.uint64(out.shape[0])):
        point = _turned(matrix, ax[i] - cx, ay[i] - cy, az[i] - cz)
        step = _turned(matrix, bx[i] - ax[i], by[i] - ay[i], bz[i] - az[i])
        out[i] = min(out[i], math.sqrt(_squared_distance(point, step, half)) - radius[i])


@kernel
def _padded(count: int) -> int:
    """`count` rounded up to whole vectors."""
    return (count + LANES - 1) // LANES * LANES


@kernel
def _fill_lanes(segment: Floats32, radius: float, start: int, count: int, lanes: Floats32) -> None:
    """Copy `count` configurations of one capsule; the lanes that fill up the last vector repeat the last of them."""
    for row in range(6):
        source, target = segment[row, start : start + count], lanes[row]
        for i in range(np.uint64(count)):
            target[i] = source[i]
        for i in range(count, lanes.shape[1]):
            target[i] = source[count - 1]
    lanes[6, :] = radius


@kernel
def clearance_into(segments: Floats32, radii: Floats32, table: Floats32, out: Floats32) -> None:
    """`clearance` for other kernels: C-contiguous float32 arrays, the result written to `out` (N,)."""
    scratch = np.empty(_LANE_ROWS * BLOCK, np.float32)
    least = np.empty(BLOCK, np.float32)
    for start in range(0, out.shape[0], BLOCK):
        count = min(BLOCK, out.shape[0] - start)
        width = _padded(count)
        lanes = scratch[: _LANE_ROWS * width].reshape(_LANE_ROWS, width)
        best = least[:width]
        best[:] = _INFINITE
        for c in range(segments.shape[0]):
            _fill_lanes(segments[c], radii[c], start, count, lanes)
            for b in range(table.shape[0]):
                lower_to_box(lanes, table[b], best)
        out[start : start + count] = best[:count]


@kernel
def _pairwise_into(segments: Floats32, radii: Floats32, table: Floats32, out: Floats32) -> None:
    scratch = np.empty(_LANE_ROWS * BLOCK, np.float32)
    least = np.empty(BLOCK, np.float32)
    for start in range(0, out.shape[2], BLOCK):
        count = min(BLOCK, out.shape[2] - start)
        width = _padded(count)
        lanes = scratch[: _LANE_ROWS * width].reshape(_LANE_ROWS, width)
        best = least[:width]
        for c in range(segments.shape[0]):
            _fill_lanes(segments[c], radii[c], start, count, lanes)
            for b in range(table.shape[0]):
                best[:] = _INFINITE
                lower_to_box(lanes, table[b], best)
                out[c, b, start : start + count] = best[:count]


@kernel
def _posture_clearance(rows: Floats32, radii: Floats32, table: Floats32) -> Any:
    """The least clearance of capsules `rows` (6, C), as lanes of one loop."""
    count = rows.shape[1]
    least = _INFINITE
    if count == 0:
        return least
    lanes = np.empty((_LANE_ROWS, _padded(count)), np.float32)
    _fill_lanes(rows, radii[0], int(_START), count, lanes)
    for i in range(lanes.shape[1]):
        lanes[6, i] = radii[min(i, count - 1)]
    best = np.full(lanes.shape[1], _INFINITE, np.float32)
    for b in range(table.shape[0]):
        lower_to_box(lanes, table[b], best)
    for i in range(count):
        least = min(least, best[i])
    return least
