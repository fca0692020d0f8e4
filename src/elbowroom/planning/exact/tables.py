"""The clearance of all postures of a group in one key interval, while the frame that carries them moves.

A posture belongs to a key time, and stays there for half a key interval to either side: so each interval gives the
postures of the key time before it an `early` row and those of the key time after it a `late` one, which looks at the
key time itself too. The goal's own posture at these two key times rides along.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_inner_kernel, exact_kernel
from elbowroom.planning.exact.clearances import (
    box_in_frame,
    boxes_around,
    capsule_clearances,
    lower_blocks,
    place_capsules,
    relative_to,
)
from elbowroom.planning.exact.postures import BLOCK, Postures
from elbowroom.planning.exact.slots import Slots, admit, find, new_slots
from elbowroom.planning.exact.ways import SWEEP
from elbowroom.planning.limb import pose

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_MOMENTS = 4  # parts of an interval, at whose ends postures are looked at
_STRIDE = SWEEP // _MOMENTS
HELD_AT_START, HELD_EARLY, HELD_LATE = 0, 1, 2  # parts of an interval
_EARLY, _LATE = 2, 2  # up to this moment they belong to the key time before, from this one on to that after
_FAR = np.float32(1e3)


class Tables(NamedTuple):
    """Tables by interval; the key is the carrier's way and the goals at both ends."""

    slots: Slots
    early: Floats32  # (S, W + 1) clearance of every posture, then of the goal
    late: Floats32  # (S, W + 1)


def new_tables(count: int, size: int, width: int) -> Tables:
    """Room for `count` tables of `width` lanes of postures with `size` components."""
    return Tables(
        new_slots(count, 1 + 2 * size),
        np.empty((count, width + 1), np.float32),
        np.empty((count, width + 1), np.float32),
    )


@exact_inner_kernel
def table_of(
    tables: Tables, postures: Postures, carrier: int, places: Floats, turns: Floats, goals: Floats, boxes: Floats
) -> tuple[int, int]:
    """The slot of the table of an interval, and the capsules that had to be checked for it.

    `carrier` is the number of the carrier's way, `places` (SWEEP+1, 3) and `turns` (SWEEP+1, 4) are its frames,
    `goals` (2, d) those at the interval's ends, `boxes` (B, 15) in the world.
    """
    size = goals.shape[1]
    key = np.empty(1 + 2 * size)
    key[0] = carrier
    for i in range(size):
        key[1 + i], key[1 + size + i] = goals[0, i], goals[1, i]
    known = find(tables.slots, key)
    if known >= 0:
        return int(known), 0
    at = admit(tables.slots, key)
    early, late = tables.early[at], tables.late[at]
    checks = _moments(postures.lanes, postures.balls, postures.reach, places, turns, boxes, early, late)
    width = early.shape[0] - 1
    early[width], count = held_clearance(postures, goals[0], places, turns, boxes, int(HELD_EARLY))
    late[width], more = held_clearance(postures, goals[1], places, turns, boxes, int(HELD_LATE))
    return int(at), checks + count + more


@exact_inner_kernel
def _moments(
    lanes: Floats32, balls: Floats, reach: float, places: Floats, turns: Floats, boxes: Floats, early: Floats32,
    late: Floats32,
) -> int:  # fmt: skip
    """The clearance of all postures at the moments of an interval, into `early` and `late` (W+1,); checked capsules."""
    early[:], late[:] = _FAR, _FAR
    checks = 0
    near, moved = np.empty_like(boxes), np.empty_like(boxes)
    rows = np.empty((lanes.shape[0], BLOCK), np.float32)
    for moment in range(1, _MOMENTS + 1):
        place, turn = places[moment * _STRIDE], turns[moment * _STRIDE]
        count = boxes_around(boxes, place, reach, near)
        if count == 0:
            continue
        for b in range(count):
            box_in_frame(near[b], place, turn, moved[b])
        rows[:] = _FAR
        checks += lower_blocks(lanes, balls, moved, count, rows)
        if moment <= _EARLY:
            _lower(early, rows)
        if moment >= _LATE:
            _lower(late, rows)
    return checks


@exact_inner_kernel
def _lower(row: Floats32, blocks: Floats32) -> None:
    """Lower the beginning of a row to what is in blocks (B, 16)."""
    for b in range(blocks.shape[0]):
        lanes, block = row[b * BLOCK : (b + 1) * BLOCK], blocks[b]
        for i in range(np.uint64(BLOCK)):
            lanes[i] = min(lanes[i], block[i])


@exact_kernel
def held_clearance(
    postures: Postures, configuration: Floats, places: Floats, turns: Floats, boxes: Floats, part: int
) -> tuple[float, int]:
    """The clearance of a single posture (d,) in one of the parts of an interval, and the capsules that were checked."""
    late = (_LATE, _MOMENTS + 1)
    begin, end = (0, 1) if part == HELD_AT_START else (1, _EARLY + 1) if part == HELD_EARLY else late
    limb, reach = postures.limb, postures.reach
    origin, near = places[0], np.empty_like(boxes)
    count = boxes_around(boxes, origin, reach + 0.5, near)
    if count == 0:
        return float(_FAR), 0
    posture = np.empty((1, configuration.shape[0]))
    for i in range(configuration.shape[0]):
        posture[0, i] = configuration[i]
    segments, radii, total = pose(limb, posture), limb.radii, end - begin
    held, at, frames = np.empty((segments.shape[0], 6, total), np.float32), np.empty((total, 3)), np.empty((total, 4))
    for n in range(total):
        look = (begin + n) * _STRIDE
        for i in range(3):
            at[n, i] = places[look, i]
        for i in range(4):
            frames[n, i] = turns[look, i]
        for c in range(segments.shape[0]):
            for i in range(6):
                held[c, i, n] = segments[c, i, 0]
    relative_to(origin, near, count, at, at)
    lanes = np.empty((segments.shape[0], 7, BLOCK), np.float32)
    place_capsules(held, radii, at, frames, lanes)
    out = np.empty((segments.shape[0], BLOCK), np.float32)
    out[:] = _FAR
    checks = capsule_clearances(lanes, near, count, out)
    return float(out.min()), checks
