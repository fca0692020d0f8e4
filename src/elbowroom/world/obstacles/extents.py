"""How far obstacles reach in a direction, for kernels: what is long and thin needs no ball round it."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import inner_exact_kernel
from elbowroom.world.obstacles.layout import HALF, ROUNDING, TURN, Nearby

Floats = NDArray[np.float64]


@inner_exact_kernel
def reach_along(near: Nearby, b: int, way: tuple[float, float, float]) -> float:
    """Metres that an obstacle reaches from its middle to either side, along a unit vector."""
    (x, y, z), own = way, near.rows[b]
    reach = own[ROUNDING]
    for k in range(3):
        axis = TURN + 3 * k
        reach += abs(own[axis] * x + own[axis + 1] * y + own[axis + 2] * z) * own[HALF + k]
    return float(reach)
