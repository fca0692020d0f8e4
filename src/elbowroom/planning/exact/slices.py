"""Clearance along a path: of many postures around every key time, and of one motion at every shown moment.

Obstacles come as tables in the frame that carries the limb, one for each of the moments (S to a key interval), and only
those within the limb's reach of a moment are looked at there.
"""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.postures import BETWEEN, Postures
from elbowroom.world.clearance import clearance_into

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]

EARLY = 1  # moments before and after its own at which a posture on the way is looked at


@exact_kernel
def near_rows(table: Floats32, reach: float, rows: Floats32) -> int:
    """Copy the boxes of `table` (B, 15) that come within `reach` of the frame's origin to `rows`; their number."""
    count = 0
    for b in range(table.shape[0]):
        box = table[b]
        size = math.sqrt(box[12] * box[12] + box[13] * box[13] + box[14] * box[14])
        if math.sqrt(box[0] * box[0] + box[1] * box[1] + box[2] * box[2]) - size < reach:
            rows[count] = box
            count += 1
    return count


@exact_kernel
def swept_clearances(
    segments: Floats32, own: Floats32, radii: Floats32, tables: Floats32, samples: int, stride: int, reach: float
) -> tuple[Floats32, int]:
    """The least clearance (n+1, V+E) of every posture while the frame moves half a key interval to either side.

    `segments` (C, 6, V) stand at every key time, `own` (n+1, C, 6, E) at theirs only; `tables` (n S + 1, B, 15) at
    `samples` S moments an interval, of which every `stride`-th is looked at. Also the postures that were checked.
    """
    depths, size, extra = own.shape[0], segments.shape[2], own.shape[3]
    out = np.full((depths, size + extra), np.inf, np.float32)
    rows, moment = np.empty((tables.shape[1], tables.shape[2]), np.float32), np.empty(size, np.float32)
    moment_own = np.empty(extra, np.float32)
    half, checks = samples // 2, 0
    for at in range(0, tables.shape[0], stride):
        count = near_rows(tables[at], reach, rows)
        if count == 0:
            continue
        clearance_into(segments, radii, rows[:count], moment)
        checks += size
        for depth in range(max((at + half - 1) // samples, 0), min((at + half) // samples, depths - 1) + 1):
            if abs(at - depth * samples) > half:
                continue
            clearance_into(own[depth], radii, rows[:count], moment_own)
            checks += extra
            for v in range(size):
                out[depth, v] = min(out[depth, v], moment[v])
            for e in range(extra):
                out[depth, size + e] = min(out[depth, size + e], moment_own[e])
    return out, checks


@exact_kernel
def motion_clearances(segments: Floats32, radii: Floats32, tables: Floats32, reach: float) -> Floats32:
    """The clearance (M,) of a motion, capsules (C, 6, M), each pose among its own boxes, tables (M, B, 15)."""
    out = np.full(tables.shape[0], np.inf, np.float32)
    rows, posture = (
        np.empty((tables.shape[1], tables.shape[2]), np.float32),
        np.empty((segments.shape[0], 6, 1), np.float32),
    )
    for at in range(tables.shape[0]):
        count = near_rows(tables[at], reach, rows)
        if count > 0:
            posture[:, :, 0] = segments[:, :, at]
            clearance_into(posture, radii, rows[:count], out[at : at + 1])
    return out


@exact_kernel
def closed_steps(postures: Postures, tables: Floats32, skin: float, closed: Bools) -> int:
    """Mark in `closed` (E,) the steps within one key interval that touch; returns the postures that were checked.

    `tables` (S+1, B, 15) are the boxes at the interval's moments. A step is looked at on its way, as if it went evenly,
    and a moment earlier and later: playback eases in and out.
    """
    count = postures.between.shape[3]
    free = np.ones((2, count), np.bool_)  # upward, downward
    found = np.empty(count, np.float32)
    rows = np.empty((tables.shape[1], tables.shape[2]), np.float32)
    last, checks = tables.shape[0] - 1, 0
    for part in range(BETWEEN):
        for way in range(2):
            middle = (part + 1 if way == 0 else BETWEEN - part) * last // (BETWEEN + 1)
            for at in range(middle - EARLY, middle + EARLY + 1):
                near = near_rows(tables[at], postures.reach, rows)
                if near == 0:
                    continue
                clearance_into(postures.between[part], postures.limb.radii, rows[:near], found)
                checks += count
                for i in range(count):
                    free[way, i] &= found[i] >= skin
    for k in range(closed.shape[0]):
        pair = postures.pairs[k]
        if pair >= 0:
            closed[k] = not free[0 if postures.upward[k] else 1, pair]
    return checks
