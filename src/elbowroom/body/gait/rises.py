"""Feet on ground that is not the root's plane: raised to what they stand on, and tilted as it slopes.

The walking cycle puts feet on a plane (`gait`). Here each is turned as a whole, about the place on the plane that is
under the ankle of the flat foot, onto the ground that the root's state tells of; the hips come down where a leg would
be too short. On the plane nothing is changed.
"""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RISES
from elbowroom.jit import kernel

Floats = NDArray[np.float64]

_HIP, _ANKLE, _BALL, _HEEL, _THIGH, _SHIN = 0, 3, 6, 7, 8, 9  # columns of `GaitShape.legs`
_STRETCH = 0.992  # of a leg: it is never longer
_LEVEL = 1e-6  # metres and radians: less is the plane


@kernel
def raise_feet(legs: Floats, roots: Floats, feet: Floats, drops: Floats) -> None:
    """Put `feet` (N, 2, 6) and the hips' `drops` (N,) of the cycle on the ground that `roots` (N, ROOT_STATE) tell of.

    Nothing is done where the rows end with the phase.
    """
    for n in range(len(roots) if roots.shape[1] > RISES else 0):
        rises = roots[n, RISES:]
        if abs(rises[0]) + abs(rises[1]) + abs(rises[2]) + abs(rises[3]) < _LEVEL:
            continue
        for side in range(2):
            foot, rise, slope = feet[n, side], rises[2 * side], rises[2 * side + 1]
            pitch, pivot = foot[4], legs[side, _BALL] if foot[4] > 0.0 else -legs[side, _HEEL]
            ahead = pivot - pivot * math.cos(pitch) + legs[side, _ANKLE + 1] * math.sin(pitch)
            sine, cosine, above = math.sin(slope), math.cos(slope), foot[1]
            moved = ahead * (cosine - 1.0) + above * sine
            foot[0] += moved * math.sin(foot[3])
            foot[1] = rise - ahead * sine + above * cosine
            foot[2] += moved * math.cos(foot[3])
            foot[4] += slope
            length = _STRETCH * (legs[side, _THIGH] + legs[side, _SHIN])
            dx, dz = foot[0] - legs[side, _HIP], foot[2] - legs[side, _HIP + 2]
            reach = math.sqrt(max(length * length - dx * dx - dz * dz, 0.25 * length * length))
            drops[n] = max(drops[n], legs[side, _HIP + 1] - foot[1] - reach)
