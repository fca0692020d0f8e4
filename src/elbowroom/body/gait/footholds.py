"""Feet that stand where they came down, whatever the root does: a state of the feet that goes on from frame to frame.

The walking cycle of `gait` is a function of the root's state, so its feet slide whenever velocities change. Here each
foot has a state of its own: where it is, flat, in the root's frame, and how it is pitched and lifted. One that stands
stays where it is in the world. When the cycle wants it to swing it goes, without a jump of its place or its velocity,
to where it will be under the root in the middle of its stance, as the root is planned; it lands where it is then. At an
even walk that is the cycle. Who has come to rest puts the feet beside each other, one step after the other, and so
steps who turns in place.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.cycle import GaitShape, home_of
from elbowroom.body.gait.foot_state import PITCH, ROLLING, SWING, Goal, X, Z, carry, eased, is_flat
from elbowroom.body.gait.landing_places import (
    FARTHER,
    LANDS,
    LOWER,
    Stepper,
    borne_pitch,
    bound_for,
    landing_place,
    place_under,
    time_over,
    way_over,
)
from elbowroom.body.gait.own_steps import CYCLE, OwnSteps, own_roll, own_stride_at
from elbowroom.body.gait.stepping_times import (
    TO_REST,
    away_from,
    is_overtaken,
    landed_since,
    lifted_since,
    passed_ago,
    time_needed,
    time_to_landing,
    urge_to_step,
)
from elbowroom.body.gait.stride import Stride, stride_of
from elbowroom.body.gait.swinging import swing_foot
from elbowroom.body.root import FOOT, ROOT_STATE, WITH_FEET
from elbowroom.jit import brief_exact_kernel, brief_kernel, helper, inner_exact_kernel, plain

Floats = NDArray[np.float64]

_LEFT, _RIGHT = plain(0), plain(1)
_LAST, _MOMENT = 1.0 - 1e-9, 1e-4  # of a stance; of the cycle, over which it is seen how fast it goes
_ROLLS = 25.0  # 1/s: how soon what a foot that stands is pitched beside its cycle fades
_NEARLY_AT_REST = 0.3  # m/s of a standard leg: who goes slower may be about to stop, and keeps his heels down

ON_THE_PLANE = np.zeros((2, LANDS))  # how feet land there
UNKNOWN = np.empty((0, 1 + ROOT_STATE))  # nothing is known of where the root will come


@brief_kernel
def _beside(legs: Floats, scale: float, root: Floats, out: Floats) -> None:
    stride = stride_of(scale, 0.0, 0.0, 0.0)
    out[:] = 0.0
    for i in range(ROOT_STATE):
        out[i] = root[i]
    for side in range(2):
        at = ROOT_STATE + FOOT * side
        out[at + X], out[at + Z] = home_of(legs, stride, side)


@helper
def _pitch_at(own: OwnSteps, stride: Stride, side: int, u: float, pace: float, lands: Floats) -> Goal:
    """Pitch of the cycle at a place in its stance, and how fast it changes where that goes on at a pace, 1/s.

    Of a foot that `lands` (LANDS,) so.
    """
    first = min(u, stride.duty * _LAST - _MOMENT)
    before, _ = own_roll(own, stride, side, max(first, 0.0))
    after, _ = own_roll(own, stride, side, max(first, 0.0) + _MOMENT)
    pitch, _ = own_roll(own, stride, side, u)
    return borne_pitch(lands, pitch), pace * (borne_pitch(lands, after) - borne_pitch(lands, before)) / _MOMENT


@helper
def _roll_in_stance(
    own: OwnSteps, legs: Floats, stride: Stride, side: int, foot: Floats, dt: float, lands: Floats
) -> None:
    """Roll a standing foot by how far the root has passed it; flat under who comes to rest."""
    goes = min(stride.speed * stride.speed / (_NEARLY_AT_REST * _NEARLY_AT_REST * stride.scale), 1.0)
    u, most = 0.5 * stride.duty + goes * passed_ago(own, legs, stride, side, foot) / stride.period, stride.duty * _LAST
    then, later = min(max(u - goes * dt / stride.period, 0.0), most), min(max(u, 0.0), most)
    pace = goes / stride.period
    was, now = _pitch_at(own, stride, side, then, pace, lands), _pitch_at(own, stride, side, later, pace, lands)
    foot[PITCH], foot[ROLLING] = eased((foot[PITCH], foot[ROLLING]), was, now, _ROLLS, dt)


@brief_exact_kernel
def step_feet(
    who: Stepper, before: Floats, root: Floats, dt: float, coming: Floats, lands: Floats, out: Floats
) -> None:
    """The feet `dt` seconds later: `out` (WITH_FEET,) is for `root` (7,) what `before` (WITH_FEET,) was then.

    They step to where the root is meant to come: `coming` (m, 8), seconds from now and root states; where nothing is
    known of that it keeps its velocities; and as it `lands` (2, LANDS) there, see `landing_places`. With `dt` 0
    nothing moves over the ground, a swinging foot neither.
    """
    legs, scale, own = who.legs, who.scale, who.own
    carry(before, root, out)
    if dt <= 0.0:
        return
    stride = own_stride_at(own, scale, root)
    one, other = out[ROOT_STATE : ROOT_STATE + FOOT], out[ROOT_STATE + FOOT :]
    standing = one[SWING] <= 0.0 and other[SWING] <= 0.0
    lifted, later = -1, np.empty(ROOT_STATE)
    if standing:
        under = place_under(who, _LEFT, root, coming, 0.0, later)
        left = urge_to_step(own, legs, stride, _LEFT, root, one, under)
        under = place_under(who, _RIGHT, root, coming, 0.0, later)
        right = urge_to_step(own, legs, stride, _RIGHT, root, other, under)
        if max(left, right) > 0.0:
            lifted = 0 if left >= right else 1
    for side in range(2):
        foot, twin = (one, other) if side == 0 else (other, one)
        if foot[SWING] > 0.0 or lifted == side:
            since = dt
            if lifted == side:
                since = lifted_since(stride, side, root, dt)
                _roll_in_stance(own, legs, stride, side, foot, dt - since, lands[side])
            left = max(time_to_landing(own, legs, stride, side, root, foot, twin, since), 0.0)
            until = left if left > 0.0 else -landed_since(stride, side, root, dt)
            farther, way = lands[side, FARTHER], way_over(stride, lands[side, LOWER])
            goal = landing_place(who, side, root, twin, coming, until, farther, later)
            goal = bound_for(own, stride, side, foot, goal, since + left, way)
            needed = time_needed(stride, foot, goal)
            if left < needed and not is_overtaken(legs, 1 - side, twin):  # what it goes to has changed
                left, rest = needed, needed / (TO_REST * np.sqrt(scale))
                goal = landing_place(who, side, root, twin, coming, left, farther, later)
                foot[SWING] = min(foot[SWING], max(1.0 - rest, 0.2))
            swing_foot(own, stride, side, goal, (since, left), lands[side], foot, twin)
        else:
            _roll_in_stance(own, legs, stride, side, foot, dt, lands[side])


@inner_exact_kernel
def landing(
    who: Stepper, row: Floats, side: int, coming: Floats, lands: Floats, later: Floats
) -> tuple[float, float, float, float, float]:
    """Where a foot that swings in a row (WITH_FEET or more,) will land: x, z and yaw seen from the root.

    Then in how many seconds, and how many until it is over that place. `coming` (m, 8), seconds from the row, and how
    it `lands` (2, LANDS) are as in `step_feet`; `later` (7,) is scratch.
    """
    legs, scale, own = who.legs, who.scale, who.own
    foot, twin = row[ROOT_STATE + FOOT * side :], row[ROOT_STATE + FOOT * (1 - side) :]
    stride = own_stride_at(own, scale, row)
    left = max(time_to_landing(own, legs, stride, side, row, foot, twin, 0.0), 0.0)
    way = way_over(stride, lands[side, LOWER])
    goal = landing_place(who, side, row, twin, coming, left, lands[side, FARTHER], later)
    goal = bound_for(own, stride, side, foot, goal, left, way)
    left = max(left, time_needed(stride, foot, goal))
    return goal[0], goal[1], goal[2], left, time_over(foot, way, left)


@brief_kernel
def _settled(legs: Floats, scale: float, row: Floats) -> bool:
    stride, near = stride_of(scale, 0.0, 0.0, 0.0), True
    for side in range(2):
        foot = row[ROOT_STATE + FOOT * side : ROOT_STATE + FOOT * (side + 1)]
        x, z = home_of(legs, stride, side)
        still = foot[SWING] <= 0.0 and is_flat(foot)
        near = near and still and away_from(foot, (x, z, 0.0), scale) <= 1.0
    return near


def beside(gait: GaitShape, root: Floats) -> Floats:
    """A root state (7,) with feet that stand beside each other under it: (WITH_FEET,)."""
    out = np.empty(WITH_FEET)
    _beside(gait.legs, gait.scale, root, out)
    return out


def onward(
    gait: GaitShape, before: Floats, root: Floats, dt: float, coming: Floats = UNKNOWN, own: OwnSteps = CYCLE
) -> Floats:
    """`root` (7 or more,) with the feet (WITH_FEET,) that follow on those of `before` within `dt` seconds.

    `coming` (m, 8) are seconds from now and root states that the root is meant to come to. Steps ahead are a walker's
    `own`.
    """
    out = np.empty(WITH_FEET)
    who = Stepper(gait.legs, gait.scale, own)
    step_feet(who, before, root[:ROOT_STATE].copy(), dt, coming, ON_THE_PLANE, out)
    return out


def settled(gait: GaitShape, row: Floats) -> bool:
    """Whether the feet of a row (WITH_FEET,) stand beside each other, so that who rests makes no step."""
    return bool(_settled(gait.legs, gait.scale, row))
