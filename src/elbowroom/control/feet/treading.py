"""What feet that step stand on where ground is not a plane: a state that goes on from frame to frame, as `footholds`.

A foot that stands keeps its height and its slope in the world, whatever the root does. One that swings goes to those of
the ground where it will land, over what is in between, without a jerk: by a cubic to where it lands, or to a height
that it has to have by the time that it is over what lies ahead.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.foot_state import RISING, SWING, VELOCITY, YAW, X, Z
from elbowroom.body.gait.footholds import landing, step_feet
from elbowroom.body.gait.heels import let_heels_rise
from elbowroom.body.gait.landing_places import LANDS, Stepper
from elbowroom.body.root import FOOT, HEIGHT, RISES, ROOT_STATE, WITH_FEET
from elbowroom.control.feet.landing_on_ground import NO_GROUND, Lie, level_there, set_landings
from elbowroom.jit import helper, inner_exact_kernel
from elbowroom.planning.model.footing import OVER, Underfoot, in_world, stood_at
from elbowroom.world.ground.ground import height_along, under_body
from elbowroom.world.ground.swept import set_highest_under

Floats = NDArray[np.float64]
# x, z and yaw as seen from the root, seconds until a foot lands there, and until it is over that place
Landing = tuple[float, float, float, float, float]
Rising = tuple[float, float]  # how high a foot is, and how fast it rises

_LEVEL, _TILTED = 0.002, 0.02  # metres, radians: so much is no step, and no other slope
_LOOKS = 8  # places of the rest of a swing that are looked at
_SOON = 1e-3  # seconds: who will be over his place so soon is there
_NEAR = 1e-4  # m²: who is no farther from where a foot lands goes there as it comes
HASTY, TURNS = 4.0, 4.0  # m/s that a foot rises or comes down by at most; radians that its sole may turn for a metre
_UP, _SPURT = 3.0, 45.0  # m/s that a foot rises by at most, and m/s² by which that changes
_GLIDES = 1.5  # m/s that a foot that glides rises or comes down by at most, over what it does not come against
_SLIGHT = 1e-3  # metres: what a foot comes against by less is not gone over
_EASE = 2.0  # how much faster than evenly a sole is tilted: the power of the time that is left


@helper
def _towards(rising: Rising, goal: float, time: float, after: float) -> float:
    """How high a foot is `after` some seconds that comes to rest at a height in `time`: a cubic.

    Without a jump of its velocity.
    """
    part = min(after / time, 1.0)
    rest = 1.0 - part
    return (
        rest * rest * ((1.0 + 2.0 * part) * rising[0] + part * rising[1] * time)
        + part * part * (3.0 - 2.0 * part) * goal
    )


@helper
def _needed(
    under: Underfoot, row: Floats, foot: Floats, was: Lie, goal: Landing, ends: Lie, dt: float
) -> tuple[float, float]:
    """How high a swinging foot goes on that `was` so high and sloped so much `dt` seconds ago, and how high it has to.

    It goes to where it `ends`, as `footholds` has it, smoothly, and over what it would come against on its way there.
    """
    ground, (x, z), (to_x, to_z) = under.ground, in_world(row, foot[X], foot[Z]), in_world(row, goal[0], goal[1])
    (left, over_there), lands, rising = goal[3:], ends[0], (was[0], foot[RISING])
    near = height_along(ground, (row[0], under_body(ground, row[0], row[HEIGHT], row[1]), row[1]), x, z)
    near, shares, overs = near if near > NO_GROUND else row[HEIGHT], np.empty(_LOOKS), np.empty(_LOOKS)
    ahead, aside = goal[0] - foot[X], goal[1] - foot[Z]
    faster = ahead * foot[VELOCITY] + aside * foot[VELOCITY + 1]
    faster *= over_there / max(ahead * ahead + aside * aside, _NEAR)
    for k in range(_LOOKS):
        u = min(k / _LOOKS * left / max(over_there, _SOON), 1.0)
        shares[k] = min(max(u * u * (3.0 - 2.0 * u) + (1.0 - u) ** 2 * u * faster, 0.0), 1.0)
    way = (x, z, row[2] + foot[YAW], was[1]), (to_x, to_z, row[2] + goal[2], ends[1])
    set_highest_under(ground, under.sole, way[0], way[1], near, shares, overs)
    wanted, falls = _towards(rising, lands, left + dt, dt), max(overs[0] - lands, 0.0) if overs[0] > NO_GROUND else 0.0
    for k in range(_LOOKS):
        if overs[k] > NO_GROUND:
            over = OVER * ground.step if overs[k] > lands + (1.0 - shares[k]) * falls + _LEVEL else 0.0
            until = k / _LOOKS * left + dt
            if overs[k] + over > _towards(rising, lands, left + dt, until) + _SLIGHT:
                wanted = max(wanted, _towards(rising, overs[k] + over, until, dt))
    return wanted, overs[0]


@helper
def _swung(under: Underfoot, row: Floats, side: int, goal: Landing, was: Lie, dt: float) -> Lie:
    """Height and slope of a swinging foot that `was` so high and tilted `dt` seconds ago; how fast it rises is set."""
    foot, place, left = row[ROOT_STATE + FOOT * side :], (goal[0], goal[1], goal[2]), goal[3]
    level = level_there(under, row, foot, place)
    lands, slope = level, 0.0
    if level == NO_GROUND:
        lands, slope = stood_at(under.ground, under.sole, row, place[0], place[1], place[2])
    if lands == NO_GROUND:
        return was
    if level > NO_GROUND:
        wanted, least = _towards((was[0], foot[RISING]), level, left + dt, dt), level
    else:
        wanted, least = _needed(under, row, foot, was, goal, (lands, slope), dt)
    rate = min(max((wanted - was[0]) / dt, foot[RISING] - _SPURT * dt), foot[RISING] + _SPURT * dt)
    rate = min(max(rate, -HASTY, (least - was[0]) / dt), _UP)
    foot[RISING] = rate
    part = min(_EASE * dt / (left + dt), 1.0)
    return was[0] + rate * dt, was[1] + part * (slope - was[1])


@inner_exact_kernel
def _settled(under: Underfoot, row: Floats, side: int, was: Lie, most: float) -> Lie:
    """Height and slope of a foot that stands, and was so high and tilted: those of its ground, or nearer to them.

    It rises or comes down by no more than `most` metres.
    """
    foot = row[ROOT_STATE + FOOT * side :]
    height, slope = level_there(under, row, foot, (foot[X], foot[Z], foot[YAW])), 0.0
    if height == NO_GROUND:
        height, slope = stood_at(under.ground, under.sole, row, foot[X], foot[Z], foot[YAW])
    if height == NO_GROUND or (abs(height - was[0]) < _LEVEL and abs(slope - was[1]) < _TILTED):
        return was
    turn = TURNS * most
    return was[0] + min(max(height - was[0], -most), most), was[1] + min(max(slope - was[1], -turn), turn)


@inner_exact_kernel
def step_on(
    under: Underfoot, who: Stepper, before: Floats, root: Floats, dt: float, coming: Floats, out: Floats
) -> None:
    """`step_feet` on any ground: the feet, and what they stand on, `dt` seconds after the row `before`.

    To `out` (WITH_FEET or more,). On the plane that is all of it; elsewhere feet that would land across an edge land a
    little farther ahead or back, and heels rise under who climbs.
    """
    lands, later = np.zeros((2, LANDS)), np.empty(ROOT_STATE)
    if not under.ground.plain and dt > 0.0:
        set_landings(under, who, before, root, coming, lands, later)
    step_feet(who, before, root, dt, coming, lands, out[:WITH_FEET])
    for side in range(0 if under.ground.plain else 2):
        at, swing = RISES + 2 * side, ROOT_STATE + FOOT * side + SWING
        height, slope = before[at] + before[HEIGHT], before[at + 1]
        if dt > 0.0 and out[swing] > 0.0:
            goal = landing(who, out, side, coming, lands, later)
            height, slope = _swung(under, out, side, goal, (height, slope), dt)
        elif dt > 0.0:
            height, slope = _settled(under, out, side, (height, slope), HASTY * dt)
        out[at], out[at + 1] = height - out[HEIGHT], slope
    let_heels_rise(who.legs, who.scale, before, dt, out)


@inner_exact_kernel
def tread_gliding(under: Underfoot, who: Stepper, before: Floats, row: Floats, dt: float, holds: bool) -> None:
    """The same for feet that glide: they are as high as the row tells, and no deeper than what is under them.

    If it `holds`, one that stands keeps what it stands on.
    """
    for side in range(2):
        at, foot = RISES + 2 * side, row[ROOT_STATE + FOOT * side :]
        was, now = before[at] + before[HEIGHT], row[at] + row[HEIGHT]
        if holds and foot[SWING] <= 0.0:
            now, row[at + 1] = _settled(under, row, side, (was, before[at + 1]), HASTY * dt)
        else:
            lies, _ = stood_at(under.ground, under.sole, row, foot[X], foot[Z], foot[YAW])
            if foot[SWING] > 0.0:
                now = min(max(now, was - _GLIDES * dt), was + _GLIDES * dt)
            now = max(now, min(lies, was + HASTY * dt))
        row[at] = now - row[HEIGHT]
    if holds:
        let_heels_rise(who.legs, who.scale, before, dt, row)
