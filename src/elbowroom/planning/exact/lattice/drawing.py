"""Postures drawn evenly within the limits of a group's joints: no chance in it, equal calls draw equal postures."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup, clamp, limits
from elbowroom.planning.model.even_points import evenly_spread

Floats = NDArray[np.float64]


def drawn_postures(group: DofGroup, around: Floats, count: int, spread: float) -> Floats:
    """`count` postures (count, d) within the limits: one half all over, the other within `spread` of `around` (d,)."""
    low, high = limits(group).T
    even = evenly_spread(count, group.size)
    half = count // 2
    everywhere = low + even[:half] * (high - low)
    nearby = around + spread * (2.0 * even[half:] - 1.0)
    return clamp(group, np.concatenate([nearby, everywhere]))
