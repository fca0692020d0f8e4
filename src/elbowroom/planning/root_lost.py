"""What a root path costs: the seconds that it loses against a walk as commanded, all by itself."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.root_line import TravelLine
from elbowroom.planning.root_motion import wrapped
from elbowroom.planning.root_moving import MovingAround
from elbowroom.planning.root_plan import RootPlannerSettings

Floats = NDArray[np.float64]

SLOW = 0.1  # m/s: who wants to go no faster is in no hurry

Figure = tuple[float, float]  # half the breadth of a body that stands with hanging arms, and its height, metres


def seconds_lost(
    settings: RootPlannerSettings,
    line: TravelLine,
    speed: float,
    states: Floats,
    duration: float,
    *,
    ends: bool,
    around: MovingAround,
    figure: Figure,
) -> float:
    """What a path costs, states (n+1, 7) of `duration` seconds, against the line of travel at the wanted speed.

    `ends` says that its way ends before something.
    """
    if speed < SLOW:
        return 0.0
    s = settings
    gained, aside, leftward, turned = _measured(states, line.x, line.z, line.heading, line.facing)
    slower = max(speed - float(np.hypot(*states[0, 3:5])), 0.0)
    behind = speed * duration - 0.5 * slower * slower / s.motion.acceleration - gained
    behind += speed * s.dead_end * ends
    lost = behind / speed + s.aside_cost * aside + s.turned_cost * turned
    if not around:
        return lost
    crowd = s.crowded * max(s.polite - around.gap(states, *figure), 0.0)
    return lost + s.wrong_side * leftward + crowd


@exact_kernel
def _measured(states: Floats, x: float, z: float, heading: float, facing: float) -> tuple[float, float, float, float]:
    """Metres gained along a line, mean distance from it, metres farther to its left than at first, mean turn."""
    sine, cosine, count = np.sin(heading), np.cos(heading), states.shape[0]
    aside, turned, leftmost = 0.0, 0.0, 0.0
    for k in range(count):
        left = (states[k, 0] - x) * cosine - (states[k, 1] - z) * sine
        aside += abs(left)
        turned += abs(wrapped(states[k, 2] - facing))
        leftmost = max(leftmost, left)
    dx, dz = states[-1, 0] - states[0, 0], states[-1, 1] - states[0, 1]
    first = (states[0, 0] - x) * cosine - (states[0, 1] - z) * sine
    return dx * sine + dz * cosine, aside / count, max(leftmost - max(first, 0.0), 0.0), turned / count
