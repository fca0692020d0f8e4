"""The boxes that the upper body could reach on a path: those that stand, and what moving ones sweep meanwhile."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.root_path import RootPath
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
    low, high = path.states[:, :2].min(axis=0) - reach, path.states[:, :2].max(axis=0) + reach
    rows = np.flatnonzero(_near(table, low, high))
    still, count = table[rows][None], path.horizon
    intervals, slices = np.repeat(still, count, axis=0), np.repeat(still, count + 1, axis=0)
    if not len(moving):
        return NearBoxes(intervals, slices, np.zeros(count), rows)
    sweeps = moving.swept(path.times)
    near = np.flatnonzero(_near(sweeps.reshape(-1, BOX_ROW), low, high).reshape(sweeps.shape[:2]).any(axis=0))
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


def _near(rows: Floats, low: Floats, high: Floats) -> NDArray[np.bool_]:
    """Which boxes (B, 15) may come into a rectangle on the ground."""
    places = rows[:, [0, 2]]
    gaps = np.linalg.norm(places - np.clip(places, low, high), axis=1)
    found: NDArray[np.bool_] = gaps < np.linalg.norm(rows[:, 12:], axis=1)
    return found
