"""Where feet that stand and step put ankles and hips: those of `footholds`, as `gait` has those of the walking cycle.

Hips are where the cycle has them. Where a leg would be too short for that, its foot comes nearer, as people's do: the
heel of one that is behind rises, and one that swings is lifted. For what is left the hips come down. None of them turns
suddenly: a leg that is let go in one frame has a knee that snaps.

On ground that is not the root's plane feet are raised to what each of them stands on, or swings over, as those of the
cycle are (`rises`): pitched and lifted as in the same stride on the plane, which tells how deep their capsules lie. The
hips come down to them: legs are as bent there as those of the cycle.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.carriage import carried_hip
from elbowroom.body.gait.cycle import too_high, walk_into
from elbowroom.body.gait.foot_state import LIFT, PITCH, SWING, YAW, X, Z
from elbowroom.body.gait.heels import Hip, behind, distance, raise_heel, too_far
from elbowroom.body.gait.lowered_hips import hips_sink
from elbowroom.body.gait.rises import STRETCH, is_uneven, raise_foot
from elbowroom.body.gait.smoothstep import smoothstep
from elbowroom.body.gait.tilted_foot import ease_of, tilt_foot
from elbowroom.body.root import FOOT, RISES, ROOT_STATE
from elbowroom.jit import helper, kernel

Floats = NDArray[np.float64]

_HIP, _THIGH, _SHIN = 0, 8, 9  # columns of `GaitShape.legs`
_STRETCH = 0.99885  # of a leg: no foot is farther from its hip
_SOFTLY, _HARDLY = 0.012, 0.003  # of a leg, about that, in which hips come down; the same for a foot whose heel rises
_UNEVEN = 0.02  # metres that ground rises or falls under the feet, from which on legs are bent as in the cycle there
_GENTLY, _STEEPEST = 0.007, 1.1  # of a leg, about its length, in which a heel rises; radians that it does so at most
_BEHIND = 0.14  # of its distance, that a foot is behind its hip whose heel begins to rise; twice as much, and all of it
_UP = 0.02  # of a leg that a swinging foot is lifted by at most for that
_LIFTED, _LANDS = 0.3, 30  # of its swing, from which on it is; the power of it by which it is not, as it lands


@helper
def _trails(foot: Floats, hip: Hip) -> float:
    """How much a foot is one that is left behind, 0 to 1."""
    return smoothstep((behind(foot, hip) - _BEHIND) / _BEHIND)


@helper
def _let_rise(legs: Floats, side: int, flat: Floats, hip: Hip, foot: Floats) -> None:
    """Let the heel of a foot (6,) rise that is behind its hip, so that it comes as near as the leg reaches."""
    length = legs[side, _THIGH] + legs[side, _SHIN]
    nearer = _trails(foot, hip) * too_far(distance(foot, hip) - _STRETCH * length, _GENTLY * length)
    if nearer > 0.0:
        raise_heel(legs, side, flat, hip, nearer, _STEEPEST, foot)


@helper
def _lift(legs: Floats, side: int, swung: float, hip: Hip, foot: Floats) -> None:
    """Lift a swinging foot (6,) whose leg is too short; as it lands, and has just left the ground, the hips give."""
    length, share = legs[side, _THIGH] + legs[side, _SHIN], smoothstep(swung / _LIFTED) * (1.0 - swung**_LANDS)
    foot[1] += share * min(too_far(too_high(foot, hip, _STRETCH * length), _SOFTLY * length), _UP * length)


@helper
def _put(legs: Floats, side: int, row: Floats, hip: Hip, foot: Floats) -> None:
    """The foot (6,) of a row, as near to a hip as it would come on the plane, on the ground that the row tells of."""
    flat, rise, slope = row[ROOT_STATE + FOOT * side :], row[RISES + 2 * side], row[RISES + 2 * side + 1]
    place, pitch = (flat[X], flat[Z], flat[YAW]), (flat[PITCH], flat[LIFT])
    tilt_foot(legs, side, place, pitch, ease_of(1.0, flat[SWING]), foot)
    _let_rise(legs, side, flat, hip, foot)
    if flat[SWING] > 0.0:
        _lift(legs, side, flat[SWING], hip, foot)
    if is_uneven(row):
        ahead = (foot[0] - flat[X]) * np.sin(foot[3]) + (foot[2] - flat[Z]) * np.cos(foot[3])
        raise_foot(foot, ahead, rise, slope)


@helper
def _dropped(legs: Floats, drop: float, stretch: float, bent: float, feet: Floats) -> float:
    """How far below T-pose upright hips, so far below it, come to feet (2, 6) on uneven ground."""
    for side in range(2):
        reach = stretch * (legs[side, _THIGH] + legs[side, _SHIN])
        hip = (legs[side, _HIP], legs[side, _HIP + 1] - drop, legs[side, _HIP + 2])
        drop += bent * too_far(too_high(feet[side], hip, reach), _SOFTLY * reach)
    return drop


@kernel
def posed_feet(legs: Floats, scale: float, half_leg: float, rows: Floats, lowerings: Floats) -> tuple[Floats, Floats]:
    """Feet (N, 2, 6) as in `gait.foot_poses`, and sinks of the hips (N, 3) as in `gait.hips_sinks`.

    For rows (N, WITH_FEET or SHOWN) and lowerings (N,).
    """
    feet, sinks, drops = np.empty((len(rows), 2, 6)), np.empty((len(rows), 3)), np.empty(len(rows))
    walk_into(legs, scale, rows, np.empty((0, 2, 6)), drops, np.empty(6))
    for n in range(len(rows)):
        row = rows[n]
        down, back, lean = hips_sink(half_leg, drops[n], lowerings[n])
        for side in range(2):
            x, y, z = carried_hip(legs, row, lean, side)
            _put(legs, side, row, (x, y - down, z - back), feet[n, side])
        bent = min((abs(row[RISES]) + abs(row[RISES + 2])) / _UNEVEN, 1.0)
        stretch = _STRETCH + bent * (STRETCH - _STRETCH)
        if bent > 0.0:
            down += _dropped(legs, drops[n], stretch, bent, feet[n]) - drops[n]
        for side in range(2):
            reach = stretch * (legs[side, _THIGH] + legs[side, _SHIN])
            x, y, z = carried_hip(legs, row, lean, side)
            hip = (x, y - down, z - back)
            soft = _SOFTLY + _trails(feet[n, side], hip) * (_HARDLY - _SOFTLY)
            down += too_far(too_high(feet[n, side], hip, reach), soft * reach)
        sinks[n, 0], sinks[n, 1], sinks[n, 2] = down, back, lean
    return feet, sinks
