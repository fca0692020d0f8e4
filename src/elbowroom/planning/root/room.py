"""The room that a body has on a grid of places, at each of them for several turns of the body.

The capsules are only moved to the places, not posed anew: one batch for each row, box, turn and part of the body.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.world.obstacles.clearance import clearance_into
from elbowroom.world.obstacles.from_above import ball_radius, heights_of, place_of
from elbowroom.world.obstacles.layout import Spans
from elbowroom.world.obstacles.rows import at_span, how_many, shifted_into, single, spans_in

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

_TALL = 2.0  # metres: height of the axis round which a body is looked for


class Room(NamedTuple):
    """The room on a grid, with each cell's best place: not more than half a column from its middle."""

    clear: Floats32  # (3, rows, columns, turns) of legs, trunk, hanging arms; no more than the comfort
    shift: Floats32  # (rows, columns, turns) metres from the middle to the best place, to the left


@exact_kernel
def lower_rows(
    clear: Floats32, bodies: Floats32, groups: Indices, radii: Floats32, obstacles: Spans, place: Floats, first: float
) -> None:
    """Lower the clearance of rows (n, 3, T, columns) of places on a line, from row `first` on, to what boxes leave.

    `bodies` (T, C, 6, columns) are the capsules in each turn at the places of a row, seen from its middle, `groups`
    (4,) where legs, trunk and arms begin among them. `obstacles` (n, B) are those of each row, or (1, B) those of all.
    `place`: where the line begins, sine and cosine of its heading, the distance of rows and of columns, and the
    comfort, beyond which nothing is looked at.

    Each row is looked at by itself: it is the same to the last bit, whatever rows are asked for with it.
    """
    sine, cosine, step, most = place[2], place[3], place[4], place[6]
    turns, columns = clear.shape[2], clear.shape[3]
    wide = place[5] * (columns // 2) + most
    axis = np.empty((1, 6, columns), np.float32)
    for j in range(columns):
        left = place[5] * (j - columns // 2)
        for e in (0, 3):
            axis[0, e, j], axis[0, e + 2, j] = left * cosine, -left * sine
        axis[0, 1, j], axis[0, 4, j] = 0.0, _TALL
    extents, farthest = _extents(bodies, groups, radii, axis)
    none, one = np.empty(1, np.float32), single(obstacles)
    away, found = np.empty(columns, np.float32), np.empty(columns, np.float32)
    none[0] = 0.0
    for i in range(clear.shape[0]):
        ahead = (first + i) * step
        middle_x, middle_z = place[0] + ahead * sine, place[1] + ahead * cosine
        own = at_span(obstacles, min(i, spans_in(obstacles) - 1))
        for b in range(how_many(own)):
            x, z = place_of(own, b)
            dx, dz, size = x - middle_x, z - middle_z, ball_radius(own, b)
            if np.sqrt(dx * dx + dz * dz) > size + wide + farthest:
                continue
            shifted_into(own, b, middle_x, middle_z, one)
            bottom, top = heights_of(own, b)
            clearance_into(axis, none, one, away)
            nearest = np.inf
            for j in range(columns):
                nearest = min(nearest, away[j])
            for t in range(turns):
                for g in range(3):
                    reach, low, high = extents[t, g, 0], extents[t, g, 1], extents[t, g, 2]
                    if nearest >= reach + most or bottom > high + most or top < low - most:
                        continue
                    clearance_into(bodies[t, groups[g] : groups[g + 1]], radii[groups[g] : groups[g + 1]], one, found)
                    for j in range(columns):
                        clear[i, g, t, j] = min(clear[i, g, t, j], found[j])


@exact_kernel
def _extents(bodies: Floats32, groups: Indices, radii: Floats32, axis: Floats32) -> tuple[Floats, float]:
    """How far the parts of a body reach from its axis, seen from above, their lowest and highest point, (T, 3, 3).

    And how far any of them reaches.
    """
    out, farthest = np.empty((bodies.shape[0], 3, 3)), 0.0
    for t in range(bodies.shape[0]):
        for g in range(3):
            most, low, high = 0.0, np.inf, -np.inf
            for c in range(groups[g], groups[g + 1]):
                for e in (0, 3):
                    x, z = bodies[t, c, e, 0] - axis[0, 0, 0], bodies[t, c, e + 2, 0] - axis[0, 2, 0]
                    most = max(most, np.sqrt(x * x + z * z) + radii[c])
                    low, high = (
                        min(low, bodies[t, c, e + 1, 0] - radii[c]),
                        max(high, bodies[t, c, e + 1, 0] + radii[c]),
                    )
            out[t, g, 0], out[t, g, 1], out[t, g, 2] = most, low, high
            farthest = max(farthest, most)
    return out, farthest


@exact_kernel
def room_at_best(rows: Floats32, comfort: float, aside: float) -> Room:
    """The room at every cell's best place, of rows (n, 3, T, columns) as in `lower_rows`.

    Clearance changes by no more than one walks: so neighbours bound it, and between parallel walls it is the bound.
    """
    count, turns, columns = rows.shape[0], rows.shape[2], rows.shape[3]
    best, shift = np.empty((3, count, columns, turns), np.float32), np.empty((count, columns, turns), np.float32)
    for i in range(count):
        for j in range(columns):
            for t in range(turns):
                for g in range(2, -1, -1):
                    own = rows[i, g, t, j]
                    best[g, i, j, t], shift[i, j, t] = own, 0.0
                    if own < comfort and 0 < j < columns - 1:
                        right, left = rows[i, g, t, j - 1], rows[i, g, t, j + 1]
                        best[g, i, j, t] = min(own + 0.5 * aside, max(0.5 * (left + right) + aside, own), comfort)
                        shift[i, j, t] = min(max(0.5 * (left - right), -0.5 * aside), 0.5 * aside)
    return Room(best, shift)
