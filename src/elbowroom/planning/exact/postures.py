"""The postures of one local group, frozen: where their capsules are, and which follows which within a key interval.

A step from one posture to another passes three postures between them. They are posed once, with the rest, so that all
steps of a key interval can be checked in one batch.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.activity_graph import squared_distance
from elbowroom.planning.limb import Limb, pose
from elbowroom.planning.self_contact import clear_of_trunk

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Ints = NDArray[np.int32]
Bools = NDArray[np.bool_]

_SPARE = 0.15  # metres: a posture between the known ones may reach so much farther
BETWEEN = 3  # postures between two, at equal parts of the way


class Postures(NamedTuple):
    """Postures of a limb and the steps between them; `step` is the longest, staying is one."""

    limb: Limb
    configurations: Floats  # (V, d) radians
    segments: Floats32  # (C, 6, V) capsules in the limb's frame, metres
    first: Ints  # (V+1,) where the steps from a posture begin in `targets`
    targets: Ints  # (E,) where each step leads, ascending for each posture
    pairs: Ints  # (E,) the unordered pair of postures that a step joins; -1 for staying
    low: Ints  # (P,) the lower number of each pair
    high: Ints  # (P,)
    upward: Bools  # (E,) whether it goes from the lower number to the higher
    between: Floats32  # (BETWEEN, C, 6, P) capsules of the postures on the way from the lower number to the higher
    step: float  # radians
    reach: float  # metres: no capsule gets farther from the limb's frame


def postures_of(limb: Limb, configurations: Floats, step: float) -> Postures:
    """Link `configurations` (V, d) that are at most `step` apart, unless the way leads through the trunk."""
    points = np.ascontiguousarray(configurations, np.float64)
    segments = pose(limb, points)
    ends = segments.transpose(0, 2, 1).reshape(-1, 3)
    reach = float(np.linalg.norm(ends, axis=1).max()) + float(limb.radii.max()) + _SPARE
    low, high = _near_pairs(points, step * step)
    parts = np.arange(1, BETWEEN + 1) / (BETWEEN + 1.0)
    ways = [pose(limb, points[low] + part * (points[high] - points[low])) for part in parts]
    clear = np.all([clear_of_trunk(way, limb.trunk, limb.allowed) for way in ways], axis=0)
    between = np.ascontiguousarray(np.stack(ways)[..., clear])
    low, high = low[clear], high[clear]
    first, targets, pairs, upward = _steps(len(points), low, high)
    return Postures(limb, points, segments, first, targets, pairs, low, high, upward, between, float(step), reach)


@exact_kernel
def _near_pairs(points: Floats, reach: float) -> tuple[Ints, Ints]:
    """All pairs low < high at most the root of `reach` apart."""
    count, size = 0, points.shape[0]
    low, high = np.empty(size * size // 2, np.int32), np.empty(size * size // 2, np.int32)
    for i in range(size):
        for j in range(i + 1, size):
            if squared_distance(points[i], points[j]) <= reach:
                low[count], high[count] = i, j
                count += 1
    return low[:count].copy(), high[:count].copy()


def _steps(size: int, low: Ints, high: Ints) -> tuple[Ints, Ints, Ints, Bools]:
    """Both directions of every pair, and staying, sorted by source and target."""
    stay, pairs = np.arange(size), np.arange(len(low))
    sources = np.concatenate([stay, low, high])
    targets = np.concatenate([stay, high, low])
    numbers = np.concatenate([np.full(size, -1), pairs, pairs])
    order = np.lexsort((targets, sources))
    first = np.searchsorted(sources[order], np.arange(size + 1))
    ascending = sources[order] < targets[order]
    return first.astype(np.int32), targets[order].astype(np.int32), numbers[order].astype(np.int32), ascending
