"""Chance for courses: the same numbers on every machine."""

from collections.abc import Sequence
from typing import TypeVar

import numpy as np

Item = TypeVar("Item")
Range = tuple[float, float]

GRAIN = 3  # decimals: all that enters a course is a whole number of millimetres or milliradians


class Draw:
    """Numbers from a PCG64 stream (M. E. O'Neill, 2014), rounded to `GRAIN` decimals.

    Only `Generator.random` is used, whose bits are defined by the stream alone.
    """

    def __init__(self, *key: int) -> None:
        self._rng = np.random.Generator(np.random.PCG64(np.random.SeedSequence(key)))

    def between(self, span: Range) -> float:
        """A number in [low, high]."""
        return round(span[0] + (span[1] - span[0]) * float(self._rng.random()), GRAIN)

    def whole(self, low: int, high: int) -> int:
        """A whole number in [low, high]."""
        return low + int((high - low + 1) * float(self._rng.random()))

    def one_of(self, items: Sequence[Item]) -> Item:
        """One of the items."""
        return items[self.whole(0, len(items) - 1)]

    def chance(self, probability: float) -> bool:
        """True with this probability."""
        return float(self._rng.random()) < probability

    def sign(self) -> int:
        """1 or -1."""
        return 1 if self.chance(0.5) else -1
