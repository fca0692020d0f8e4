"""Feet on ground that is not the root's plane: raised to what they stand on, and tilted as it slopes.

The walking cycle puts feet on a plane (`gait`). Here each is turned as a whole, about the place on the plane that is
under the ankle of the flat foot, onto the ground that the root's state tells of; the hips come down where a leg would
be too short. On the plane nothing is changed.
"""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.cycle import too_high
from elbowroom.body.root import RISES
from elbowroom.jit import inner_kernel, kernel

Floats = NDArray[np.float64]

_HIP, _ANKLE, _BALL, _HEEL, _THIGH, _SHIN = 0, 3, 6, 7, 8, 9  # columns of `GaitShape.legs`
STRETCH = 0.992  # of a leg: it is never longer
_LEVEL = 1e-6  # metres and radians: less is the plane


@inner_kernel
def is_uneven(root: Floats) -> bool:
    """Whether a root state tells of ground under its feet that is not the root's plane; not where it ends before."""
    if root.shape[0] <= RISES:
        return False
    rises = root[RISES:]
    return bool(abs(rises[0]) + abs(rises[1]) + abs(rises[2]) + abs(rises[3]) >= _LEVEL)


@inner_kernel
def raise_foot(foot: Floats, ahead: float, rise: float, slope: float) -> None:
    """Turn a foot (6,) on the plane onto ground: its ankle is `ahead` of where that of the flat foot is."""
    sine, cosine, above = math.sin(slope), math.cos(slope), foot[1]
    moved = ahead * (cosine - 1.0) + above * sine
    foot[0] += moved * math.sin(foot[3])
    foot[1] = rise - ahead * sine + above * cosine
    foot[2] += moved * math.cos(foot[3])
    foot[4] += slope


@kernel
def raise_feet(legs: Floats, roots: Floats, feet: Floats, drops: Floats) -> None:
    """Put `feet` (N, 2, 6) and the hips' `drops` (N,) of the cycle on the ground that `roots` (N, ROOT_STATE) tell of.

    Nothing is done where the rows end with the phase.
    """
    for n in range(len(roots)):
        if not is_uneven(roots[n]):
            continue
        for side in range(2):
            foot, at = feet[n, side], RISES + 2 * side
            pitch, pivot = foot[4], legs[side, _BALL] if foot[4] > 0.0 else -legs[side, _HEEL]
            ahead = pivot - pivot * math.cos(pitch) + legs[side, _ANKLE + 1] * math.sin(pitch)
            raise_foot(foot, ahead, roots[n, at], roots[n, at + 1])
            hip = (legs[side, _HIP], legs[side, _HIP + 1], legs[side, _HIP + 2])
            drops[n] = max(drops[n], too_high(foot, hip, STRETCH * (legs[side, _THIGH] + legs[side, _SHIN])))
