"""Where feet that stand and step put ankles and hips: those of `footholds`, as `gait` has those of the walking cycle.

Hips are where the cycle has them, or lower where a foot would be out of reach. On ground that is not the root's plane
feet are raised to what each of them stands on, or swings over, as those of the cycle are (`rises`).
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.carriage import carried_hip
from elbowroom.body.gait.cycle import ease_of, tilt_foot, walk_into
from elbowroom.body.gait.foot_state import LIFT, PITCH, SWING, YAW, X, Z
from elbowroom.body.gait.lowered_hips import hips_sink
from elbowroom.body.gait.rises import STRETCH, drop_to, is_uneven, raise_foot
from elbowroom.body.root import FOOT, RISES, ROOT_STATE
from elbowroom.jit import helper, kernel

Floats = NDArray[np.float64]

_THIGH, _SHIN = 8, 9  # columns of `GaitShape.legs`
_STRETCH = 0.9985  # of a leg: no foot is farther from its hip
_SOFTLY = 0.0075  # of a leg, about the place of the hips from where on a foot is out of reach, in which they come down
_UNEVEN = 0.02  # metres that ground rises or falls under the feet, from which on legs are bent as in the cycle there


@helper
def _raised(legs: Floats, side: int, row: Floats, foot: Floats) -> float:
    """Put a foot (6,) on the ground that a row tells of; how far below T-pose the hips are for that, metres."""
    at, rise, slope = ROOT_STATE + FOOT * side, row[RISES + 2 * side], row[RISES + 2 * side + 1]
    ahead = (foot[0] - row[at + X]) * np.sin(foot[3]) + (foot[2] - row[at + Z]) * np.cos(foot[3])
    raise_foot(foot, ahead, rise, slope)
    part = min((abs(row[RISES]) + abs(row[RISES + 2])) / _UNEVEN, 1.0)
    return drop_to(legs, side, foot, _STRETCH + part * (STRETCH - _STRETCH))


@helper
def _pulled(down: float, needed: float, soft: float) -> float:
    """How far hips come down that are so far `down` and that a foot needs lower: the greater, and no sudden turn."""
    over = needed - down
    if over <= -soft:
        return down
    return needed if over >= soft else down + (over + soft) * (over + soft) / (4.0 * soft)


@kernel
def posed_feet(legs: Floats, scale: float, half_leg: float, rows: Floats, lowerings: Floats) -> tuple[Floats, Floats]:
    """Feet (N, 2, 6) as in `gait.foot_poses`, and sinks of the hips (N, 3) as in `gait.hips_sinks`.

    For rows (N, WITH_FEET or SHOWN) and lowerings (N,). Hips come down where a foot would be out of reach.
    """
    feet, sinks, drops = np.empty((len(rows), 2, 6)), np.empty((len(rows), 3)), np.empty(len(rows))
    walk_into(legs, scale, rows, np.empty((0, 2, 6)), drops, np.empty(6))
    for n in range(len(rows)):
        uneven = is_uneven(rows[n])
        for side in range(2):
            foot = rows[n, ROOT_STATE + FOOT * side : ROOT_STATE + FOOT * (side + 1)]
            place, roll = (foot[X], foot[Z], foot[YAW]), (foot[PITCH], foot[LIFT])
            tilt_foot(legs, side, place, roll, ease_of(1.0, foot[SWING]), feet[n, side])
            if uneven:
                drops[n] = max(drops[n], _raised(legs, side, rows[n], feet[n, side]))
        down, back, lean = hips_sink(half_leg, drops[n], lowerings[n])
        for side in range(2):
            length = _STRETCH * (legs[side, _THIGH] + legs[side, _SHIN])
            x, y, z = carried_hip(legs, rows[n], lean, side)
            dx, dz = feet[n, side, 0] - x, feet[n, side, 2] - z + back
            reach = np.sqrt(max(length * length - dx * dx - dz * dz, 0.25 * length * length))
            down = _pulled(down, y - feet[n, side, 1] - reach, _SOFTLY * length)
        sinks[n, 0], sinks[n, 1], sinks[n, 2] = down, back, lean
    return feet, sinks
