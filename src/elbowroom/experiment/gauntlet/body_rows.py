"""Capsules of many moments as rows, and their exact distance from a box in double precision.

Courses are decided by these distances. Strict arithmetic in double precision lets every machine decide alike: to decide
otherwise, a distance would have to lie within some 1e-15 m of a threshold.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, inner_exact_kernel

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

_PIECE = 8  # rows at most
_ROUNDING = 1e-9  # metres by which bounds are less: far more than they are wrong by, so the least gap is found exactly


class Pieces(NamedTuple):
    """The same rows for kernels, in pieces: rows one after the other on the way, few of which matter to a box."""

    axes: Floats  # (M, 6)
    radii: Floats  # (M,)
    begins: Indices  # (P + 1,) first row of each piece, and the number of rows
    around: Floats  # (7, P) middle and half sizes of a box around the axes of each piece, and their greatest radius


@dataclass(frozen=True, eq=False)
class BodyRows:
    """Capsules in the world, one per row, in no particular order."""

    axes: Floats  # (M, 6) end points ax, ay, az, bx, by, bz, metres
    radii: Floats  # (M,) metres
    way: Floats  # (M,) where on the course's line the body stands, metres

    def between(self, first: float, last: float) -> "BodyRows":
        """The rows of a part of the way."""
        return self._chosen(np.flatnonzero((self.way >= first) & (self.way <= last)))

    def every(self, step: int) -> "BodyRows":
        """Every `step`-th row."""
        return self._chosen(np.arange(0, len(self.way), step))

    def _chosen(self, rows: Indices) -> "BodyRows":
        return BodyRows(self.axes.take(rows, axis=0), self.radii.take(rows), self.way.take(rows))

    def gap(self, box: Floats) -> float:
        """The least clearance of any row from a box (15,); infinite without rows.

        A box is its centre, the rotation matrix from the world to its axes row by row, and half its sizes.
        """
        return float(least_gap(self.pieces, box, np.inf))

    @cached_property
    def pieces(self) -> Pieces:
        """The rows for kernels."""
        return Pieces(self.axes, self.radii, *_pieces(self.axes, self.radii, self.way))


def rows_of(segments: NDArray[np.floating], radii: Floats, way: Floats) -> BodyRows:
    """Rows for capsules (C, 6, N) with radii (C,) or (C, N) at ways (N,)."""
    sizes = radii if radii.ndim == 2 else np.repeat(radii[:, None], len(way), axis=1)
    axes = np.ascontiguousarray(segments.transpose(0, 2, 1), np.float64).reshape(-1, 6)
    return BodyRows(axes, sizes.ravel(), np.tile(way, len(segments)))


def joined(*parts: BodyRows) -> BodyRows:
    """The rows of all parts."""
    columns = [(part.axes, part.radii, part.way) for part in parts]
    return BodyRows(*(np.concatenate(column) for column in zip(*columns, strict=True)))


@exact_kernel
def least_gap(rows: Pieces, box: Floats, best: float) -> float:
    """The least clearance of any row from a box (15,), or the `best` of others where none has less.

    Pieces and rows that cannot be nearer than what was found are not looked at.
    """
    least, axis = _least_of_pieces(rows.around, box), np.empty((2, 3))
    for piece in range(len(least)):
        if least[piece] < best:
            best = _gap_of_piece(rows, piece, box, best, axis)
    return best


@helper
def _least_of_pieces(around: Floats, box: Floats) -> Floats:
    """What the clearance of pieces with boxes (7, P) around them from a box (15,) is at least (P,)."""
    least = np.empty(around.shape[1])
    for i in range(np.uint64(least.shape[0])):
        square = 0.0
        for k in range(3):
            across, up, ahead = box[3 + 3 * k], box[4 + 3 * k], box[5 + 3 * k]
            x, y, z = around[0, i] - box[0], around[1, i] - box[1], around[2, i] - box[2]
            reach = abs(across) * around[3, i] + abs(up) * around[4, i] + abs(ahead) * around[5, i]
            square += max(abs(across * x + up * y + ahead * z) - reach - box[12 + k], 0.0) ** 2
        least[i] = math.sqrt(square) - around[6, i] - _ROUNDING
    return least


@helper
def _gap_of_piece(rows: Pieces, piece: int, box: Floats, best: float, axis: Floats) -> float:
    """The least clearance of a piece's rows, or the `best` of others; `axis` is scratch (2, 3)."""
    axes, radii, p, d, half = rows.axes, rows.radii, axis[0], axis[1], box[12:]
    for i in range(rows.begins[piece], rows.begins[piece + 1]):
        square = 0.0
        for k in range(3):
            across, up, ahead = box[3 + 3 * k], box[4 + 3 * k], box[5 + 3 * k]
            p[k] = across * (axes[i, 0] - box[0]) + up * (axes[i, 1] - box[1]) + ahead * (axes[i, 2] - box[2])
            d[k] = (
                across * (axes[i, 3] - axes[i, 0]) + up * (axes[i, 4] - axes[i, 1]) + ahead * (axes[i, 5] - axes[i, 2])
            )
            low, high = min(p[k], p[k] + d[k]), max(p[k], p[k] + d[k])
            square += max(low - half[k], -half[k] - high, 0.0) ** 2
        if math.sqrt(square) - radii[i] - _ROUNDING < best:
            best = min(best, _axis_to_box(p, d, half) - radii[i])
    return best


