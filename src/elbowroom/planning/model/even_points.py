"""Points that fill a space evenly, without chance: equal calls give equal points.

They are those of an additive recurrence (M. Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def evenly_spread(count: int, size: int) -> Floats:
    """Points (count, size) between 0 and 1, by the powers of the generalised golden ratio."""
    ratio = 2.0
    for _ in range(60):
        ratio = (1.0 + ratio) ** (1.0 / (size + 1.0))
    steps = ratio ** -np.arange(1.0, size + 1.0)
    points: Floats = (0.5 + np.arange(1.0, count + 1.0)[:, None] * steps) % 1.0
    return points
