"""The boxes that the upper body could reach on a path: those that stand, and what moving ones sweep meanwhile."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.root.path import RootPath, ground_covered
from elbowroom.world.boxes import BOX_ROW
from elbowroom.world.moving import MovingBoxes

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]


class NearBoxes(NamedTuple):
    """What is in the way along a path of n key intervals."""

    intervals: Floats  # (n, B, 15) in the world, in each key interval
    slices: Floats  # (n+1, B, 15) the same around each key time, in both intervals that meet there
    stamps: Floats  # (n,) alike where what moves is alike; 0 where nothing does
    rows: Longs  # (B,) the boxes' numbers in the scene; those that move come after those that stand


def near_boxes(path: RootPath, table: Floats, moving: MovingBoxes, reach: float) -> NearBoxes:
    """What of `table` (B, 15) and of what moves comes within `reach` metres of a path."""
    rows, slices = _standing(table, path.states, reach)
    intervals, count = slices[:-1], len(slices) - 1
    if not moving.tracks:
        return NearBoxes(intervals, slices, np.zeros(count), rows)
    sweeps = moving.swept(path.times)
    near = np.unique(_near(sweeps.reshape(-1, BOX_ROW), path.states, reach) % sweeps.shape[1])
    if not len(near):
        return NearBoxes(intervals, slices, np.zeros(count), rows)
    around = np.arange(count + 1)
    first, last = path.times[np.maximum(around - 1, 0)], path.times[np.minimum(around + 1, count)]
    doubled = moving.swept_between(first, last)[:, near]
    weights = np.sqrt(np.arange(2.0, 2.0 + len(near) * BOX_ROW))
    return NearBoxes(
        np.ascontiguousarray(np.concatenate([intervals, sweeps[:, near]], axis=1)),
        np.ascontiguousarray(np.concatenate([slices, doubled], axis=1)),
        sweeps[:, near].reshape(count, -1) @ weights,
        np.concatenate([rows, len(table) + near]),
    )


@exact_kernel
def _near(rows: Floats, states: Floats, reach: float) -> Longs:
    """The numbers of the boxes (B, 15) that may come within `reach` of root states (N, 7): those near to a rectangle on
    the ground that holds them."""
    low_x, high_x, low_z, high_z = ground_covered(states)
    found, count = np.empty(rows.shape[0], np.int64), 0
    for b in range(rows.shape[0]):
        x, z, half = rows[b, 0], rows[b, 2], rows[b, 12:]
        aside, ahead = x - min(max(x, low_x - reach), high_x + reach), z - min(max(z, low_z - reach), high_z + reach)
        if np.sqrt(aside * aside + ahead * ahead) < np.sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]):
            found[count] = b
            count += 1
    return found[:count]


@exact_kernel
def _standing(table: Floats, states: Floats, reach: float) -> tuple[Longs, Floats]:
    """The numbers of the boxes that are `_near`, and their rows (N, B, 15) for each of the root states."""
    near = _near(table, states, reach)
    out = np.empty((states.shape[0], near.shape[0], table.shape[1]))
    for n in range(out.shape[0]):
        for b in range(near.shape[0]):
            for c in range(table.shape[1]):
                out[n, b, c] = table[near[b], c]
    return near, out
