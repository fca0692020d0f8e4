"""Where feet that step land where ground is not a plane: on a tread and not across its edge, above it or below.

A foot that would land across an edge, or on a heel behind a ridge with nothing under it, lands a little farther ahead
or back: there it would slide as it turns about that heel, or about a ball in the air. Where no tread is long enough for
it, as little of it as can be is in the air, and it is not pitched about that: it comes down flat, or stays so. How
much lower than the other foot it does tells `footholds` when it has to be over its place.
"""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.foot_state import SWING, YAW, X, Z, carry
from elbowroom.body.gait.landing_places import (
    BALL_HANGS,
    FARTHER,
    HEEL_HANGS,
    LOWER,
    Stepper,
    landing_place,
)
from elbowroom.body.gait.own_steps import own_stride_at
from elbowroom.body.gait.stepping_times import time_to_landing
from elbowroom.body.root import FOOT, HEIGHT, RISES, ROOT_STATE, WITH_FEET
from elbowroom.jit import helper, inner_exact_kernel
from elbowroom.planning.model.footing import Underfoot, in_world, stood_at
from elbowroom.world.ground.ground import height_at, level_about

Floats = NDArray[np.float64]
FootPlace = tuple[float, float, float]  # x, z and yaw as seen from the root
Lie = tuple[float, float]  # height and slope of what a foot stands on or swings over

NO_GROUND = -math.inf  # the height of no ground
_AIR, _SHIFT = 0.02, 0.015  # metres under ankle and ball; metres by which a foot lands elsewhere
_TRIED, _FARTHEST = 8, 11  # so often; where even its ball is in the air
_LEVEL, _HOLLOW = 0.02, 0.006  # radians: less is level; metres under a heel
_PLACES = 8  # from the ankle to where toes begin
_TOES = 0.03  # metres of a standard leg, before the ball: with these on the ground it does not slide as it rolls
# How well a foot stands: on ankle, ball and toes, without toes, on its ball and half of what is behind it, on its toes,
# with so many of these places and more in the air, or nowhere.
_WHOLE, _NO_TOES, _ON_BALL, _ON_TOES, _IN_AIR, _NOWHERE = 0, 1, 2, 3, 4, _PLACES + 9
_BEHIND_BALL = 0.15  # of the way from ankle to ball
_BESIDE = 0.01  # metres of a standard leg by which a foot may land short of its place
_DOWN_TWO, _STEP = _IN_AIR, 0.25  # how much worse it stands deeper than a step; metres of a standard leg
_UNSTEADY = _ON_TOES  # and where it would stand on the edge behind it if it landed hardly short of there
_BALL, _HEEL = 6, 7  # columns of `GaitShape.legs`


@helper
def level_there(under: Underfoot, row: Floats, foot: Floats, goal: FootPlace) -> float:
    """The height of the ground where it is one level under a root, a foot and its goal; minus infinity where not."""
    low_x, high_x = min(0.0, foot[X], goal[0]), max(0.0, foot[X], goal[0])
    low_z, high_z = min(0.0, foot[Z], goal[1]), max(0.0, foot[Z], goal[1])
    around = math.hypot(max(under.sole.back, under.sole.ahead), under.sole.aside)
    x, z = in_world(row, 0.5 * (low_x + high_x), 0.5 * (low_z + high_z))
    reach = 0.5 * math.hypot(high_x - low_x, high_z - low_z) + around
    return level_about(under.ground, x, z, reach, row[HEIGHT])


@helper
def _moved(place: FootPlace, ahead: float) -> FootPlace:
    return place[0] + ahead * math.sin(place[2]), place[1] + ahead * math.cos(place[2]), place[2]


@helper
def _air(under: Underfoot, row: Floats, foot: FootPlace, ahead: float, lie: Lie) -> float:
    """How much air is under what is so far `ahead` of the ankle of a foot at a place that lies so there, metres."""
    x, z = in_world(row, foot[0] + ahead * math.sin(foot[2]), foot[1] + ahead * math.cos(foot[2]))
    return lie[0] - ahead * math.tan(lie[1]) - height_at(under.ground, x, z, lie[0])


