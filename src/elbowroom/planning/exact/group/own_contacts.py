"""Where a motion ran into the avatar's own body, so that the next search along the same path does not try it again."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.paper.activity_graph import squared_distance

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_SAME = 1e-6  # radians


class Contact(NamedTuple):
    """An arm ran into the body."""

    side: int  # of the arm
    depth: int  # the key time
    around: Floats  # the waist, for the right arm the left one too
    posture: Floats  # (d,) of the arm

    def happens(self, around: Floats) -> bool:
        """Whether the groups before the arm are as they were then."""
        return bool(np.abs(self.around - around).max() < _SAME)


@exact_kernel
def rule_out_near(costs: Floats32, known: Floats, own: Floats, posture: Floats, near: float) -> None:
    """Make infinite what nodes cost that are `near` to a posture (d,), radians: `prices` (W + E,) of a key time.

    The first nodes are the postures `known` (V, d), the last ones those of the key time alone, `own` (E, d).
    """
    width = costs.shape[0] - own.shape[0]
    for node in range(known.shape[0]):
        if np.sqrt(squared_distance(known[node], posture)) < near:
            costs[node] = np.inf
    for node in range(own.shape[0]):
        if np.sqrt(squared_distance(own[node], posture)) < near:
            costs[width + node] = np.inf
