"""A way with corners: its leg at a place, and what of it lies ahead."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.command import Command
from elbowroom.planning.root.line.line import ON_THE_LINE, TravelLine, asked_direction, faced, joining

Floats = NDArray[np.float64]
Corners = tuple[tuple[float, float], ...]  # x, z

_SAME = 1e-6  # metres
_FORWARD = Command(forward=1.0)


class WayAhead(NamedTuple):
    """What lies ahead along a way: corner points (m, 2), x and z."""

    seen: Floats  # from where one is, to the leg as to a line, at the latest at the next corner
    walked: Floats  # from where the leg begins: the same for all who are on it
    ends: bool  # whether the way ends there
    legs: range  # the numbers of the legs, and of the one before


def leg_at(way: Corners, x: float, z: float, leg: int) -> int:
    """The number of the leg that one is on who has come to leg number `leg` before: the next one where that is nearer.

    So who goes to and fro along a thin wall stays on the side on which it is.
    """
    while leg + 2 < len(way) and away_from(way, leg + 1, x, z) <= away_from(way, leg, x, z):
        leg += 1
    return leg


def line_of(way: Corners, leg: int, command: Command = _FORWARD) -> TravelLine:
    """The line of travel along a leg, forward or as a command says."""
    (x, z), (next_x, next_z) = way[leg], way[leg + 1]
    heading = math.atan2(next_x - x, next_z - z)
    asked = asked_direction(replace(command, direction=heading))
    return TravelLine(asked, x, z, heading, faced(heading, command), True)


def way_ahead(way: Corners, leg: int, x: float, z: float, sight: float) -> WayAhead:
    """What lies ahead along a way, `sight` metres of it, from a place on that is next to leg number `leg`."""
    line, last = line_of(way, leg), leg
    length = math.dist(way[leg], way[leg + 1])
    first = min(max(line.coordinates(x, z)[0], 0.0), length)
    back = min(first + joining(line.coordinates(x, z)[1]), length)
    left = sight - (length - first)
    while left > 0.0 and last + 2 < len(way):
        last += 1
        left -= math.dist(way[last], way[last + 1])
    ends = last + 2 == len(way) and left >= 0.0
    end = way[last + 1] if left >= 0.0 else line_of(way, last).point(math.dist(way[last], way[last + 1]) + left, 0.0)
    onward = [*way[leg + 1 : last + 1], end]
    seen = [(x, z), line.point(back, ON_THE_LINE), *onward]
    return WayAhead(_route(seen), _route([way[leg], *onward]), ends, range(max(leg - 1, 0), last + 1))


def _route(places: Sequence[tuple[float, float]]) -> Floats:
    """Places without those that are next to the one before; two at least."""
    kept = list(places[:1])
    kept += [place for place in places[1:-1] if math.dist(kept[-1], place) > _SAME]
    return np.array([*kept, places[-1]])


def away_from(way: Corners, leg: int, x: float, z: float) -> float:
    """Metres from a place to a leg of a way."""
    (ax, az), (bx, bz) = way[leg], way[leg + 1]
    dx, dz = bx - ax, bz - az
    t = min(max(((x - ax) * dx + (z - az) * dz) / max(dx * dx + dz * dz, _SAME), 0.0), 1.0)
    return math.hypot(ax + t * dx - x, az + t * dz - z)
