"""The room that legs and pelvis have at root states: posed by the gait, held against what stands about them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.pose.whole_body import WholeBody, posed_legs
from elbowroom.body.root import HEIGHT
from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel, helper
from elbowroom.planning.model.footing import floors_under, levelled, lift_feet, set_rises
from elbowroom.planning.root.legs.hull import LowBoxes
from elbowroom.planning.root.legs.neighbours import Neighbours
from elbowroom.world.ground.sole import Sole
from elbowroom.world.obstacles.clearance import lower_clearance
from elbowroom.world.obstacles.rows import room_for, shifted_into

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

_WIDE = 1e-3  # metres: more than any rounding
_HERE = 0.0, 0.0, 0.0  # obstacles are seen from where they are


@by_reference
class Legs(NamedTuple):
    """Legs and pelvis of a body."""

    posed: WholeBody
    radii: Floats32  # (C,) of their capsules, metres
    feet: Longs  # (F,) those that are round feet and toes
    sole: Sole
    reach: float  # metres that they reach from the root's place, with a little to spare
    tall: float  # metres above the ground: what begins higher they do not meet


@exact_kernel
def room_at(legs: Legs, among: Neighbours, states: Floats, spare: float, farthest: float) -> Floats32:
    """Metres (N,) from legs and pelvis at root states (N, ROOT_STATE) to what stands; infinite where nothing is near.

    Feet may stand on what they stand on, also for who asks for `spare` metres; negative where there is no ground. More
    than `farthest` metres are not told apart.
    """
    out, chosen = np.full(states.shape[0], np.inf, np.float32), _within(among.boxes, states, legs.reach)
    if not chosen.any():
        return out
    out[:] = farthest
    uneven, rows = not among.boxes.underfoot.plain, states
    lowerings, there = np.zeros(states.shape[0]), np.ones(states.shape[0], np.bool_)
    if uneven:
        rows = states.copy()
        there = set_rises(among.boxes.underfoot, legs.posed.gait_legs, legs.posed.scale, legs.sole, rows)
        _leave_out(among.boxes, floors_under(rows).min(), rows[:, HEIGHT].max() + legs.tall, chosen)
    segments = posed_legs(legs.posed, rows, lowerings)
    if uneven:
        lift_feet(segments, legs.feet, posed_legs(legs.posed, levelled(rows), lowerings), legs.feet, legs.radii, spare)
        _leave_out_far(among.boxes, segments, legs.radii, farthest, chosen)
    near, count = room_for(among.obstacles, chosen.sum()), 0
    for b in range(chosen.shape[0]):
        if chosen[b]:
            shifted_into(among.obstacles, b, _HERE, near, count)
            count += 1
    lower_clearance(segments, legs.radii, near, out)
    for n in range(out.shape[0]):
        if not there[n]:
            out[n] = -1.0
    return out


@helper
def _within(boxes: LowBoxes, states: Floats, reach: float) -> Bools:
    """Which boxes (B,) may come within `reach` metres of one of the places of root states."""
    chosen = np.empty(boxes.least.shape[0], np.bool_)
    low_x, high_x = states[:, 0].min() - reach, states[:, 0].max() + reach
    low_z, high_z = states[:, 1].min() - reach, states[:, 1].max() + reach
    for b in range(chosen.shape[0]):
        across = boxes.least[b, 0] <= high_x and boxes.most[b, 0] >= low_x
        chosen[b] = across and boxes.least[b, 1] <= high_z and boxes.most[b, 1] >= low_z
    return chosen


@helper
def _leave_out(boxes: LowBoxes, floor: float, top: float, chosen: Bools) -> None:
    """Of the boxes that are chosen leave out those that do not rise above a height, or begin above another."""
    for b in range(chosen.shape[0]):
        chosen[b] = chosen[b] and boxes.heights[b, 1] > floor and boxes.heights[b, 0] < top


@helper
def _leave_out_far(boxes: LowBoxes, segments: Floats32, radii: Floats32, farthest: float, chosen: Bools) -> None:
    """Of the boxes that are chosen leave out those farther than so many metres from a box round all legs (C, 6, N)."""
    least, most = np.full(3, np.inf), np.full(3, -np.inf)
    for c in range(segments.shape[0]):
        away = radii[c] + farthest + _WIDE
        for i in range(6):
            for n in range(segments.shape[2]):
                least[i % 3] = min(least[i % 3], segments[c, i, n] - away)
                most[i % 3] = max(most[i % 3], segments[c, i, n] + away)
    for b in range(chosen.shape[0]):
        if chosen[b]:
            across = boxes.least[b, 0] <= most[0] and boxes.most[b, 0] >= least[0]
            along = boxes.least[b, 1] <= most[2] and boxes.most[b, 1] >= least[2]
            chosen[b] = across and along and boxes.heights[b, 0] <= most[1] and boxes.heights[b, 1] >= least[1]
