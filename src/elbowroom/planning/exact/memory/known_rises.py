"""What feet stand on in root states, known again by the bits of these: on treads that costs more than all else there.

Who looks for a path of the upper body poses the same root path again and again, at the same moments.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RISES, ROOT_STATE
from elbowroom.by_reference import by_reference
from elbowroom.jit import inner_exact_kernel
from elbowroom.planning.exact.memory.row_contents import set_bits
from elbowroom.planning.exact.memory.row_index import RowIndex, admit, new_row_index, place_of
from elbowroom.planning.model.footing import Underfoot, set_rises

Floats = NDArray[np.float64]

_ROOM = 4096  # root states


@by_reference
class KnownRises(NamedTuple):
    """Root states that were looked at."""

    states: RowIndex  # by the numbers that what they stand on depends on
    rises: Floats  # (S, ROOT_STATE - RISES) of both feet


def new_known_rises(underfoot: Underfoot) -> KnownRises:
    """Room for as many as several paths have; hardly any on the plane, where nothing is looked up."""
    room = 1 if underfoot.ground.plain else _ROOM
    return KnownRises(new_row_index(room, RISES), np.empty((room, ROOT_STATE - RISES)))


@inner_exact_kernel
def recall_rises(known: KnownRises, underfoot: Underfoot, legs: Floats, scale: float, roots: Floats) -> None:
    """Write to root states (N, ROOT_STATE) what their feet stand on, as `set_rises` does."""
    row = np.empty(RISES, np.int64)
    for n in range(roots.shape[0]):
        set_bits(roots[n, :RISES], row)
        place = place_of(known.states, row)
        if place < 0:
            set_rises(underfoot.ground, legs, scale, underfoot.sole, roots[n : n + 1])
            place = admit(known.states, row)
            known.rises[place] = roots[n, RISES:]
        else:
            roots[n, RISES:] = known.rises[place]
