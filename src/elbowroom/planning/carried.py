"""What head and arms would like under a path of the waist that carries them: a level gaze, and arms that hang.

The goals of a walk are those of an upright trunk. Under another one the head keeps its gaze (`gaze`), and arms hang
from the shoulders by their weight, swing about that as ever, and are spread and bent a little more: hands stay off the
ground, and off knees that come up before them.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import ARMS, MAX_ELEVATION, DofGroup, columns_of, limits
from elbowroom.body.gait.lowered_hips import hips_lean
from elbowroom.jit import exact_kernel, helper
from elbowroom.planning.gaze import keeping_gaze

Floats = NDArray[np.float64]

# For each radian that the chest leans more:
_TURNED = 0.9  # radians that upper arms are turned ahead, as the chest sees them: all of it would have them vertical
_BENT, _SPREAD = 0.3, 0.2  # radians that elbows are bent more, and that arms are spread more
_SAME = 1e-9  # radians
_WAIST = columns_of(DofGroup.WAIST).start
_LEFT, _RIGHT = (columns_of(arm).start for arm in ARMS)
_ABDUCTION, _ELBOW = 1, 3  # components of an arm, after the flexion
_FARTHEST_BACK, _BENDABLE = float(limits(ARMS[0])[0, 0]), float(limits(ARMS[0])[_ELBOW, 1])


@exact_kernel
def carried(goals: Floats, waists: Floats) -> Floats:
    """Goals (n+1, LOCAL), told for waists of their own, as head and arms would like them under `waists` (n+1, 3).

    Radians, but for the waist's lowering. Arms stay within their limits.
    """
    out = keeping_gaze(goals, waists)
    for t in range(out.shape[0]):
        more = _lean(waists[t]) - _lean(goals[t, _WAIST:])
        if abs(more) < _SAME:
            continue
        for arm in (_LEFT, _RIGHT):
            flexion, elbow = out[t, arm] + _TURNED * more, out[t, arm + _ELBOW] + _BENT * max(more, 0.0)
            flexion, spread = max(flexion, _FARTHEST_BACK), out[t, arm + _ABDUCTION] + _SPREAD * max(more, 0.0)
            share = min(1.0, MAX_ELEVATION / max(np.hypot(flexion, spread), MAX_ELEVATION))
            out[t, arm], out[t, arm + _ABDUCTION] = share * flexion, share * spread
            out[t, arm + _ELBOW] = min(elbow, _BENDABLE)
    return out


@helper
def _lean(waist: Floats) -> float:
    """How far a chest leans forward over a waist (3 or more,), as the chest sees the vertical, radians."""
    hips = hips_lean(waist[2])
    return float(waist[0] + np.arctan2(np.sin(hips) * np.cos(waist[1]), np.cos(hips)))
