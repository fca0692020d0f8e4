"""Slower where ground rises or falls steeply: on stairs at the pace of people, the steeper the slower, and in time.

So a foot comes down on the next tread, as steps climb no farther (`body.gait.cycle`), and nobody has to find by trying
at which pace legs are free.
"""

import math
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.root.line.line import TravelLine
from elbowroom.planning.root.line.way_ahead import Corners, line_of
from elbowroom.planning.root.motion import NONE_SLOW, SLOWED_FROM
from elbowroom.world.ground.ground import Ground, heights_along

Floats = NDArray[np.float64]

_EVERY, _ABOUT = 0.12, 3  # metres between places that are looked at; of these before and behind each
_CLIMB = 0.4  # m/s up or down: some 0.6 m/s over treads of 17 by 28 cm
_EVEN = (
    0.72  # metres up or down in a metre, of treads that are counted whole: on an even stair; steeper ones are slower
)
_FLAT = 1e-3  # what is no steeper is level
_FELT = SLOWED_FROM + (_ABOUT + 1) * _EVERY  # metres beyond a stretch that count


def places_on(line: TravelLine, ahead: float, sight: float) -> Floats:
    """Places (N, 2), x and z, on `sight` metres of a line from `ahead` on, and as far beyond as what is there is felt.

    They lie at even steps from the line's first point, so they are the same from plan to plan.
    """
    steps = np.arange(math.floor((ahead - _FELT) / _EVERY), math.ceil((ahead + sight + _FELT) / _EVERY) + 1.0)
    return _at_steps(line, steps)


def places_along(way: Corners, legs: Iterable[int]) -> Floats:
    """The same all along some legs of a way, one after the other; at even steps from each leg's beginning."""
    lengths = [(leg, math.dist(way[leg], way[leg + 1])) for leg in legs]
    places = [_at_steps(line_of(way, leg), np.arange(float(math.ceil(length / _EVERY)))) for leg, length in lengths]
    return np.concatenate([*places, [way[lengths[-1][0] + 1]]])


def _at_steps(line: TravelLine, steps: Floats) -> Floats:
    return np.stack(line.point(_EVERY * steps, 0.0 * steps), axis=1)


def steep_places(ground: Ground, places: Floats, start: tuple[float, float, float], speed: float) -> Floats:
    """Places (K, 3), x, z and the share of the wanted `speed`, of those (N, 2) on a stretch that `start` is on.

    A body is at x, height and z there. No kerb or sill slows anybody down.
    """
    if ground.plain or speed <= 0.0:
        return NONE_SLOW
    x, height, z = start
    here = int(np.argmin(np.hypot(places[:, 0] - x, places[:, 1] - z)))
    back = np.ascontiguousarray(places[here::-1])
    behind, ahead = heights_along(ground, height, back), heights_along(ground, height, places[here:])
    heights = np.concatenate([behind[:0:-1], ahead])
    places, heights = places[np.isfinite(heights)], heights[np.isfinite(heights)]
    if len(places) < 2:
        return NONE_SLOW
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))])
    first = np.maximum(np.arange(len(places)) - _ABOUT, 0)
    last = np.minimum(np.arange(len(places)) + _ABOUT, len(places) - 1)
    rise = np.abs(heights[last] - heights[first])
    steep = rise / np.maximum(np.round(along[last] - along[first], 6), 2 * _ABOUT * _EVERY)
    share = _CLIMB * np.minimum(_EVEN / np.maximum(steep, _FLAT), 1.0) / (speed * np.maximum(steep, _FLAT))
    slow = (rise > ground.step) & (share < 1.0)
    found: Floats = np.column_stack([places[slow], share[slow]])
    return found
