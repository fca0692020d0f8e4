"""Heels that rise because a leg comes out of reach: of a foot that is left behind, sooner where one climbs.

Who goes up stands on a foot below until the leg is straight, while the other one bears: hips that come down to it jump
when it is let go, and its knee snaps. So its heel rises by what the leg lacks, early enough to leave the knee bent, as
people's do. That is part of the foot's state, so it swings on from there; the walking cycle is made for the plane.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.cycle import walk_into
from elbowroom.body.gait.foot_state import LIFT, PITCH, ROLLING, SWING, YAW, X, Z
from elbowroom.body.gait.smoothstep import smoothstep
from elbowroom.body.gait.stride import CLIMB
from elbowroom.body.gait.tilted_foot import ease_of, tilt_foot
from elbowroom.body.root import FOOT, RISES, ROOT_STATE
from elbowroom.jit import helper, inner_exact_kernel

Floats = NDArray[np.float64]
Hip = tuple[float, float, float]  # where a leg's joint at the hip is, metres

_HIP, _ANKLE, _BALL, _THIGH, _SHIN, _TOES, _PITCH_DOWN = 0, 3, 6, 8, 9, 10, 11  # columns of `GaitShape.legs`
_BENT, _SOFTLY = 0.975, 0.015  # of a leg: how far from its hip a foot is left by who climbs, about so much of it
_STEEP = 0.6  # radians that its heel rises at most so
_CLIMBS, _BEHIND = 0.15, 0.14  # m/s up, and of its distance that it is behind its hip, at which it does so fully


@helper
def too_far(over: float, soft: float) -> float:
    """How much nearer something comes that is too far off by `over`: by that, or by nothing, and no sudden turn."""
    if over <= -soft:
        return 0.0
    return over if over >= soft else (over + soft) * (over + soft) / (4.0 * soft)


@helper
def distance(foot: Floats, hip: Hip) -> float:
    """How far a foot (6,) is from a hip, metres."""
    x, y, z = foot[0] - hip[0], foot[1] - hip[1], foot[2] - hip[2]
    return float(np.sqrt(x * x + y * y + z * z))


@helper
def behind(foot: Floats, hip: Hip) -> float:
    """How far behind its hip a foot is, of its distance."""
    ahead = (foot[0] - hip[0]) * np.sin(foot[3]) + (foot[2] - hip[2]) * np.cos(foot[3])
    return float(-ahead / distance(foot, hip))


@helper
def raise_heel(legs: Floats, side: int, flat: Floats, hip: Hip, nearer: float, steepest: float, foot: Floats) -> float:
    """Let the heel of a foot (6,) rise so that it comes so much `nearer` to its hip, metres; how it is pitched then."""
    height, ball = legs[side, _ANKLE + 1] - legs[side, _TOES], legs[side, _BALL]
    pitch, wanted = flat[PITCH], distance(foot, hip) - nearer
    for _ in range(2):
        far, sine, cosine = distance(foot, hip), np.sin(foot[4]), np.cos(foot[4])
        up, ahead = ball * cosine - height * sine, height * cosine + ball * sine
        by_radian = max(behind(foot, hip) * ahead + (hip[1] - foot[1]) / far * up, 0.5 * ball)
        pitch += min((far - wanted) / (legs[side, _PITCH_DOWN] * by_radian), max(steepest - pitch, 0.0))
        tilt_foot(legs, side, (flat[X], flat[Z], flat[YAW]), (pitch, flat[LIFT]), ease_of(1.0, flat[SWING]), foot)
    return float(pitch)


@helper
def _from_ground(flat: Floats, slope: float, hip: Hip) -> Hip:
    """A hip, seen from the place of a foot on ground that slopes, as if that were the plane."""
    sine, cosine, x, z = np.sin(flat[YAW]), np.cos(flat[YAW]), hip[0] - flat[X], hip[2] - flat[Z]
    ahead = x * sine + z * cosine
    moved = ahead * (np.cos(slope) - 1.0) - hip[1] * np.sin(slope)
    return hip[0] + moved * sine, ahead * np.sin(slope) + hip[1] * np.cos(slope), hip[2] + moved * cosine


@helper
def _let_rise(legs: Floats, side: int, drop: float, climbs: float, lie: tuple[float, float], flat: Floats) -> None:
    """Let the heel of a standing foot rise under hips that are below T-pose by a `drop`; `climbs`, 0 to 1, is how much.

    `lie` is how high the ground under it is, and how it slopes.
    """
    foot, length = np.empty(6), legs[side, _THIGH] + legs[side, _SHIN]
    tilt_foot(legs, side, (flat[X], flat[Z], flat[YAW]), (flat[PITCH], flat[LIFT]), ease_of(1.0, 0.0), foot)
    hip = (legs[side, _HIP], legs[side, _HIP + 1] - drop - lie[0], legs[side, _HIP + 2])
    much, hip = climbs * smoothstep(behind(foot, hip) / _BEHIND), _from_ground(flat, lie[1], hip)
    nearer = much * too_far(distance(foot, hip) - _BENT * length, _SOFTLY * length)
    if nearer > 0.0:
        flat[PITCH] = raise_heel(legs, side, flat, hip, nearer, _STEEP, foot)


@inner_exact_kernel
def let_heels_rise(legs: Floats, scale: float, before: Floats, dt: float, row: Floats) -> None:
    """Let heels rise of feet that stand in a row (WITH_FEET or more,) of who climbs, `dt` after the row `before`."""
    climbs, drops = smoothstep(row[CLIMB] / _CLIMBS), np.empty(1)
    if climbs <= 0.0 or dt <= 0.0:
        return
    walk_into(legs, scale, row.reshape((1, len(row))), np.empty((0, 2, 6)), drops, np.empty(6))
    for side in range(2):
        at, lie = ROOT_STATE + FOOT * side, RISES + 2 * side
        pitch = row[at + PITCH]
        if row[at + SWING] <= 0.0:
            _let_rise(legs, side, drops[0], climbs, (row[lie], row[lie + 1]), row[at:])
        if row[at + PITCH] > pitch:
            row[at + ROLLING] = (row[at + PITCH] - before[at + PITCH]) / dt
