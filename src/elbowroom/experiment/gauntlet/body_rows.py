"""Capsules of many moments as rows, and their exact distance from a box in double precision.

Courses are decided by these distances. Strict arithmetic in double precision lets every machine decide alike: to decide
otherwise, a distance would have to lie within some 1e-15 m of a threshold.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, inner_exact_kernel

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class BodyRows:
    """Capsules in the world, one per row, in no particular order."""

    axes: Floats  # (M, 6) end points ax, ay, az, bx, by, bz, metres
    radii: Floats  # (M,) metres
    way: Floats  # (M,) where on the course's line the body stands, metres

    def between(self, first: float, last: float) -> "BodyRows":
        """The rows of a part of the way."""
        chosen = (self.way >= first) & (self.way <= last)
        return BodyRows(self.axes[chosen], self.radii[chosen], self.way[chosen])

    def every(self, step: int) -> "BodyRows":
        """Every `step`-th row."""
        return BodyRows(self.axes[::step].copy(), self.radii[::step].copy(), self.way[::step].copy())

    def gap(self, box: Floats) -> float:
        """The least clearance of any row from a box (15,); infinite without rows.

        A box is its centre, the rotation matrix from the world to its axes row by row, and half its sizes.
        """
        return float(_least_gap(self.axes, self.radii, self._spheres, box))

    @cached_property
    def _spheres(self) -> Floats:
        return _spheres_around(self.axes, self.radii)


def rows_of(segments: NDArray[np.floating], radii: Floats, way: Floats) -> BodyRows:
    """Rows for capsules (C, 6, N) with radii (C,) or (C, N) at ways (N,)."""
    count = segments.shape[2]
    sizes = np.broadcast_to(radii if radii.ndim == 2 else radii[:, None], (len(segments), count))
    axes = np.ascontiguousarray(segments.astype(np.float64).transpose(0, 2, 1).reshape(-1, 6))
    return BodyRows(axes, np.ascontiguousarray(sizes, np.float64).ravel(), np.tile(way, len(segments)))


def joined(*parts: BodyRows) -> BodyRows:
    """The rows of all parts."""
    columns = [(part.axes, part.radii, part.way) for part in parts]
    return BodyRows(*(np.concatenate(column) for column in zip(*columns, strict=True)))


@exact_kernel
def _least_gap(axes: Floats, radii: Floats, spheres: Floats, box: Floats) -> float:
    """The least distance of axes (M, 6) from a box (15,) less their radii (M,).

    A row whose sphere (4, M) is too far away to matter is skipped.
    """
    best, p, d = np.inf, np.empty(3), np.empty(3)
    least = _least_of_spheres(spheres, box)
    for i in range(axes.shape[0]):
        if least[i] < best:
            a = axes[i]
            for k in range(3):
                m = 3 + 3 * k
                p[k] = box[m] * (a[0] - box[0]) + box[m + 1] * (a[1] - box[1]) + box[m + 2] * (a[2] - box[2])
                d[k] = box[m] * (a[3] - a[0]) + box[m + 1] * (a[4] - a[1]) + box[m + 2] * (a[5] - a[2])
            best = min(best, _axis_to_box(p, d, box[12:]) - radii[i])
    return best


@exact_kernel
def _spheres_around(axes: Floats, radii: Floats) -> Floats:
    """Spheres (4, M), their middle and radius, around capsules: axes (M, 6), radii (M,)."""
    spheres = np.empty((4, axes.shape[0]))
    for i in range(axes.shape[0]):
        half = 0.0
        for k in range(3):
            spheres[k, i] = 0.5 * (axes[i, k] + axes[i, k + 3])
            half += (0.5 * (axes[i, k + 3] - axes[i, k])) ** 2
        spheres[3, i] = math.sqrt(half) + radii[i]
    return spheres


@helper
def _least_of_spheres(spheres: Floats, box: Floats) -> Floats:
    """What the clearance of capsules in spheres (4, M) from a box (15,) is at least (M,)."""
    squares = np.zeros(spheres.shape[1])
    for k in range(3):
        across, up, ahead = box[3 + 3 * k], box[4 + 3 * k], box[5 + 3 * k]
        for i in range(np.uint64(squares.shape[0])):
            x, y, z = spheres[0, i] - box[0], spheres[1, i] - box[1], spheres[2, i] - box[2]
            squares[i] += max(abs(across * x + up * y + ahead * z) - box[12 + k], 0.0) ** 2
    least: Floats = np.sqrt(squares) - spheres[3]
    return least


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
