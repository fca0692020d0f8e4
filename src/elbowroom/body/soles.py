"""How the soles of an avatar roll over the ground: boots, boxes and paws reach farther than average feet."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

PITCHES = np.linspace(-0.4, 1.2, 17)  # radians, toes down, at which it is told where an ankle is


class Soles(NamedTuple):
    """What of the feet is on the ground, for left and right."""

    heels: Floats  # (2,) metres that they reach behind the ankle; negative where they begin before it
    tips: Floats  # (2,) metres that they reach before it
    rolls: Floats  # (2, 17, 2) how far ahead of its flat place an ankle is at `PITCHES`, and how high; metres

    def scaled(self, factor: float) -> "Soles":
        """The soles of an avatar so many times as large."""
        return Soles(factor * self.heels, factor * self.tips, factor * self.rolls)
