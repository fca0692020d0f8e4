"""What a root path costs: the seconds that it loses against a walk as commanded, all by itself."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.root.legs.moving_legs import MovingAround
from elbowroom.planning.root.line.line import TravelLine
from elbowroom.planning.root.motion import wrapped
from elbowroom.planning.root.plan import RootPlannerSettings

Floats = NDArray[np.float64]

SLOW = 0.1  # m/s: who wants to go no faster is in no hurry

BodySize = tuple[float, float]  # half the breadth of a body that stands with hanging arms, and its height, metres


class Prices(NamedTuple):
    """What costs seconds besides being behind."""

    acceleration: float  # m/s^2: who starts slower than wanted is allowed the time that it takes to get faster
    dead_end: float  # seconds, of a route that ends before something
    aside: float  # seconds for each metre beside the line, and
    turned: float  # for each radian that the body is turned, over the whole path


def prices_of(settings: RootPlannerSettings) -> Prices:
    """The prices that these settings name."""
    return Prices(settings.motion.acceleration, settings.dead_end, settings.aside_cost, settings.turned_cost)


def seconds_lost(
    settings: RootPlannerSettings,
    line: TravelLine,
    speed: float,
    states: Floats,
    duration: float,
    *,
    ends: bool,
    around: MovingAround,
    size: BodySize,
) -> float:
    """What a path costs, states (n+1, 7) of `duration` seconds, against the line of travel at the wanted speed.

    `ends` says that its route ends before something.
    """
    lost = lost_on_line(prices_of(settings), line, speed, states, duration, ends)
    return lost if speed < SLOW else crowded(settings, lost, line, states, around, size)


def crowded(
    settings: RootPlannerSettings, lost: float, line: TravelLine, states: Floats, around: MovingAround, size: BodySize
) -> float:
    """What a path, states (n+1, 7), costs that loses so many seconds, with what moves beside it."""
    if not around:
        return lost
    crowd = settings.crowded * max(settings.polite - around.gap(states, *size), 0.0)
    return lost + settings.wrong_side * _leftward(line, states) + crowd


@exact_kernel
def lost_on_line(prices: Prices, line: TravelLine, speed: float, states: Floats, duration: float, ends: bool) -> float:
    """`seconds_lost` where nothing moves."""
    if speed < SLOW:
        return 0.0
    sine, cosine, count = np.sin(line.heading), np.cos(line.heading), states.shape[0]
    aside, turned = 0.0, 0.0
    for k in range(count):
        aside += abs((states[k, 0] - line.x) * cosine - (states[k, 1] - line.z) * sine)
        turned += abs(wrapped(states[k, 2] - line.facing))
    gained = (states[-1, 0] - states[0, 0]) * sine + (states[-1, 1] - states[0, 1]) * cosine
    slower = max(speed - np.hypot(states[0, 3], states[0, 4]), 0.0)
    behind = speed * duration - 0.5 * slower * slower / prices.acceleration - gained
    behind += speed * prices.dead_end * ends
    return float(behind / speed + prices.aside * (aside / count) + prices.turned * (turned / count))


def _leftward(line: TravelLine, states: Floats) -> float:
    """How much farther to the left of a line a path gets than where it begins, metres."""
    lefts = line.coordinates(states[:, 0], states[:, 1])[1]
    return max(float(lefts.max()) - max(float(lefts[0]), 0.0), 0.0)
