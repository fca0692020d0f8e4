"""What is in the way in spans of time over some ground: what stands there, and what moving things sweep."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.world.obstacles.layout import ROUNDING, ROW, Nearby, Spans
from elbowroom.world.obstacles.rows import bounds_of
from elbowroom.world.obstacles.tracks.moving import Moving

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

Place = tuple[float, float]  # x and z, metres


class Along(NamedTuple):
    """B obstacles in n spans of time."""

    spans: Spans  # (n, B) in each span
    moments: Spans  # (n+1, B) around each moment between, in both spans that meet there
    stamps: Floats  # (n,) alike where what moves is alike; 0 where nothing does
    numbers: Longs  # (B,) of the obstacles; those that move come after those that stand


def along(
    standing: Nearby, numbers: Longs, many: int, moving: Moving, times: Floats, ground: tuple[Place, Place]
) -> Along:
    """What is in the way between the `times` (n+1,), of what stands and moves over a rectangle on the ground.

    `standing` are there already, by their `numbers` among as `many`; `ground` has the rectangle's corners.
    """
    moments = np.repeat(standing.rows[None], len(times), axis=0)
    spans, still = moments[:-1], np.zeros(len(times) - 1)
    sweeps = moving.swept(times).rows if len(moving) else moments[:-1, :0]
    near = _meeting(sweeps, ground)
    if not len(near):
        return Along(Spans(spans, standing.packed), Spans(moments, standing.packed), still, numbers)
    around = np.arange(len(times))
    first, last = times[np.maximum(around - 1, 0)], times[np.minimum(around + 1, len(times) - 1)]
    doubled = np.ascontiguousarray(moving.swept_between(first, last).rows[:, near])
    swept = np.ascontiguousarray(sweeps[:, near])
    known = swept[..., :ROUNDING].reshape(len(still), -1)
    return Along(
        Spans(np.concatenate([spans, swept], axis=1), standing.packed),
        Spans(np.concatenate([moments, doubled], axis=1), standing.packed),
        known @ np.sqrt(np.arange(2.0, 2.0 + known.shape[1])),
        np.concatenate([numbers, many + near]),
    )


def _meeting(sweeps: Floats, ground: tuple[Place, Place]) -> Longs:
    """Which of the boxes (n, B, ROW) are over a rectangle in any of the spans."""
    least, most = bounds_of(Nearby(sweeps.reshape(-1, ROW), np.zeros(0, np.float32)))
    (low_x, low_z), (high_x, high_z) = ground
    over = (least[:, 0] <= high_x) & (most[:, 0] >= low_x) & (least[:, 2] <= high_z) & (most[:, 2] >= low_z)
    found: Longs = np.flatnonzero(over.reshape(sweeps.shape[:2]).any(axis=0))
    return found
