"""Clearance along a path: of many postures around every key time, and of one motion at every shown moment.

Obstacles come as tables in the frame that carries the limb, one for each of the moments (S to a key interval), and only
those within the limb's reach of a moment are looked at there.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.postures import BETWEEN, Postures
from elbowroom.world.clearance import clearance_into

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

EARLY = 1  # moments before and after its own at which a posture on the way is looked at


@exact_kernel
def near_rows(table: Floats32, reach: float, rows: Floats32) -> int:
    """Copy the boxes of `table` (B, 15) that come within `reach` of the frame's origin to `rows`; their number."""
    count = 0
    for b in range(table.shape[0]):
        box, total = table[b], 0.0
        for i in range(3):
            place = box[3 + 3 * i] * box[0] + box[4 + 3 * i] * box[1] + box[5 + 3 * i] * box[2]
            beyond = max(abs(place) - box[12 + i], 0.0)
            total += beyond * beyond
        if total < reach * reach:
            rows[count] = box
            count += 1
    return count


@exact_kernel
def any_free(segments: Floats32, radii: Floats32, tables: Floats32, reach: float, margin: float) -> Bools:
    """Whether any of the postures (C, 6, V) keeps `margin` from the boxes of each table (F, B, 15): shape (F,)."""
    free = np.ones(tables.shape[0], np.bool_)
    rows, found = np.empty((tables.shape[1], tables.shape[2]), np.float32), np.empty(segments.shape[2], np.float32)
    for f in range(tables.shape[0]):
        count = near_rows(tables[f], reach, rows)
        if count > 0:
            clearance_into(segments, radii, rows[:count], found)
            free[f] = found.max() >= margin
    return free


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
def _open_pairs(postures: Postures, sources: Bools, targets: Bools) -> Indices:
    """The pairs that a way may use: from a source to a target, in one direction or the other."""
    pairs, count = np.empty(postures.low.shape[0], np.int64), 0
    for i in range(pairs.shape[0]):
        low, high = postures.low[i], postures.high[i]
        if (sources[low] and targets[high]) or (sources[high] and targets[low]):
            pairs[count] = i
            count += 1
    return pairs[:count]


@exact_kernel
def _gathered(segments: Floats32, pairs: Indices) -> Floats32:
    out = np.empty((segments.shape[0], segments.shape[1], pairs.shape[0]), np.float32)
    for c in range(segments.shape[0]):
        for i in range(segments.shape[1]):
            for n in range(pairs.shape[0]):
                out[c, i, n] = segments[c, i, pairs[n]]
    return out


@exact_kernel
def closed_steps(
    postures: Postures, tables: Floats32, skin: float, sources: Bools, targets: Bools, closed: Bools
) -> int:
    """Mark in `closed` (E,) the steps within one key interval that touch; returns the postures that were checked.

    `tables` (S+1, B, 15) are the boxes at the interval's moments; only steps from `sources` (V,) to `targets` (V,) are
    looked at. A step is looked at on its way, as if it went evenly, and a moment earlier and later: playback eases in
    and out.
    """
    pairs = _open_pairs(postures, sources, targets)
    free = np.ones((2, postures.low.shape[0]), np.bool_)  # upward, downward
    found = np.empty(pairs.shape[0], np.float32)
    rows = np.empty((tables.shape[1], tables.shape[2]), np.float32)
    last, checks = tables.shape[0] - 1, 0
    for part in range(BETWEEN):
        segments = _gathered(postures.between[part], pairs)
        for way in range(2):
            middle = (part + 1 if way == 0 else BETWEEN - part) * last // (BETWEEN + 1)
            for at in range(middle - EARLY, middle + EARLY + 1):
                near = near_rows(tables[at], postures.reach, rows)
                if near == 0:
                    continue
                clearance_into(segments, postures.limb.radii, rows[:near], found)
                checks += found.shape[0]
                for i in range(found.shape[0]):
                    free[way, pairs[i]] &= found[i] >= skin
    for k in range(closed.shape[0]):
        pair = postures.pairs[k]
        if pair >= 0:
            closed[k] = not free[0 if postures.upward[k] else 1, pair]
    return checks
