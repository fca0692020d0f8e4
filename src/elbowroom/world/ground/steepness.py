"""How steeply the ground rises about a place, treads of a stair taken together: the slope of the plane nearest to it.

Where the treads of a spiral taper they lie closer, and it is steeper.
"""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.world.ground.ground import Ground, height_at, level_about

Floats = NDArray[np.float64]

_AROUND, _RINGS = 12, 4  # places about one
_NONE = -math.inf


@exact_kernel
def grades_about(ground: Ground, heights: Floats, places: Floats, radius: float) -> Floats:
    """Metres that the ground rises in a metre (N,) as far as `radius` about places (N, 2) at `heights` (N,).

    It is followed step by step from each; where it ends it counts as level.
    """
    out = np.zeros(places.shape[0])
    for n in range(places.shape[0]):
        x, z = places[n, 0], places[n, 1]
        if ground.plain or level_about(ground, x, z, radius, heights[n]) > _NONE:
            continue
        along_x, along_z, squares = 0.0, 0.0, 0.0
        for i in range(_AROUND):
            angle, near = 2.0 * math.pi * (i + 0.5) / _AROUND, heights[n]
            for j in range(_RINGS):
                away = radius * (j + 1.0) / _RINGS
                dx, dz = away * math.sin(angle), away * math.cos(angle)
                found = height_at(ground, x + dx, z + dz, near)
                near = found if found > _NONE else near
                along_x += dx * (near - heights[n])
                along_z += dz * (near - heights[n])
                squares += 0.5 * away * away
        out[n] = math.hypot(along_x, along_z) / squares
    return out
