"""When a foot stands, and how far it slides while it does.

A foot stands as planned while the walk says so. By its looks it stands from the moment when it has come to rest on the
ground (its sole less than 5 mm above it, and a point of it there slower than 0.05 m/s) until its last rest before it is
lifted by more than 5 mm. So a swinging foot that skims the ground does not stand, and one that rests, slips and rests
again does; what it moves by before its first rest and after its last one belongs to the swing.

A sole that rolls from heel to toe has at each moment a point that rests. So of all points of the sole near the ground
the one counts that moves least from each frame to the next, and what these steps come to is the slide.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

LOW = 0.005  # metres above the ground
SLOW = 0.05  # m/s


def resting_steps(points: Floats) -> Floats:
    """How a sole (N, P, 3) moves over the ground from frame to frame, (N-1, 2): by its point that moves least.

    Of those that are near the ground before and after; where there are none, by its lowest point.
    """
    steps = np.diff(points[:, :, [0, 2]], axis=0)
    heights = np.maximum(points[1:, :, 1], points[:-1, :, 1])
    lengths = np.linalg.norm(steps, axis=2)
    near = heights < np.maximum(LOW, heights.min(axis=1, keepdims=True) + 1e-9)
    chosen = np.where(near, lengths, np.inf).argmin(axis=1)
    moves: Floats = steps[np.arange(len(steps)), chosen]
    return moves


def standing_by_looks(points: Floats, rate: float) -> Bools:
    """Whether the foot with the sole (N, P, 3) stands, by what is seen at `rate` frames a second."""
    low = points[:, :, 1].min(axis=1) < LOW
    speeds = rate * np.linalg.norm(resting_steps(points), axis=1)
    slow = np.append(speeds, speeds[-1:]) < SLOW
    standing = np.zeros(len(points), np.bool_)
    for run in stretches(low):
        rests = run.start + np.flatnonzero(slow[run])
        if len(rests):
            standing[rests[0] : rests[-1] + 1] = True
    return standing


def stretches(mask: Bools) -> Iterator[slice]:
    """The runs of frames in which a mask (N,) holds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]).astype(np.int8)))
    for first, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        yield slice(first, end)


def slides(points: Floats, standing: Bools) -> Floats:
    """How far a sole (N, P, 3) gets from where it began to stand, metres, for each stance."""
    steps = resting_steps(points)
    found = []
    for run in stretches(standing):
        way = np.cumsum(steps[run.start : run.stop - 1], axis=0)
        found.append(float(np.linalg.norm(way, axis=1).max()) if len(way) else 0.0)
    return np.array(found)
