"""Who is held in a stride where standing up straight would touch goes a little into the knees instead.

In mid-stride hips are lower than over feet that stand beside each other. So a pose that is free in a stride may touch
where its legs come to a stand, and no motion begins there: planned motion begins standing.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOWERING, DofGroup, clamp, columns_of
from elbowroom.control.key_frame_queue import Playback

Floats = NDArray[np.float64]

_COLUMN = LOWERING - DofGroup.ROOT.size
_WAIST = columns_of(DofGroup.WAIST)
_RATE = 0.5  # half leg lengths per second that hips come down
_ROOM = 0.01  # metres of clearance that are enough to stand in


def ducked(held: Playback, stood: Floats, dt: float, clearance: Callable[[Floats, Floats], float]) -> Playback | None:
    """A held pose, a little lower after `dt` seconds; None where there is room to stand, or where that makes none.

    `stood` is the root state in which its legs stand. `clearance` is that of a root and an upper body, metres.
    """
    room = clearance(stood, held.upper)
    if room >= _ROOM:
        return None
    upper = held.upper.copy()
    upper[_COLUMN] += _RATE * dt
    upper[_WAIST] = clamp(DofGroup.WAIST, upper[_WAIST])
    return held._replace(upper=upper) if clearance(stood, upper) > room else None
