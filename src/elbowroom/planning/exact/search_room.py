"""What the search of one group writes down: made at its beginning, so that all that follows hands no array back."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_inner_kernel
from elbowroom.planning.exact.alone import Alone
from elbowroom.planning.exact.lattice import OWN
from elbowroom.planning.exact.prices import Carriers
from elbowroom.planning.exact.steps import MOST_STEPS
from elbowroom.planning.exact.ways import SWEEP

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]


class SearchRoom(NamedTuple):
    """Room for n key intervals, a group with d components and W + OWN nodes at each key time."""

    alone: Alone
    carriers: Carriers
    price: Floats32  # (n+1, W+OWN) of the nodes
    clear: Floats32  # (n+1, W+OWN) their clearances
    named: Floats  # (n, 1 + 2 d) keys of the intervals' masks
    masks: Longs  # (n,) the masks
    way: Longs  # (n+1,) nodes
    keys: Floats  # (n+1, d) their postures
    tangents: Floats  # (n+1, d) velocities of the curve through them
    slots: Longs  # (n,) of the ways through the intervals
    skins: Floats  # (n,) clearances that are asked for
    touches: Bools  # (n,) where the motion touches
    stiff: Bools  # (n+1,) where the curve swings past nothing
    steps: Longs  # (MOST_STEPS, 2)


@exact_inner_kernel
def search_room(horizon: int, size: int, nodes: int) -> SearchRoom:
    """Room for a search over so many key intervals."""
    depths = horizon + 1
    return SearchRoom(
        Alone(
            np.empty((depths, OWN, size)), np.empty((depths, OWN), np.bool_), np.empty(depths, np.int64),
            np.empty(nodes - OWN, np.float32),
        ),
        Carriers(np.empty(horizon, np.int64), np.empty((horizon, SWEEP + 1, 3)), np.empty((horizon, SWEEP + 1, 4))),
        np.empty((depths, nodes), np.float32),
        np.empty((depths, nodes), np.float32),
        np.empty((horizon, 1 + 2 * size)),
        np.empty(horizon, np.int64),
        np.empty(depths, np.int64),
        np.empty((depths, size)),
        np.empty((depths, size)),
        np.empty(horizon, np.int64),
        np.empty(horizon),
        np.empty(horizon, np.bool_),
        np.empty(depths, np.bool_),
        np.empty((MOST_STEPS, 2), np.int64),
    )  # fmt: skip
