"""The walk straight on where nothing is near: what most paths are, made in one piece.

Compiled code is entered once for it, where `RootQuery` enters it for each of its steps. What it says is what the query
would say; wherever something is near enough to be checked, it leaves the word to that.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import HEIGHT
from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel
from elbowroom.planning.root.cost import Prices, lost_on_line
from elbowroom.planning.root.legs.hull import LowBoxes, StrideHull, boxes_near, route_is_open, to_check
from elbowroom.planning.root.line.line import TravelLine, straight_route
from elbowroom.planning.root.motion import MotionBounds, Travel, follow, gets_nowhere
from elbowroom.world.obstacles.broad_phase import Grids

Floats = NDArray[np.float64]


@by_reference
class Walker(NamedTuple):
    """Who walks, and where: what does not change from plan to plan."""

    bounds: MotionBounds
    half: float  # metres: half the breadth of the strip that is free for the standing figure
    skin: float  # metres that posed legs keep
    hull: StrideHull
    boxes: LowBoxes  # what stands
    grids: Grids  # of it
    prices: Prices


class Outlook(NamedTuple):
    """How far a walk is looked at."""

    horizon: int  # key intervals
    interval: float  # seconds
    sight: float  # metres along the line that are checked
    reach: float  # metres: nothing farther from the start is met


@exact_kernel
def straight_walk(
    walker: Walker, start: Floats, line: TravelLine, speed: float, pace: float, outlook: Outlook, slow: Floats
) -> tuple[bool, Floats, bool, float, float, float]:
    """A walk from `start` (7,) along a line of travel, whose wanted speed it makes at a share `pace`.

    Returns whether nothing is near; if so, the states (n+1, 7), whether they get nowhere, the seconds that they lose,
    and x and z of the end of the route. It is slower at `slow` places, as in `Travel`, and loses nothing by that.
    """
    who, x, z = walker, start[0], start[1]
    states = np.empty((outlook.horizon + 1, start.shape[0]))
    boxes, route = boxes_near(who.boxes, who.grids, x, z, outlook.reach), straight_route(x, z, line, outlook.sight)
    ends = not route_is_open(route, start[HEIGHT] if start.shape[0] > HEIGHT else 0.0, who.half, boxes)
    if ends:
        return False, states, False, 0.0, 0.0, 0.0
    for c in range(start.shape[0]):
        states[0, c] = start[c]
    facing = line.facing - line.heading if line.turns else line.facing
    travel = Travel(pace * speed, facing, line.turns, ends, slow[:0], 1.0)
    follow(states, route, travel, outlook.interval, who.bounds)
    lost = lost_on_line(who.prices, line, speed, states, outlook.horizon * outlook.interval, ends)
    if slow.shape[0] > 0:
        follow(states, route, Travel(pace * speed, facing, line.turns, ends, slow, 1.0), outlook.interval, who.bounds)
    braking, swinging = who.bounds.braking, who.bounds.turn_acceleration
    moving, stopping = to_check(states, outlook.interval, braking, swinging, who.skin, who.hull, boxes)
    free = not (moving.any() or stopping.any())
    return free, states, gets_nowhere(states), lost, route[-1, 0], route[-1, 1]
