"""The clearance of all postures of a group in one key interval, while the frame that carries them moves.

A posture belongs to a key time, and stays there for half a key interval to either side: so each interval gives the
postures of the key time before it an `early` row and those of the key time after it a `late` one. The goal's own
posture at these two key times rides along.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.clearances import (
    box_in_frame,
    boxes_around,
    capsule_clearances,
    lower_blocks,
    place_capsules,
)
from elbowroom.planning.exact.postures import BLOCK, Postures
from elbowroom.planning.exact.slots import Slots, admit, find, new_slots
from elbowroom.planning.exact.ways import SWEEP
from elbowroom.planning.limb import pose

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_MOMENTS = 4  # moments of an interval at which postures are looked at
_STRIDE = SWEEP // _MOMENTS
HELD_AT_START, HELD_EARLY, HELD_LATE = 0, 1, 2  # parts of an interval
_EARLY, _LATE = 3, 2  # of these moments, the first three belong to the key time before, the last two to that after
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


@exact_kernel
def table_of(
    tables: Tables, postures: Postures, carrier: int, places: Floats, turns: Floats, goals: Floats, boxes: Floats
) -> tuple[int, int]:
    """The slot of the table of an interval, and the capsules that had to be checked for it.

    `carrier` is the number of the carrier's way, `places` (SWEEP+1, 3) and `turns` (SWEEP+1, 4) are its frames,
    `goals` (2, d) those at the interval's ends, `boxes` (B, 15) in the world.
    """
    size = goals.shape[1]
    key = np.empty(1 + 2 * size)
    key[0], key[1 : 1 + size], key[1 + size :] = carrier, goals[0], goals[1]
    known = find(tables.slots, key)
    if known >= 0:
        return int(known), 0
    at = admit(tables.slots, key)
    early, late = tables.early[at], tables.late[at]
    early[:], late[:] = _FAR, _FAR
    width, checks = early.shape[0] - 1, 0
    near, moved, row = np.empty_like(boxes), np.empty_like(boxes), np.empty((width // BLOCK, BLOCK), np.float32)
    for i in range(_MOMENTS):
        look = i * _STRIDE
        count = boxes_around(boxes, places[look], postures.reach, near)
        if count == 0:
            continue
        for b in range(count):
            box_in_frame(near[b], places[look], turns[look], moved[b])
        row[:] = _FAR
        checks += lower_blocks(postures.lanes, postures.balls, moved, count, row)
        flat = row.reshape(width)
        if i < _EARLY:
            early[:width] = np.minimum(early[:width], flat)
        if i >= _LATE:
            late[:width] = np.minimum(late[:width], flat)
    early[width], count = held_clearance(postures, goals[0], places, turns, boxes, HELD_EARLY)
    late[width], more = held_clearance(postures, goals[1], places, turns, boxes, HELD_LATE)
    return int(at), checks + count + more


@exact_kernel
def held_clearance(
    postures: Postures, configuration: Floats, places: Floats, turns: Floats, boxes: Floats, part: int
) -> tuple[float, int]:
    """The clearance of a single posture (d,) in one of the parts of an interval, and the capsules that were checked."""
    begin, end = (0, 1) if part == HELD_AT_START else (0, _EARLY) if part == HELD_EARLY else (_LATE, _MOMENTS)
    origin = places[0].copy()
    near = np.empty_like(boxes)
    count = boxes_around(boxes, origin, postures.reach + 0.5, near)
    if count == 0:
        return float(_FAR), 0
    near[:count, :3] -= origin
    segments = pose(postures.limb, configuration.reshape(1, -1))
    total = end - begin
    held = np.empty((segments.shape[0], 6, total), np.float32)
    at, frames = np.empty((total, 3)), np.empty((total, 4))
    for i in range(total):
        held[:, :, i] = segments[:, :, 0]
        look = (begin + i) * _STRIDE
        at[i], frames[i] = places[look] - origin, turns[look]
    lanes = np.empty((segments.shape[0], 7, BLOCK), np.float32)
    place_capsules(held, postures.limb.radii, at, frames, lanes)
    out = np.full((segments.shape[0], BLOCK), _FAR, np.float32)
    checks = capsule_clearances(lanes, near, count, out)
    return float(out.min()), checks
