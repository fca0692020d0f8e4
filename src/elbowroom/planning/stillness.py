"""When something stands, and when two things are the same: by tolerances with a unit, never by equal floats."""

import numpy as np
from numpy.typing import NDArray

STILL = 1e-6  # m/s and rad/s: slower is standing
UNMOVED = 1e-6  # metres and radians: what has moved by less is where it was
SAME = 1e-9  # metres, radians, and these by second: a motion that is so near to another goes on from it
SAME_TIME = 1e-9  # seconds: as near as moments can be reckoned in different ways


def is_still(velocities: NDArray[np.float64]) -> bool:
    """Whether all of these velocities, of any shape, m/s and rad/s, are those of somebody who stands."""
    return max(map(abs, velocities.ravel().tolist()), default=0.0) < STILL
