"""How far obstacles reach over the ground in a direction, for kernels: what is long and thin needs no ball round it."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import inner_exact_kernel
from elbowroom.world.obstacles.layout import HALF, ROUNDING, TURN, Nearby

Floats = NDArray[np.float64]


@inner_exact_kernel
def reach_along(near: Nearby, b: int, x: float, z: float) -> float:
    """Metres that an obstacle reaches from its middle to either side, along a unit vector over the ground."""
    own = near.rows[b]
    reach = own[ROUNDING]
    for k in range(3):
        reach += abs(own[TURN + 3 * k] * x + own[TURN + 3 * k + 2] * z) * own[HALF + k]
    return float(reach)
