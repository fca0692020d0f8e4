"""Slower where it is narrow, the narrower the slower, and where it is low, the lower the slower; and in time.

As in K. Wilmut & A. L. Barnett, Hum. Mov. Sci. 29, 2010, who give no figures that hold for everybody; those for ducking
are ours.
"""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.narrow.build import Build
from elbowroom.planning.narrow.overhead import LEAST, SPARE, low_places
from elbowroom.planning.narrow.places import EVERY, MARGIN, NarrowPlaces
from elbowroom.planning.root.line.line import TravelLine
from elbowroom.planning.root.motion import SLOWED_FROM
from elbowroom.world.ground.ground import Ground
from elbowroom.world.obstacles.obstacles import EVERY_HEIGHT, Span

Floats = NDArray[np.float64]

_LESS = 0.25  # of the speed that arms which hang straight and nothing to spare take away
_LEAST = 0.6  # of the speed
_DUCKED = 1.0  # of the speed that is taken away for each part of one's height that one has to be lower


def slow_places(narrow: NarrowPlaces, line: TravelLine, ahead: float, sight: float, height: float) -> Floats:
    """Narrow places (K, 3), x, z and the share of the wanted speed, on `sight` metres of a line from `ahead` on.

    They lie at even steps from the line's first point, so they are the same from plan to plan.
    """
    places = narrow.on(_ways(line, ahead, sight), height)
    lacking = narrow.build.broad + MARGIN - places[:, 2]
    places[:, 2] = np.maximum(1.0 - _LESS * lacking / MARGIN, _LEAST)
    return places[lacking > 0.0]


def slow_under(narrow: NarrowPlaces, line: TravelLine, ahead: float, sight: float, height: float) -> Floats:
    """Low places (K, 3), as `slow_places` has narrow ones."""
    places, tall = low_places(narrow, _ways(line, ahead, sight), height), narrow.build.tall
    places[:, 2] = np.maximum(1.0 - _DUCKED * (tall + SPARE - places[:, 2]) / tall, _LEAST)
    return places


def hanging(build: Build, ground: Ground) -> Span:
    """The heights in which something may hang that makes a way low; anywhere, where the ground is not plain."""
    return (LEAST * build.tall, build.tall + SPARE) if ground.plain else EVERY_HEIGHT


def _ways(line: TravelLine, ahead: float, sight: float) -> Floats:
    """Places and directions (N, 4) on a line, as far as what is there is felt."""
    first = math.floor((ahead - SLOWED_FROM) / EVERY)
    steps = EVERY * np.arange(first, math.ceil((ahead + sight + SLOWED_FROM) / EVERY) + 1.0)
    ways = np.empty((len(steps), 4))
    ways[:, 0], ways[:, 1] = line.point(steps, 0.0 * steps)
    ways[:, 2], ways[:, 3] = math.sin(line.heading), math.cos(line.heading)
    return ways
