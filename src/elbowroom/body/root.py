"""The state of the root: where the body stands, how it moves, and where in the stride it is."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

ROOT_STATE = 7  # number of components of a root state array


class RootState(NamedTuple):
    """One root state; as an array it has shape (7,) in this order. Metres, radians, seconds."""

    x: float = 0.0  # metres
    z: float = 0.0  # metres
    heading: float = 0.0  # about +Y, 0 faces +Z, positive turns left (towards +X); never wrapped along a path
    forward: float = 0.0  # velocity along the heading, m/s
    lateral: float = 0.0  # velocity to the left of the heading, m/s
    turn: float = 0.0  # heading rate, rad/s
    phase: float = 0.0  # gait phase in strides (two steps), 0 = left heel strike; never wrapped along a path

    def as_array(self) -> NDArray[np.float64]:
        """The state as an array (7,)."""
        return np.array(self, dtype=np.float64)