@helper
def _begins(way: Floats) -> Indices:
    """Where pieces of rows at ways (M,) begin: after some rows, and where the way goes back; and the number of rows."""
    begins, count = np.empty(len(way) + 1, np.int64), 0
    for i in range(len(way)):
        if count == 0 or i - begins[count - 1] == _PIECE or way[i] < way[i - 1]:
            begins[count] = i
            count += 1
    begins[count] = len(way)
    return begins[: count + 1]


@exact_kernel
def _pieces(axes: Floats, radii: Floats, way: Floats) -> tuple[Indices, Floats]:
    """Where pieces of capsules with axes (M, 6) and radii (M,) at ways (M,) begin, and the boxes (7, P) around them."""
    begins = _begins(way)
    around = np.empty((7, len(begins) - 1))
    for piece in range(around.shape[1]):
        first, last = begins[piece], begins[piece + 1]
        for k in range(3):
            low = high = axes[first, k]
            for i in range(first, last):
                low, high = min(low, axes[i, k], axes[i, k + 3]), max(high, axes[i, k], axes[i, k + 3])
            around[k, piece], around[k + 3, piece] = 0.5 * (low + high), 0.5 * (high - low)
        around[6, piece] = radii[first]
        for i in range(first, last):
            around[6, piece] = max(around[6, piece], radii[i])
    return begins, around


@inner_exact_kernel
def _slope(p: Floats, d: Floats, half: Floats, t: float) -> float:
    """Half the derivative of the squared distance from the box |x| <= half at the axis point p + t d."""
    total = 0.0
    for k in range(3):
        x = p[k] + t * d[k]
        total += (x - max(min(x, half[k]), -half[k])) * d[k]
    return total


@helper
def _axis_to_box(p: Floats, d: Floats, half: Floats) -> float:
    """Distance of the axis p + t d, t in [0, 1], from the box |x| <= half.

    The squared distance is convex in t with a piecewise linear derivative, whose corners are where the axis crosses the
    planes of the faces: between the two corners around its zero it is a straight line.
    """
    low, high = 0.0, 1.0
    low_slope, high_slope = _slope(p, d, half, 0.0), _slope(p, d, half, 1.0)
    t = 0.0
    if low_slope < 0.0:
        t = 1.0
        if high_slope > 0.0:
            for k in range(3):
                for side in (-1.0, 1.0):
                    if d[k] != 0.0:
                        corner = (side * half[k] - p[k]) / d[k]
                        if low < corner < high:
                            slope = _slope(p, d, half, corner)
                            if slope <= 0.0:
                                low, low_slope = corner, slope
                            else:
                                high, high_slope = corner, slope
            t = low - low_slope * (high - low) / (high_slope - low_slope)
    total = 0.0
    for k in range(3):
        x = p[k] + t * d[k]
        total += (x - max(min(x, half[k]), -half[k])) ** 2
    return math.sqrt(total)
