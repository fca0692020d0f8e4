"""How far sixteen axes are from an edge of a hull or of a mesh."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import helper
from elbowroom.world.obstacles.layout import LANES

_LANES = np.uint64(LANES)
_ZERO: Any = np.float32(0.0)
_ONE: Any = np.float32(1.0)
_TINY: Any = np.float32(1e-20)

Floats32 = NDArray[np.float32]


@helper
def hold_against_edge(packed: Floats32, at: Any, state: Floats32) -> None:
    """How far sixteen axes are from an edge: the nearest points of two lines, each brought back between its ends."""
    ox, oy, oz = packed[at], packed[at + np.uint64(1)], packed[at + np.uint64(2)]
    ex, ey, ez = packed[at + np.uint64(3)], packed[at + np.uint64(4)], packed[at + np.uint64(5)]
    ee, per_ee = packed[at + np.uint64(6)], packed[at + np.uint64(7)]
    for i in range(_LANES):
        x, y, z = state[i] - ox, state[i + _LANES] - oy, state[i + np.uint64(2) * _LANES] - oz
        dx, dy, dz = (
            state[i + np.uint64(3) * _LANES],
            state[i + np.uint64(4) * _LANES],
            state[i + np.uint64(5) * _LANES],
        )
        dd, de = dx * dx + dy * dy + dz * dz + _TINY, dx * ex + dy * ey + dz * ez
        dr, er = dx * x + dy * y + dz * z, ex * x + ey * y + ez * z
        s = max(min((de * er - dr * ee) / max(dd * ee - de * de, _TINY), _ONE), _ZERO)
        t = max(min((de * s + er) * per_ee, _ONE), _ZERO)
        s = max(min((de * t - dr) / dd, _ONE), _ZERO)
        u, v, w = x + s * dx - t * ex, y + s * dy - t * ey, z + s * dz - t * ez
        state[i + np.uint64(8) * _LANES] = min(state[i + np.uint64(8) * _LANES], u * u + v * v + w * w)
