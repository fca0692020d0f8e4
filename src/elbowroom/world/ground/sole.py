"""How a flat sole lies on the ground, for kernels: on the highest that it is over, along a slope or level.

Places of a grid tell how steep the ground is, and what is reached from the ankle step by step. A ridge, the edge of a
chamfer or a cable may lie between them; so how high a sole lies is read off the parts of triangles under it.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, plain
from elbowroom.world.clipping import clipped
from elbowroom.world.ground.ground import FIRM, SPANS, STEEPEST, Ground, firm_at, first_within, level_over

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_NONE = -math.inf
_GRADE = math.tan(STEEPEST)
_ALONG, _ACROSS = 13, 3  # places of a sole that are looked at
_UNEVEN = 0.02  # metres: a sole that would have more air under it lies level
_NEXT = np.uint64(1)
_TRIED = 16  # triangles that are known to have been looked at: they lie in many cells
_SLIGHT = 2e-4  # metres: what rises no higher above those places is not looked for
_AHEAD, _HEIGHT, _ASIDE, _CORNERS = plain(0), plain(1), plain(2), plain(3)  # axes of a sole; what a triangle has


class Sole(NamedTuple):
    """The rectangle that a flat foot stands on, from the ankle; metres."""

    back: float
    ahead: float
    aside: float


class _Spot(NamedTuple):
    """Where a sole is, and how it is turned."""

    sole: Sole
    x: float  # of the ankle, and
    z: float
    sine: float
    cosine: float


@helper
def _cells_under(ground: Ground, at: _Spot) -> tuple[int, int, int, int]:
    """The first and the last cell along x, and along z, that a sole may be over."""
    back, ahead, aside = at.sole
    middle, half = 0.5 * (ahead - back), 0.5 * (ahead + back)
    x, wide = at.x + middle * at.sine, half * abs(at.sine) + aside * abs(at.cosine)
    z, deep = at.z + middle * at.cosine, half * abs(at.cosine) + aside * abs(at.sine)
    (left, near), side, (columns, rows) = ground.corner, ground.cell, ground.shape
    return (
        max(math.floor((x - wide - left) / side), 0),
        min(math.floor((x + wide - left) / side), columns - 1),
        max(math.floor((z - deep - near) / side), 0),
        min(math.floor((z + deep - near) / side), rows - 1),
    )


@helper
def _may_rise(triangles: Floats, t: int, at: _Spot, grade: float, best: float, seen: Floats) -> bool:
    """Whether a triangle may lie under a sole and above it; its corners are written as they are `seen` (3, 3) by it.

    That is how far ahead and aside of the ankle they are, and how high.
    """
    rises, top, back, ahead, left, right = _NONE, _NONE, math.inf, _NONE, math.inf, _NONE
    for i, c in enumerate((0, 3, 5)):
        x, z = triangles[t, c], triangles[t, c + 1]
        height = triangles[t, 2] + triangles[t, 7] * (x - triangles[t, 0]) + triangles[t, 8] * (z - triangles[t, 1])
        along = (x - at.x) * at.sine + (z - at.z) * at.cosine
        aside = (x - at.x) * at.cosine - (z - at.z) * at.sine
        seen[i, _AHEAD], seen[i, _HEIGHT], seen[i, _ASIDE] = along, height, aside
        back, ahead, left, right = min(back, along), max(ahead, along), min(left, aside), max(right, aside)
        rises, top = max(rises, height - grade * along), max(top, height)
    sole = at.sole
    rises = min(rises, top - min(grade * max(back, -sole.back), grade * min(ahead, sole.ahead)))
    beside = back > sole.ahead or ahead < -sole.back or left > sole.aside or right < -sole.aside
    return rises > best + _SLIGHT and not beside


@helper
def _is_among(numbers: Longs, count: int, number: int) -> bool:
    """Whether a number is one of the first `count`."""
    found = False
    for i in range(count):
        found |= numbers[i] == number
    return found


@helper
def _part_under(sole: Sole, piece: Floats, other: Floats) -> int:
    """Cut a triangle, the first corners of a `piece` (8, 3), to what lies under the sole; how many corners that has."""
    count = clipped(piece, _CORNERS, _AHEAD, -sole.back, 1.0, other)
    count = clipped(other, count, _AHEAD, sole.ahead, -1.0, piece)
    count = clipped(piece, count, _ASIDE, -sole.aside, 1.0, other)
    return int(clipped(other, count, _ASIDE, sole.aside, -1.0, piece))


@helper
def _raised(sole: Sole, piece: Floats, count: int, nears: Floats, step: float, grade: float, best: float) -> float:
    """`best`, or how high a sole lies on so many corners of a `piece`, those that are within a `step` of `nears`."""
    per = (_ALONG - 1) / (sole.back + sole.ahead)
    for i in range(count):
        near = nears[int((piece[i, _AHEAD] + sole.back) * per + 0.5)]
        if abs(piece[i, _HEIGHT] - near) <= step:
            best = max(best, piece[i, _HEIGHT] - grade * piece[i, _AHEAD])
    return best


@helper
def _highest_under(ground: Ground, at: _Spot, nears: Floats, grade: float, least: float) -> float:
    """How high a sole that rises by `grade` ahead lies under its ankle, where no ground that it is over is above it.

    At `least` that high. Ground counts that is no more than a step from what is reached there, `nears` (_ALONG,).
    """
    sole, best, piece, other = at.sole, least, np.empty((8, 3)), np.empty((8, 3))
    begin_x, end_x, begin_z, end_z = _cells_under(ground, at)
    lower = abs(grade) * max(sole.back, sole.ahead)
    high, tried, count = nears.max() + ground.step, np.empty(_TRIED, np.int64), 0
    for ix in range(begin_x, end_x + 1):
        for iz in range(begin_z, end_z + 1):
            cell = np.uint64(ix * ground.shape[1] + iz)
            m, last = np.uint64(ground.starts[cell]), np.uint64(ground.starts[cell + _NEXT])
            m = first_within(ground.bottoms, m, last, high)
            while m < last and ground.tops[m] > best - lower + _SLIGHT:
                t = ground.members[m]
                m += _NEXT
                if ground.triangles[t, SPANS] >= FIRM or _is_among(tried, count, t):
                    continue
                if _may_rise(ground.triangles, t, at, grade, best, piece):
                    if count < _TRIED:
                        tried[count] = t
                        count += 1
                    best = _raised(sole, piece, _part_under(sole, piece, other), nears, ground.step, grade, best)
    return best


@exact_kernel
def sole_on(ground: Ground, sole: Sole, place: tuple[float, float, float], yaw: float) -> tuple[float, float]:
    """How a foot stands whose ankle is over a place (x, height, z), turned by `yaw`: it lies on the highest ground.

    From the ankle that is followed step by step to toes and heel, so a sole may lie over several treads, and over gaps.
    Returns the height of the sole under the ankle, minus infinity where there is no ground, and its pitch in radians,
    positive with the toes down: on a slope it lies on it, on what is uneven it is level.
    """
    if ground.plain:
        return 0.0, 0.0
    sine, cosine, middle = math.sin(yaw), math.cos(yaw), 0.5 * (sole.ahead - sole.back)
    half = 0.5 * (sole.back + sole.ahead), sole.aside
    even = level_over(ground, (place[0] + middle * sine, place[2] + middle * cosine), yaw, half, place[1])
    if even > _NONE:
        return even, 0.0
    at, highest, nears = _Spot(sole, place[0], place[2], sine, cosine), np.empty(_ALONG), np.empty(_ALONG)
    length, ankle = sole.back + sole.ahead, int(sole.back / (sole.back + sole.ahead) * (_ALONG - 1) + 0.5)
    near = place[1]
    for k in range(_ALONG):
        i = ankle + k if ankle + k < _ALONG else _ALONG - 1 - k  # from the ankle to the toes, then to the heel
        near = place[1] if i == ankle - 1 else near
        ahead, highest[i] = length * i / (_ALONG - 1) - sole.back, _NONE
        for j in range(_ACROSS):
            aside = sole.aside * (2.0 * j / (_ACROSS - 1) - 1.0)
            x, z = place[0] + ahead * sine + aside * cosine, place[2] + ahead * cosine - aside * sine
            highest[i] = max(highest[i], firm_at(ground, x, z, near))
        near = highest[i] if highest[i] > _NONE else near
        nears[i] = near
    grade = 0.0
    if min(highest[0], highest[-1]) > _NONE:
        grade = (highest[-1] - highest[0]) / length
    level, tilted = _NONE, _NONE
    for i in range(_ALONG):
        level = max(level, highest[i])
        tilted = max(tilted, highest[i] - grade * (length * i / (_ALONG - 1) - sole.back))
    if level == _NONE:
        return level, 0.0
    lowest = math.inf
    for i in range(_ALONG):
        lowest = min(lowest, highest[i] - grade * (length * i / (_ALONG - 1) - sole.back))
    if abs(grade) <= _GRADE and tilted - lowest <= _UNEVEN:
        tilted = _highest_under(ground, at, nears, grade, tilted)
        if tilted - lowest <= _UNEVEN:
            return tilted, -math.atan(grade)
    return _highest_under(ground, at, nears, 0.0, level), 0.0
