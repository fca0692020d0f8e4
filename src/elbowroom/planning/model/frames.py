"""Rigid frames along a path, without NumPy's cost for small arrays."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import inner_kernel, kernel

Floats = NDArray[np.float64]


@inner_kernel
def compose_into(
    positions: Floats, rotations: Floats, inner: Floats, turns: Floats, count: int, places: Floats, out: Floats
) -> None:
    """`compose` for the first `count` frames, written to `places` (n, 3) and `out` (n, 4); these may be the outer."""
    for n in range(count):
        ax, ay, az, aw = rotations[n, 0], rotations[n, 1], rotations[n, 2], rotations[n, 3]
        bx, by, bz, bw = turns[n, 0], turns[n, 1], turns[n, 2], turns[n, 3]
        out[n, 0] = aw * bx + ax * bw + ay * bz - az * by
        out[n, 1] = aw * by - ax * bz + ay * bw + az * bx
        out[n, 2] = aw * bz + ax * by - ay * bx + az * bw
        out[n, 3] = aw * bw - ax * bx - ay * by - az * bz
        x, y, z = inner[n, 0], inner[n, 1], inner[n, 2]
        tx, ty, tz = 2.0 * (ay * z - az * y), 2.0 * (az * x - ax * z), 2.0 * (ax * y - ay * x)
        places[n, 0] = positions[n, 0] + x + aw * tx + ay * tz - az * ty
        places[n, 1] = positions[n, 1] + y + aw * ty + az * tx - ax * tz
        places[n, 2] = positions[n, 2] + z + aw * tz + ax * ty - ay * tx


@kernel
def compose(positions: Floats, rotations: Floats, inner: Floats, turns: Floats) -> tuple[Floats, Floats]:
    """Frames at `inner` (n, 3), `turns` (n, 4), given in frames at `positions`, `rotations`, seen from outside."""
    places, out = np.empty(positions.shape), np.empty(rotations.shape)
    compose_into(positions, rotations, inner, turns, positions.shape[0], places, out)
    return places, out
