"""Slower where it is narrow, the narrower the slower, and in time.

As in K. Wilmut & A. L. Barnett, Hum. Mov. Sci. 29, 2010, who give no figures that hold for everybody.
"""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.narrow.places import EVERY, MARGIN, NarrowPlaces
from elbowroom.planning.root.line.line import TravelLine
from elbowroom.planning.root.motion import SLOWED_FROM

Floats = NDArray[np.float64]

_LESS = 0.25  # of the speed that arms which hang straight and nothing to spare take away
_LEAST = 0.6  # of the speed


def slow_places(narrow: NarrowPlaces, line: TravelLine, ahead: float, sight: float, height: float) -> Floats:
    """Places (K, 3), x, z and the share of the wanted speed, on `sight` metres of a line from a place `ahead` on.

    They lie at even steps from the line's first point, so they are the same from plan to plan.
    """
    first = math.floor((ahead - SLOWED_FROM) / EVERY)
    steps = EVERY * np.arange(first, math.ceil((ahead + sight + SLOWED_FROM) / EVERY) + 1.0)
    ways = np.empty((len(steps), 4))
    ways[:, 0], ways[:, 1] = line.point(steps, 0.0 * steps)
    ways[:, 2], ways[:, 3] = math.sin(line.heading), math.cos(line.heading)
    places = narrow.on(ways, height)
    lacking = narrow.figure.broad + MARGIN - places[:, 2]
    places[:, 2] = np.maximum(1.0 - _LESS * lacking / MARGIN, _LEAST)
    return places[lacking > 0.0]