@helper
def _rank(under: Underfoot, who: Stepper, row: Floats, side: int, foot: FootPlace) -> tuple[int, Lie]:
    """How well a foot would stand at a place, less is better; and how it would lie.

    It needs ground under its ankle and where its toes begin, or at least as far as that, or under its front half, not
    under its toes alone; where it would not lie level under its heel too, on which it comes down.
    """
    front, heel = who.legs[side, _BALL] + _TOES * who.scale, who.legs[side, _HEEL]
    lie = stood_at(under.ground, under.sole, row, foot[0], foot[1], foot[2])
    if lie[0] <= NO_GROUND:
        return _NOWHERE, lie
    toes = _air(under, row, foot, front, lie) < _AIR
    if toes or _air(under, row, foot, who.legs[side, _BALL], lie) < _AIR:
        stands = _air(under, row, foot, 0.0, lie) < _AIR
        level = abs(lie[1]) < _LEVEL or _air(under, row, foot, -heel, lie) < _HOLLOW
        if stands and level:
            return _WHOLE if toes else _NO_TOES, lie
        if toes:
            half = _air(under, row, foot, _BEHIND_BALL * who.legs[side, _BALL], lie) < _AIR
            return _ON_BALL if half else _ON_TOES, lie
    count = 0
    for k in range(_PLACES + 1):
        count += 1 if _air(under, row, foot, front * k / _PLACES, lie) >= _AIR else 0
    return _IN_AIR + count, lie


@helper
def _is_steady(under: Underfoot, row: Floats, foot: FootPlace, lie: Lie, beside: float) -> bool:
    """Whether a foot that lands so many metres behind its place is on no higher tread: the one that it came from."""
    x, z, yaw = _moved(foot, -beside)
    return bool(stood_at(under.ground, under.sole, row, x, z, yaw)[0] <= lie[0] + _AIR)


@inner_exact_kernel
def farther_onto(
    under: Underfoot, who: Stepper, row: Floats, side: int, goal: FootPlace, deepest: float
) -> tuple[float, Lie]:
    """How much farther ahead a foot has to land so that it stands on a tread and not across its edge, metres.

    As little as possible. Where that is not had within a few centimetres its toes hang in the air, or it stands on its
    ball, over which it rolls; where it does not do so either, it goes a little farther, and as little of it as can be
    is in the air. And how it lies there.

    It goes to the next tread, not to the one after it: to none lower than `deepest`, metres in the world, where another
    will do.
    """
    best, farther, lies = _NOWHERE, 0.0, (NO_GROUND, 0.0)
    for k in range(2 * _FARTHEST + 1):
        ahead = _SHIFT * who.scale * ((k + 1) // 2) * (1.0 if k % 2 == 0 else -1.0)
        place = _moved(goal, ahead)
        rank, lie = _rank(under, who, row, side, place)
        rank += _DOWN_TWO if lie[0] < deepest else 0
        if rank < min(best, _IN_AIR) and not _is_steady(under, row, place, lie, _BESIDE * who.scale):
            rank += _UNSTEADY
        if rank < best:
            best, farther, lies = rank, ahead, lie
        if best == _WHOLE or (best <= _ON_BALL and k >= 2 * _TRIED):
            break
    return float(farther), lies


@helper
def set_landings(
    under: Underfoot, who: Stepper, before: Floats, root: Floats, coming: Floats, lands: Floats, later: Floats
) -> None:
    """Set how feet land (2, LANDS) under a root state, or stand, on after the row `before`: as `step_feet` takes it.

    One that is bound for a place already has been told, and goes where it was going.
    """
    row, legs, scale, own = np.empty(WITH_FEET), who.legs, who.scale, who.own
    stride = own_stride_at(own, scale, root)
    carry(before, root, row)
    for side in range(2):
        foot, at, lie = row[ROOT_STATE + FOOT * side :], RISES + 2 * side, (NO_GROUND, 0.0)
        twin, stood = row[ROOT_STATE + FOOT * (1 - side) :], before[RISES + 2 * (1 - side)] + before[HEIGHT]
        place = foot[X], foot[Z], foot[YAW]
        if foot[SWING] > 0.0:
            left = max(time_to_landing(own, legs, stride, side, row, foot, twin, 0.0), 0.0)
            place = landing_place(who, side, row, twin, coming, left, 0.0, later)
            if level_there(under, row, foot, place) <= NO_GROUND:
                lands[side, FARTHER], lie = farther_onto(under, who, row, side, place, stood - _STEP * scale)
                apart = math.hypot(place[0] - twin[X], place[1] - twin[Z])
                falls = stood - lie[0] - math.tan(max(lie[1], 0.0)) * apart
                lands[side, LOWER] = falls if lie[0] > NO_GROUND else 0.0
                place = _moved(place, lands[side, FARTHER])
        elif level_there(under, row, foot, place) <= NO_GROUND:
            lie = before[at] + before[HEIGHT], before[at + 1]
        if lie[0] > NO_GROUND:
            lands[side, HEEL_HANGS] = 1.0 if _air(under, row, place, -legs[side, _HEEL], lie) >= _HOLLOW else 0.0
            lands[side, BALL_HANGS] = 1.0 if _air(under, row, place, legs[side, _BALL], lie) >= _AIR else 0.0
