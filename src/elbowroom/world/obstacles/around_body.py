"""How far each capsule of one posture is from all that stands, without looking at what is far: in one kernel.

What is near is looked at first, then ever wider, until the nearest of all is found. So a frame among thousands of
obstacles costs no more than one among few.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference
from elbowroom.jit import brief_kernel, helper
from elbowroom.world.obstacles.broad_phase import Grids, meeting_any_order
from elbowroom.world.obstacles.clearance import lower_each
from elbowroom.world.obstacles.layout import ROW, Nearby
from elbowroom.world.obstacles.rows import shifted_into

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_NEAR, _WIDER, _FAR = 0.5, 4.0, 1e6  # metres: where is looked first, how many times farther, at most
_INFINITE: Any = np.float32(np.inf)


@by_reference
class Standing(NamedTuple):
    """All that stands, B obstacles, and how to find what is near."""

    near: Nearby
    grids: Grids
    heights: Floats  # (B, 2) the lowest and the highest point of each


@helper
def _within(
    standing: Standing, low: Floats, high: Floats, x: float, z: float, floor: float
) -> tuple[Nearby, Floats, bool]:
    """What stands in a box about a place (x, z), or nearly, as seen from there, and rises above a floor.

    And how high each of these rises, and whether nothing stands outside. The box is seen from the place too.
    """
    numbers = meeting_any_order(standing.grids, x + low[0], z + low[2], x + high[0], z + high[2])
    near, tops, taken = Nearby(np.empty((len(numbers), ROW)), standing.near.packed), np.empty(len(numbers)), 0
    for b in numbers:
        lowest, highest = standing.heights[b, 0], standing.heights[b, 1]
        if lowest <= high[1] and highest >= low[1] and highest > floor:
            shifted_into(standing.near, b, (x, 0.0, z), near, taken)
            tops[taken] = highest
            taken += 1
    everything = len(numbers) == len(standing.near.rows)
    return Nearby(near.rows[:taken], near.packed), tops[:taken], everything


@helper
def _lower_above(axes: Floats32, radii: Floats32, near: Nearby, tops: Floats, floors: Floats, out: Floats32) -> None:
    """Lower `out` (C,) to the clearances of `axes` (6, C) from what rises above the floor of each (C,)."""
    highest, shared, found = floors.max(), 0, np.empty(len(out), np.float32)
    rows = np.empty(near.rows.shape)
    for b in range(len(tops)):
        if tops[b] > highest:
            rows[shared] = near.rows[b]
            shared += 1
    lower_each(axes, radii, Nearby(rows[:shared], near.packed), out)
    for b in range(len(tops)):
        if tops[b] <= highest:
            found[:] = out
            lower_each(axes, radii, Nearby(near.rows[b : b + 1], near.packed), found)
            for c in range(len(out)):
                if tops[b] > floors[c]:
                    out[c] = min(out[c], found[c])


@brief_kernel
def clearances_around(
    standing: Standing, segments: Floats32, radii: Floats32, x: float, z: float, floors: Floats, farthest: float
) -> Floats32:
    """The clearance (C,) of each of `segments` (C, 6, 1) that lie about a place (x, z), metres; infinite without any.

    That of the nearest capsule is exact; those of others are exact too, or at least so much. What is more than
    `farthest` metres is not told apart. What does not rise above a capsule's own of the `floors` (C,) is left out.
    """
    count, many = segments.shape[0], standing.near.rows.shape[0]
    out, axes = np.full(count, _INFINITE, np.float32), np.empty((6, count), np.float32)
    least, most = np.full(3, np.inf), np.full(3, -np.inf)
    for c in range(count):
        for i in range(6):
            axes[i, c] = segments[c, i, 0]
            least[i % 3] = min(least[i % 3], axes[i, c] - radii[c])
            most[i % 3] = max(most[i % 3], axes[i, c] + radii[c])
    reach = min(_NEAR, farthest)
    while many > 0 and count > 0 and reach < _FAR:
        near, tops, everything = _within(standing, least - reach, most + reach, x, z, floors.min())
        out[:] = farthest if everything else reach
        _lower_above(axes, radii, near, tops, floors, out)
        if everything or out.min() < reach or reach >= farthest:
            break
        reach = min(reach * _WIDER, farthest)
    return out
