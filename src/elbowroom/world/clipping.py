"""A polygon cut at a plane: for grids whose cells take what lies over them."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import inner_exact_kernel

Floats = NDArray[np.float64]


@inner_exact_kernel
def clipped(points: Floats, count: int, axis: int, at: float, side: float, out: Floats) -> int:
    """Cut a polygon at a plane across an axis; how many corners are left (Sutherland and Hodgman, 1974).

    `points` (n, 3) are its `count` corners; `out` (n + 1, 3) takes those beyond `at` (before it, where `side` is -1).
    """
    made = 0
    for i in range(count):
        j = i + 1 if i + 1 < count else 0
        here, there = side * (points[i, axis] - at), side * (points[j, axis] - at)
        if here >= 0.0:
            out[made] = points[i]
            made += 1
        if (here > 0.0 and there < 0.0) or (here < 0.0 and there > 0.0):
            share = here / (here - there)
            for k in range(3):
                out[made, k] = points[i, k] + share * (points[j, k] - points[i, k])
            made += 1
    return made
