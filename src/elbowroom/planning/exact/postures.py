"""The postures of one local group, frozen: where their capsules are, and which follows which within a key interval."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.activity_graph import squared_distance
from elbowroom.planning.limb import Limb, pose

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Ints = NDArray[np.int32]

_SPARE = 0.15  # metres: a posture between the known ones may reach so much farther


class Postures(NamedTuple):
    """Postures of a limb and the steps between them; `step` is the longest, itself included."""

    limb: Limb
    configurations: Floats  # (V, d) radians
    segments: Floats32  # (C, 6, V) capsules in the limb's frame, metres
    first: Ints  # (V+1,) where a posture's row of `targets` begins
    targets: Ints  # the postures within `step` of each, itself included, ascending
    step: float  # radians
    reach: float  # metres: no capsule gets farther from the limb's frame


def postures_of(limb: Limb, configurations: Floats, step: float) -> Postures:
    """Link `configurations` (V, d) that are at most `step` apart."""
    points = np.ascontiguousarray(configurations, np.float64)
    segments = pose(limb, points)
    ends = segments.transpose(0, 2, 1).reshape(-1, 3)
    reach = float(np.linalg.norm(ends, axis=1).max()) + float(limb.radii.max()) + _SPARE
    first, targets = _linked(points, step * step)
    return Postures(limb, points, segments, first, targets, float(step), reach)


@exact_kernel
def _linked(points: Floats, reach: float) -> tuple[Ints, Ints]:
    first = np.zeros(points.shape[0] + 1, np.int32)
    targets = np.empty(points.shape[0] * points.shape[0], np.int32)
    count = 0
    for i in range(points.shape[0]):
        for j in range(points.shape[0]):
            if squared_distance(points[i], points[j]) <= reach:
                targets[count] = j
                count += 1
        first[i + 1] = count
    return first, targets[:count].copy()
