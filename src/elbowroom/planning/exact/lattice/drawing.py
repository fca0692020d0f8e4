"""Postures drawn evenly within the limits of a group's joints.

The points are those of an additive recurrence that fills space evenly (M. Roberts, "The unreasonable effectiveness of
quasirandom sequences", 2018): no chance is left in it, equal calls draw equal postures.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup, clamp, limits

Floats = NDArray[np.float64]


def drawn_postures(group: DofGroup, around: Floats, count: int, spread: float) -> Floats:
    """`count` postures (count, d) within the limits: one half all over, the other within `spread` of `around` (d,)."""
    low, high = limits(group).T
    even = evenly_spread(count, group.size)
    half = count // 2
    everywhere = low + even[:half] * (high - low)
    nearby = around + spread * (2.0 * even[half:] - 1.0)
    return clamp(group, np.concatenate([nearby, everywhere]))


def evenly_spread(count: int, size: int) -> Floats:
    """Points (count, size) of the additive recurrence with the powers of the generalised golden ratio."""
    ratio = 2.0
    for _ in range(60):
        ratio = (1.0 + ratio) ** (1.0 / (size + 1.0))
    steps = ratio ** -np.arange(1.0, size + 1.0)
    points: Floats = (0.5 + np.arange(1.0, count + 1.0)[:, None] * steps) % 1.0
    return points
