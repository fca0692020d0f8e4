"""Where feet that stand and step put ankles and hips: those of `footholds`, as `gait` has those of the walking cycle.

Hips are where the cycle has them, or lower where a foot would be out of reach.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.carriage import carried_hip
from elbowroom.body.gait.cycle import ease_of, hips_sink, tilt_foot, walk_into
from elbowroom.body.gait.foot_state import LIFT, PITCH, SWING, YAW, X, Z
from elbowroom.body.root import FOOT, ROOT_STATE
from elbowroom.jit import kernel

Floats = NDArray[np.float64]

_THIGH, _SHIN = 8, 9  # columns of `GaitShape.legs`
_STRETCH = 0.9985  # of a leg: no foot is farther from its hip


@kernel
def posed_feet(legs: Floats, scale: float, half_leg: float, rows: Floats, lowerings: Floats) -> tuple[Floats, Floats]:
    """Feet (N, 2, 6) as in `gait.foot_poses`, and sinks of the hips (N, 3) as in `gait.hips_sinks`.

    For rows (N, WITH_FEET or SHOWN) and lowerings (N,). Hips come down where a foot would be out of reach.
    """
    feet, sinks, drops = np.empty((len(rows), 2, 6)), np.empty((len(rows), 3)), np.empty(len(rows))
    walk_into(legs, scale, rows, np.empty((0, 2, 6)), drops, np.empty(6))
    for n in range(len(rows)):
        down, back, lean = hips_sink(half_leg, drops[n], lowerings[n])
        for side in range(2):
            foot = rows[n, ROOT_STATE + FOOT * side : ROOT_STATE + FOOT * (side + 1)]
            place, roll = (foot[X], foot[Z], foot[YAW]), (foot[PITCH], foot[LIFT])
            tilt_foot(legs, side, place, roll, ease_of(1.0, foot[SWING]), feet[n, side])
            length = _STRETCH * (legs[side, _THIGH] + legs[side, _SHIN])
            x, y, z = carried_hip(legs, rows[n], lean, side)
            dx, dz = feet[n, side, 0] - x, feet[n, side, 2] - z + back
            reach = np.sqrt(max(length * length - dx * dx - dz * dz, 0.25 * length * length))
            down = max(down, y - feet[n, side, 1] - reach)
        sinks[n, 0], sinks[n, 1], sinks[n, 2] = down, back, lean
    return feet, sinks
