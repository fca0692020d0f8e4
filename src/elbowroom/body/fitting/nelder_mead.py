"""The downhill simplex method, for the volume of a capsule over its two ends.

J. A. Nelder & R. Mead, "A simplex method for function minimization", Computer Journal 7 (1965), with the usual
coefficients: reflection 1, expansion 2, contraction and shrinkage 1/2. The steps are those of SciPy's.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper

Floats = NDArray[np.float64]


class PointsToHold(NamedTuple):
    """What a capsule must hold."""

    points: Floats  # (P, 3)
    rank: int  # all but so many of them, the nearest ones: from 0 to P-1
    slack: float  # metres that a point may be outside and counts as held


class Ends(NamedTuple):
    """When a search ends."""

    evaluations: int
    size: float  # metres from the best point, with
    spread: float  # cubic metres between the values


@exact_kernel
def volume(ends: Floats, held: PointsToHold) -> float:
    """Cubic metres of the slimmest capsule with these ends (6,) that holds the nearest `rank` + 1 points."""
    points, along, squared = held.points, ends[3:] - ends[:3], 0.0
    for i in range(3):
        squared += along[i] * along[i]
    squared = max(squared, 1e-18)
    away = np.empty(points.shape[0])
    for p in range(points.shape[0]):
        x, y, z = points[p, 0] - ends[0], points[p, 1] - ends[1], points[p, 2] - ends[2]
        where = min(max((x * along[0] + y * along[1] + z * along[2]) / squared, 0.0), 1.0)
        x, y, z = x - where * along[0], y - where * along[1], z - where * along[2]
        away[p] = x * x + y * y + z * z
    radius = max(np.sqrt(np.partition(away, held.rank)[held.rank]) - held.slack, 0.0)
    return float(np.pi * radius * radius * (np.sqrt(squared) + 4.0 / 3.0 * radius))


@helper
def _settle(simplex: Floats, values: Floats, row: int) -> None:
    """Move a row of points, all above which are in order, to its place by its value."""
    point, value, at = simplex[row].copy(), values[row], row
    while at > 0 and values[at - 1] > value:
        simplex[at], values[at] = simplex[at - 1], values[at - 1]
        at -= 1
    simplex[at], values[at] = point, value


@helper
def _is_small(simplex: Floats, values: Floats, ends: Ends) -> bool:
    far = 0.0
    for j in range(1, simplex.shape[0]):
        for i in range(simplex.shape[1]):
            far = max(far, abs(simplex[j, i] - simplex[0, i]))
    return bool(far <= ends.size and values[-1] - values[0] <= ends.spread)


@helper
def _middle(simplex: Floats) -> Floats:
    """The mean of all points but the worst."""
    out: Floats = np.zeros(simplex.shape[1])
    for j in range(simplex.shape[0] - 1):
        out += simplex[j]
    out /= simplex.shape[0] - 1
    return out


@exact_kernel
def least_volume(first: Floats, held: PointsToHold, ends: Ends) -> Floats:
    """The ends (6,) of the slimmest capsule found from a first simplex (7, 6), all of which is evaluated."""
    simplex, values = first.copy(), np.empty(first.shape[0])
    for j in range(first.shape[0]):
        values[j] = volume(simplex[j], held)
        _settle(simplex, values, j)
    left = ends.evaluations - first.shape[0]
    while left > 0 and not _is_small(simplex, values, ends):
        middle, worst = _middle(simplex), simplex[-1].copy()
        point = 2.0 * middle - worst
        value, better = volume(point, held), True
        left -= 1
        if value < values[0]:
            if left == 0:
                break
            farther = 3.0 * middle - 2.0 * worst
            there = volume(farther, held)
            left -= 1
            if there < value:
                point, value = farther, there
        elif value >= values[-2]:
            if left == 0:
                break
            outside, reflected = value < values[-1], value
            point = 1.5 * middle - 0.5 * worst if outside else 0.5 * middle + 0.5 * worst
            value = volume(point, held)
            left -= 1
            better = value <= reflected if outside else value < values[-1]
        if better:
            simplex[-1], values[-1] = point, value
            _settle(simplex, values, first.shape[0] - 1)
            continue
        for j in range(1, first.shape[0]):
            simplex[j] = simplex[0] + 0.5 * (simplex[j] - simplex[0])
            if left == 0:
                break
            values[j] = volume(simplex[j], held)
            left -= 1
        for j in range(1, first.shape[0]):
            _settle(simplex, values, j)
    best: Floats = simplex[0]
    return best
