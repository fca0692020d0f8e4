"""Where a motion ran into the avatar's own body, so that the next search along the same path does not try it again."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup
from elbowroom.jit import exact_kernel
from elbowroom.planning.paper.activity_graph import squared_distance

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_SAME = 1e-6  # radians


class OwnContact(NamedTuple):
    """A group ran into the body."""

    group: DofGroup
    depth: int  # the key time
    around: Floats  # (LOCAL,) the groups that were posed before it, zero elsewhere
    posture: Floats  # (d,) of the group
    near: float  # radians: so near to it nothing is tried again

    def happens(self, around: Floats) -> bool:
        """Whether the groups before it are as they were then."""
        return bool(np.abs(self.around - around).max() < _SAME)


@exact_kernel
def rule_out_near(costs: Floats32, known: Floats, extras: Floats, posture: Floats, near: float) -> None:
    """Make infinite the costs (W + E,) of a key time's nodes that are `near` to a posture (d,), radians.

    The first nodes are the postures `known` (V, d), the last ones the `extras` (E, d).
    """
    width = costs.shape[0] - extras.shape[0]
    for node in range(known.shape[0]):
        if np.sqrt(squared_distance(known[node], posture)) < near:
            costs[node] = np.inf
    for node in range(extras.shape[0]):
        if np.sqrt(squared_distance(extras[node], posture)) < near:
            costs[width + node] = np.inf
