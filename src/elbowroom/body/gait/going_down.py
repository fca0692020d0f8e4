"""How hips are carried that go down, on a stair or a ramp: lower all the way, so that no foot has to fall to its place.

Ground that falls lies lower where the leg ahead comes down than under the body, by what it falls until the body is over
that foot. People are as low by then: the knee that stands bends through the whole swing of the other leg. They rise a
little against the ground as they pass over a foot, on a knee that stays bent. It follows from how fast the root goes
down and where in its stride it is, so it begins and ends as the ground does.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.stride import CLIMB, stride_at
from elbowroom.jit import inner_kernel

Floats = NDArray[np.float64]

_DEEP = 1.2  # of what the ground falls until the body is over the foot ahead, so that this lands on a bent knee
_RISES = 0.4  # of that by which hips are less low as they pass over a foot


@inner_kernel
def lower_going_down(scale: float, row: Floats) -> float:
    """How much lower hips are, metres, than the walking cycle has them on the plane, in a row (ROOT_STATE or more,)."""
    stride = stride_at(scale, row)
    falls = 0.5 * stride.duty * stride.period * max(-row[CLIMB], 0.0)
    return float(_DEEP * falls * (1.0 - _RISES * (0.5 - 0.5 * np.cos(4.0 * np.pi * row[6]))))
