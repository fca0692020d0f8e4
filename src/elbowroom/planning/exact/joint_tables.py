"""What the joint step looks up: prices of arm postures under many waists, steps, and which arms keep apart.

An arm's capsules stand still in the chest frame, so each waist of each slice brings its own boxes: those of the pelvis
frame at the moments around the key time, moved into the chest frame that this waist makes. This is the dear part of the
joint step; therefore it is filled slice by slice and waist by waist, as far as it is asked for.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import kernel
from elbowroom.world.clearance import clearance_into

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]


class ArmPrices(NamedTuple):
    """How clearance becomes a price."""

    base: Floats32  # (n+1, V) of each posture, whatever is near
    margins: Floats32  # (n+1,) metres: a posture with less clearance is not free
    comfort: float  # metres: less clearance costs more
    near_weight: float  # squared radians for each square metre of lacking comfort


@kernel
def move_rows(rows: Floats32, count: int, place: Floats, turn: Floats, out: Floats32) -> None:
    """The first `count` boxes of `rows` (B, 15) seen from a frame at `place` (3,) with matrix `turn` (3, 3)."""
    for b in range(count):
        row, target = rows[b], out[b]
        x, y, z = row[0] - place[0], row[1] - place[1], row[2] - place[2]
        for k in range(3):
            target[k] = turn[0, k] * x + turn[1, k] * y + turn[2, k] * z
            target[12 + k] = row[12 + k]
            for i in range(3):
                m = 3 + 3 * i
                target[m + k] = row[m] * turn[0, k] + row[m + 1] * turn[1, k] + row[m + 2] * turn[2, k]


@kernel
def _near(rows: Floats32, reach: float, out: Floats32) -> int:
    """Copy the boxes of `rows` (B, 15) that come within `reach` of the frame's origin to `out`; their number."""
    count = 0
    for b in range(rows.shape[0]):
        row, total = rows[b], 0.0
        for i in range(3):
            place = row[3 + 3 * i] * row[0] + row[4 + 3 * i] * row[1] + row[5 + 3 * i] * row[2]
            beyond = max(abs(place) - row[12 + i], 0.0)
            total += beyond * beyond
        if total < reach * reach:
            out[count] = row
            count += 1
    return count


@kernel
def clearances_under(
    segments: Floats32, radii: Floats32, tables: Floats32, place: Floats, turn: Floats, reach: float
) -> tuple[Floats32, int]:
    """The least clearance (V,) of postures (C, 6, V) over moments, under one waist, and the postures that were checked.

    `tables` (m, B, 15) are the boxes in the pelvis frame at the moments, `place` and `turn` the chest frame in it.
    """
    out = np.full(segments.shape[2], np.float32(np.inf), np.float32)
    moved, near = np.empty(tables.shape[1:], np.float32), np.empty(tables.shape[1:], np.float32)
    found, checks = np.empty(segments.shape[2], np.float32), 0
    for at in range(tables.shape[0]):
        move_rows(tables[at], tables.shape[1], place, turn, moved)
        count = _near(moved, reach, near)
        if count == 0:
            continue
        clearance_into(segments, radii, near[:count], found)
        checks += found.shape[0]
        for v in range(np.uint64(out.shape[0])):
            out[v] = min(out[v], found[v])
    return out, checks


@kernel
def fill_prices(prices: Floats32, how: ArmPrices, depth: int, waist: int, clear: Floats32, own: Floats32) -> None:
    """Enter the prices of an arm's postures at a depth under a waist into `prices` (n+1, W, V).

    For clearances `clear` (V,) from boxes and `own` (V,) from the body itself, both in metres beyond what is allowed.
    """
    target, base, margin = prices[depth, waist], how.base[depth], how.margins[depth]
    for v in range(np.uint64(target.shape[0])):
        lack = max(how.comfort - clear[v], 0.0)
        free = clear[v] >= margin and own[v] >= 0.0
        target[v] = base[v] + how.near_weight * lack * lack if free else np.inf


@kernel
def step_costs(before: Floats, after: Floats, shift: Floats, longest: float, weight: float) -> Floats32:
    """What steps cost (V, U) from postures (V, d) to (U, d) while the goal moves by `shift` (d,).

    `weight` times the squared change of the deviation from the goal; infinite where a step is longer than `longest`.
    """
    out = np.empty((before.shape[0], after.shape[0]), np.float32)
    for v in range(before.shape[0]):
        for u in range(after.shape[0]):
            moved, changed = 0.0, 0.0
            for i in range(before.shape[1]):
                way = after[u, i] - before[v, i]
                moved += way * way
                changed += (way - shift[i]) * (way - shift[i])
            out[v, u] = weight * changed if moved <= longest * longest * (1.0 + 1e-9) else np.inf
    return out
