"""Where to begin in a place that nobody has given a start, and where to end."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.places.floors import SLIM, Floor
from elbowroom.world.places.place import Place

Flags = NDArray[np.bool_]

_ROOMY = 0.6  # metres round the start
_NEARLY = 0.8  # share of the room that there is, where there is less
_WAY = 6.0  # metres from the start to the finish, at most
_DIRECTIONS = 64
_BESIDE = 0.35  # metres that the way to the finish keeps from things
_BEFORE = 0.4  # metres that it ends before what ends it
_OUTSIDE = 1.5  # metres in front of a place and behind it


class Beginning(NamedTuple):
    """A start and a finish on the ground; metres and radians."""

    x: float
    z: float
    heading: float  # towards the finish
    way: float  # metres to the finish


def beginning_on(floor: Floor) -> Beginning | None:
    """A roomy place near the middle of the largest region of a floor, and the longest straight way from there."""
    numbers, sizes = floor.regions()
    if not sizes:
        return None
    region = numbers == 1 + int(np.argmax(sizes))
    wanted = min(_ROOMY, _NEARLY * float(floor.room[region].max()))
    roomy = np.argwhere(region & (floor.room >= wanted))
    middle = np.argwhere(region).mean(axis=0)
    ix, iz = roomy[int(np.argmin(np.sum((roomy - middle) ** 2, axis=1)))].tolist()
    free = floor.room >= min(_BESIDE, max(0.8 * wanted, SLIM))
    headings = [2.0 * math.pi * number / _DIRECTIONS for number in range(_DIRECTIONS)]
    ways = [_free_way(free, ix, iz, heading, floor.columns.cell) for heading in headings]
    best = int(np.argmax(ways))
    x, z = floor.columns.middle(ix, iz)
    return Beginning(x, z, headings[best], max(ways[best] - _BEFORE, 0.5))


def beginning_beside(place: Place) -> Beginning:
    """In front of the middle of a place, with the finish behind it: the shorter way across."""
    least, most = place.bounds
    x, z = (0.5 * (least + most))[[0, 2]].tolist()
    wide, deep = (most - least)[[0, 2]].tolist()
    if deep <= wide:
        return Beginning(x, float(least[2]) - _OUTSIDE, 0.0, deep + 2.0 * _OUTSIDE)
    return Beginning(float(least[0]) - _OUTSIDE, z, 0.5 * math.pi, wide + 2.0 * _OUTSIDE)


def _free_way(free: Flags, ix: int, iz: int, heading: float, cell: float) -> float:
    """How far one can go straight on, metres."""
    step = 0.5 * cell
    distances = np.arange(0.0, _WAY + _BEFORE, step)
    along_x = np.floor(ix + 0.5 + distances * math.sin(heading) / cell).astype(np.int64)
    along_z = np.floor(iz + 0.5 + distances * math.cos(heading) / cell).astype(np.int64)
    inside = (along_x >= 0) & (along_x < free.shape[0]) & (along_z >= 0) & (along_z < free.shape[1])
    open_ = np.zeros(len(distances), bool)
    open_[inside] = free[along_x[inside], along_z[inside]]
    ends = np.flatnonzero(~open_)
    return float(distances[ends[0]]) if len(ends) else _WAY + _BEFORE
