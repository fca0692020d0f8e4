"""The room that a body has on a grid of places, at each of them for several turns of the body.

The capsules are only moved to the places, not posed anew: one batch for each box, turn and part of the body.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.world.clearance import clearance_into

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

_FIRST = 0  # place of the grid
_TALL = 2.0  # metres: height of the axis round which a body is looked for


class Room(NamedTuple):
    """The room on a grid, with each cell's best place: not more than half a column from its middle."""

    clear: Floats32  # (3, rows, columns, turns) of legs, trunk, hanging arms; no more than the comfort
    shift: Floats32  # (rows, columns, turns) metres from the middle to the best place, to the left


@exact_kernel
def _extents(body: Floats32, radii: Floats32) -> tuple[float, float, float]:
    """How far capsules (C, 6) reach from the origin, seen from above; their lowest and highest point."""
    most, low, high = 0.0, np.inf, -np.inf
    for c in range(body.shape[0]):
        for e in (0, 3):
            most = max(most, np.sqrt(body[c, e] ** 2 + body[c, e + 2] ** 2) + radii[c])
            low, high = min(low, body[c, e + 1] - radii[c]), max(high, body[c, e + 1] + radii[c])
    return most, low, high


@exact_kernel
def _lower_to_box(
    body: Floats32, radii: Floats32, x: Floats32, z: Floats32, box: Floats32, away: Floats32, most: float, out: Floats32
) -> None:
    """out[n] = min(out[n], clearance of the body at place n); `away` (N,) is the clearance of the place's own axis."""
    reach, low, high = _extents(body, radii)
    span = 0.0
    for k in range(3):
        span += abs(box[0, 4 + 3 * k]) * box[0, 12 + k]
    if box[0, 1] - span > high + most or box[0, 1] + span < low - most:
        return
    near, count = np.empty(x.shape[0], np.int64), 0
    for n in range(x.shape[0]):
        if away[n] < reach + most:
            near[count] = n
            count += 1
    if count == 0:
        return
    segments, found = np.empty((body.shape[0], 6, count), np.float32), np.empty(count, np.float32)
    for c in range(body.shape[0]):
        for e in (0, 3):
            row_x, row_y, row_z = segments[c, e], segments[c, e + 1], segments[c, e + 2]
            for i in range(count):
                row_x[i], row_y[i], row_z[i] = body[c, e] + x[near[i]], body[c, e + 1], body[c, e + 2] + z[near[i]]
    clearance_into(segments, radii, box, found)
    for i in range(count):
        out[near[i]] = min(out[near[i]], found[i])


@exact_kernel
def _stand(axis: Floats32, x: Floats32, z: Floats32, first: int) -> None:
    """Stand axes (1, 6, n) up at n places from the one numbered `first` on."""
    for i in range(axis.shape[2]):
        axis[0, 0, i] = axis[0, 3, i] = x[first + i]
        axis[0, 2, i] = axis[0, 5, i] = z[first + i]
        axis[0, 1, i], axis[0, 4, i] = np.float32(0.0), np.float32(_TALL)


@exact_kernel
def room_of(
    bodies: Floats32,
    groups: Indices,
    radii: Floats32,
    table: Floats32,
    passing: Floats32,
    place: Floats,
    shape: tuple[int, int],
) -> Room:
    """The room of the body's parts `groups` on the grid, a batch for each box, turn and part.

    `table` (B, 15) stands still, `passing` (rows, M, 15) is where a row is when it matters.
    `place`: sine and cosine of the line's heading, the distance of rows and of columns, and the comfort.
    """
    sine, cosine, step, aside, comfort = place[0], place[1], place[2], place[3], place[4]
    rows, columns = shape
    total, turns = rows * columns, bodies.shape[0]
    x, z = np.empty(total, np.float32), np.empty(total, np.float32)
    for n in range(total):
        ahead, left = (n // columns) * step, (n % columns - columns // 2) * aside
        x[n], z[n] = ahead * sine + left * cosine, ahead * cosine - left * sine
    axis, axis_of_row = np.empty((1, 6, total), np.float32), np.empty((1, 6, columns), np.float32)
    _stand(axis, x, z, int(_FIRST))
    out, away = np.full((3, turns, total), np.float32(comfort), np.float32), np.empty(total, np.float32)
    for b in range(table.shape[0]):
        box = table[b : b + 1]
        clearance_into(axis, np.zeros(1, np.float32), box, away)
        for t in range(turns):
            for g in range(3):
                part = slice(groups[g], groups[g + 1])
                _lower_to_box(bodies[t, part], radii[part], x, z, box, away, comfort, out[g, t])
    for i in range(rows):
        row = slice(i * columns, (i + 1) * columns)
        _stand(axis_of_row, x, z, i * columns)
        for b in range(passing.shape[1]):
            box = passing[i, b : b + 1]
            clearance_into(axis_of_row, np.zeros(1, np.float32), box, away[row])
            for t in range(turns):
                for g in range(3):
                    part = slice(groups[g], groups[g + 1])
                    _lower_to_box(bodies[t, part], radii[part], x[row], z[row], box, away[row], comfort, out[g, t, row])
    clear = np.empty((3, rows, columns, turns), np.float32)
    for g in range(3):
        for t in range(turns):
            for n in range(total):
                clear[g, n // columns, n % columns, t] = out[g, t, n]
    return _at_best(clear, comfort, aside)


@exact_kernel
def _at_best(clear: Floats32, comfort: float, aside: float) -> Room:
    """The room at every cell's best place.

    Clearance changes by no more than one walks: so neighbours bound it, and between parallel walls it is the bound.
    """
    best, shift = clear.copy(), np.zeros(clear.shape[1:], np.float32)
    for i in range(clear.shape[1]):
        for j in range(1, clear.shape[2] - 1):
            for t in range(clear.shape[3]):
                for g in range(2, -1, -1):
                    own, right, left = clear[g, i, j, t], clear[g, i, j - 1, t], clear[g, i, j + 1, t]
                    if own < comfort:
                        best[g, i, j, t] = min(own + 0.5 * aside, max(0.5 * (left + right) + aside, own), comfort)
                        shift[i, j, t] = min(max(0.5 * (left - right), -0.5 * aside), 0.5 * aside)
    return Room(best, shift)
