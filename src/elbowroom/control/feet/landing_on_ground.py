"""Where feet that step land where ground is not a plane: on a tread and not across its edge, above it or below.

A foot that would land across an edge, or on a heel behind a ridge with nothing under it, lands a little farther ahead
or back: there it would slide as it turns about that heel, or about a ball in the air. Where no tread is long enough for
it, as little of it as can be is in the air. How much lower than the other foot it does tells `footholds`
when it has to be over its place.
"""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.foot_state import SWING, X, Z, carry
from elbowroom.body.gait.landing_places import FARTHER, LOWER, Stepper, landing_place
from elbowroom.body.gait.own_steps import own_stride_at
from elbowroom.body.gait.stepping_times import time_to_landing
from elbowroom.body.root import FOOT, HEIGHT, RISES, ROOT_STATE, WITH_FEET
from elbowroom.jit import helper, inner_exact_kernel
from elbowroom.planning.model.footing import Underfoot, in_world, stood_at
from elbowroom.world.ground.ground import height_at, level_about

Floats = NDArray[np.float64]
Place = tuple[float, float, float]  # x, z and yaw as seen from the root
Lie = tuple[float, float]  # height and slope of what a foot stands on or swings over

NO_GROUND = -math.inf  # the height of no ground
_AIR, _SHIFT, _TRIED = 0.02, 0.015, 8  # metres under ankle and ball; metres by which a foot lands elsewhere, so often
_LEVEL, _HOLLOW = 0.02, 0.006  # radians: less is level; metres under a heel
_PLACES = 8  # from ankle to ball
# How well a foot stands: on ankle and ball, on its ball, with so many of these places and more in the air, or nowhere.
_WHOLE, _ON_BALL, _IN_AIR, _NOWHERE = 0, 1, 2, _PLACES + 4
_BALL, _HEEL = 6, 7  # columns of `GaitShape.legs`


@helper
def level_there(under: Underfoot, row: Floats, foot: Floats, goal: Place) -> float:
    """The height of the ground where it is one level under a root, a foot and its goal; minus infinity where not."""
    low_x, high_x = min(0.0, foot[X], goal[0]), max(0.0, foot[X], goal[0])
    low_z, high_z = min(0.0, foot[Z], goal[1]), max(0.0, foot[Z], goal[1])
    around = math.hypot(max(under.sole.back, under.sole.ahead), under.sole.aside)
    x, z = in_world(row, 0.5 * (low_x + high_x), 0.5 * (low_z + high_z))
    reach = 0.5 * math.hypot(high_x - low_x, high_z - low_z) + around
    return level_about(under.ground, x, z, reach, row[HEIGHT])


@helper
def _bears(under: Underfoot, row: Floats, foot: Place, ball: float, heel: float) -> tuple[bool, bool, Lie]:
    """Whether a foot at a place would have ground under its ankle, and under its ball: not under its toes alone.

    Where it would not lie level, under its heel too, on which it comes down. And how it would lie.
    """
    lies, slope = stood_at(under.ground, under.sole, row, foot[0], foot[1], foot[2])
    x, z = in_world(row, foot[0], foot[1])
    ankle = height_at(under.ground, x, z, lies)
    x, z = in_world(row, foot[0] + ball * math.sin(foot[2]), foot[1] + ball * math.cos(foot[2]))
    front = height_at(under.ground, x, z, lies) + ball * math.tan(slope)
    x, z = in_world(row, foot[0] - heel * math.sin(foot[2]), foot[1] - heel * math.cos(foot[2]))
    back = height_at(under.ground, x, z, lies) - heel * math.tan(slope)
    stands = lies - ankle < _AIR and (abs(slope) < _LEVEL or lies - back < _HOLLOW)
    return lies > NO_GROUND and stands, lies > NO_GROUND and lies - front < _AIR, (lies, slope)


@helper
def _in_air(under: Underfoot, row: Floats, foot: Place, ball: float, lie: Lie) -> int:
    """How many places from ankle to ball have no ground under them, of a foot at a place that lies so there."""
    count = 0
    for k in range(_PLACES + 1):
        ahead = ball * k / _PLACES
        x, z = in_world(row, foot[0] + ahead * math.sin(foot[2]), foot[1] + ahead * math.cos(foot[2]))
        air = lie[0] - ahead * math.tan(lie[1]) - height_at(under.ground, x, z, lie[0])
        count += 1 if air >= _AIR else 0
    return count


@helper
def _rank(under: Underfoot, row: Floats, foot: Place, ball: float, heel: float) -> tuple[int, Lie]:
    """How well a foot would stand at a place, less is better; and how it would lie."""
    back, front, lie = _bears(under, row, foot, ball, heel)
    if lie[0] <= NO_GROUND:
        return _NOWHERE, lie
    if front:
        return _WHOLE if back else _ON_BALL, lie
    return _IN_AIR + _in_air(under, row, foot, ball, lie), lie


@inner_exact_kernel
def farther_onto(under: Underfoot, who: Stepper, row: Floats, side: int, goal: Place) -> tuple[float, Lie]:
    """How much farther ahead a foot has to land so that it stands on a tread and not across its edge, metres.

    As little as possible. Where that is not had within a few centimetres it stands on its ball, over which it rolls;
    where it does not do so either, as little of it as can be is in the air. And how it lies there.
    """
    ball, heel, scale = who.legs[side, _BALL], who.legs[side, _HEEL], who.scale
    best, farther, lies = _NOWHERE, 0.0, (NO_GROUND, 0.0)
    for k in range(2 * _TRIED + 1):
        ahead = _SHIFT * scale * ((k + 1) // 2) * (1.0 if k % 2 == 0 else -1.0)
        place = goal[0] + ahead * math.sin(goal[2]), goal[1] + ahead * math.cos(goal[2]), goal[2]
        rank, lie = _rank(under, row, place, ball, heel)
        if rank < best:
            best, farther, lies = rank, ahead, lie
        if best == _WHOLE:
            break
    return float(farther), lies


@helper
def set_landings(
    under: Underfoot, who: Stepper, before: Floats, root: Floats, coming: Floats, lands: Floats, later: Floats
) -> None:
    """Set how feet that swing land (2, 2) under a root state, on after the row `before`: as `step_feet` takes it.

    One that is bound for a place already has been told, and goes where it was going.
    """
    row, legs, scale, own = np.empty(WITH_FEET), who.legs, who.scale, who.own
    stride = own_stride_at(own, scale, root)
    carry(before, root, row)
    for side in range(2):
        foot = row[ROOT_STATE + FOOT * side :]
        if foot[SWING] > 0.0:
            twin, at = row[ROOT_STATE + FOOT * (1 - side) :], RISES + 2 * (1 - side)
            left = max(time_to_landing(own, legs, stride, side, row, foot, twin, 0.0), 0.0)
            x, z, yaw = landing_place(who, side, row, twin, coming, left, 0.0, later)
            if level_there(under, row, foot, (x, z, yaw)) == NO_GROUND:
                lands[side, FARTHER], (height, slope) = farther_onto(under, who, row, side, (x, z, yaw))
                apart = math.hypot(x - twin[X], z - twin[Z])
                falls = before[at] + before[HEIGHT] - height - math.tan(max(slope, 0.0)) * apart
                lands[side, LOWER] = falls if height > NO_GROUND else 0.0
