"""How high ground holds a sole on its way from one place to another, for kernels: what a swinging foot goes over.

A sole that is as steep as the slope that it goes along is held no higher than where it would lie on it.

All that a sole is over on a straight way, turning as it goes, lies in a strip. The ground is looked at once at the
places of a grid over the strip; which of these are under the sole is told at any part of the way.
"""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import helper, inner_exact_kernel
from elbowroom.world.ground.ground import Ground, firm_at, level_over
from elbowroom.world.ground.sole import Sole

Floats = NDArray[np.float64]
SoleSpot = tuple[float, float, float, float]  # x, z and yaw of a foot's ankle, and how its sole slopes, as `sole_on`

SoleLie = tuple[float, float]  # how far a sole is turned from its course, and how it slopes
SoleCourse = tuple[float, float, float]  # the x and z where it begins, and where it leads, as a yaw

_NONE = -math.inf
_ALONG, _ACROSS = 0.025, 0.07  # metres between places of the grid, at most; no farther across than half a sole
_SHORT = 0.01  # metres: who goes no farther turns on the spot
_UPRIGHT = 1e-6  # radians: a level sole
_FINE, _EDGE = 0.005, 1e-6  # metres between places across at least; by which a place may be beside a sole


@helper
def _reach(sole: Sole, turned: float) -> tuple[float, float]:
    """From where to where a sole reaches from its ankle along a course that it is `turned` from, metres."""
    cosine, aside = math.cos(turned), sole.aside * abs(math.sin(turned))
    heel, toes = -sole.back * cosine, sole.ahead * cosine
    return min(heel, toes) - aside, max(heel, toes) + aside


@helper
def _evenly(low: float, high: float, most: float) -> Floats:
    """Numbers from one to another, no more than `most` apart."""
    return np.linspace(low, high, math.ceil((high - low) / most) + 1)


@helper
def _look(ground: Ground, begin: SoleCourse, near: float, along: Floats, across: Floats, found: Floats) -> None:
    """Set the ground `found` (R, C) at places so far `along` a course (R,) from a beginning, and `across` to its left.

    From the row of the beginning, where ground is about `near`, each column is followed step by step on, and back.
    """
    x, z, course = begin
    sine, cosine = math.sin(course), math.cos(course)
    first = int(np.searchsorted(along, 0.0))
    for j in range(across.shape[0]):
        for onward in (1, -1):
            height, i = near, first if onward > 0 else first - 1
            while 0 <= i < along.shape[0]:
                there_x = x + along[i] * sine + across[j] * cosine
                found[i, j] = firm_at(ground, there_x, z + along[i] * cosine - across[j] * sine, height)
                height = found[i, j] if found[i, j] > _NONE else height
                i += onward


@helper
def _highest(sole: Sole, gone: float, lie: SoleLie, along: Floats, across: Floats, found: Floats) -> float:
    """How high the ground `found` (R, C) holds a sole under its ankle that has gone so far, and how it lies there."""
    turned, grade = lie[0], math.tan(lie[1])
    sine, cosine, highest = math.sin(turned), math.cos(turned), _NONE
    low, high = _reach(sole, turned)
    for i in range(along.shape[0]):
        ahead = along[i] - gone
        for j in range(across.shape[0] if low - _EDGE <= ahead <= high + _EDGE else 0):
            before, aside = ahead * cosine + across[j] * sine, across[j] * cosine - ahead * sine
            if abs(aside) <= sole.aside + _EDGE and -sole.back - _EDGE <= before <= sole.ahead + _EDGE:
                highest = max(highest, found[i, j] + grade * before)
    return highest


@inner_exact_kernel
def set_highest_under(
    ground: Ground, sole: Sole, begin: SoleSpot, end: SoleSpot, near: float, shares: Floats, out: Floats
) -> None:
    """Set how high the ground holds a sole under its ankle, `out` (K,), at `shares` (K,) of its way.

    Minus infinity where there is none under it. Where it begins the ground is about `near`. It turns evenly from how it
    lies at the beginning to how it does at the end.
    """
    dx, dz = end[0] - begin[0], end[1] - begin[1]
    length = math.sqrt(dx * dx + dz * dz)
    course = math.atan2(dx, dz) if length > _SHORT else begin[2]
    first, last = begin[2] - course, end[2] - course
    one, other = _reach(sole, first), _reach(sole, last)
    back, ahead = min(one[0], other[0]), length + max(one[1], other[1])
    one, other = _reach(sole, first - 0.5 * math.pi), _reach(sole, last - 0.5 * math.pi)
    right, left = min(one[0], other[0]), max(one[1], other[1])
    if max(abs(begin[3]), abs(end[3])) < _UPRIGHT:
        half, middle, beside = (0.5 * (ahead - back), 0.5 * (left - right)), 0.5 * (ahead + back), 0.5 * (left + right)
        sine, cosine = math.sin(course), math.cos(course)
        there = begin[0] + middle * sine + beside * cosine, begin[1] + middle * cosine - beside * sine
        even = level_over(ground, there, course, half, near)
        if even > _NONE:
            out[:] = even
            return
    along, across = _evenly(back, ahead, _ALONG), _evenly(right, left, min(_ACROSS, max(sole.aside, _FINE)))
    found = np.empty((along.shape[0], across.shape[0]))
    _look(ground, (begin[0], begin[1], course), near, along, across, found)
    for k in range(shares.shape[0]):
        lie = first + shares[k] * (last - first), begin[3] + shares[k] * (end[3] - begin[3])
        out[k] = _highest(sole, shares[k] * length, lie, along, across, found)
