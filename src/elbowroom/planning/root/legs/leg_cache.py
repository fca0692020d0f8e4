"""What is known of the legs among things that stand: how near they come in a key interval, and in a stop.

Who follows a path walks its key intervals again in the next plan, and what stands has not moved. So each is looked at
once, and known under the very bits of the states that it depends on: what is recalled is what would be found.
"""

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.root.legs.along_path import UNKNOWN

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

Name = tuple[float, bytes]  # seconds of a key interval, and the bits of the states at its ends or of a stop's beginning

_MOST = 4096  # are remembered


class KnownLegs:
    """The least room of legs and pelvis in key intervals and stops, of one body among things that stand."""

    def __init__(self) -> None:
        self._least: dict[Name, float] = {}

    def recalled(self, interval: float, states: Floats) -> tuple[Floats32, list[Name]]:
        """What is known (2, n) of the key intervals of a path (n+1, 7) and of the stops from their ends.

        `UNKNOWN` elsewhere; and the names of all of them.
        """
        rows = [row.tobytes() for row in states]
        names = [(interval, bits) for bits in (*(a + b for a, b in pairwise(rows)), *rows[1:])]
        known = [self._least.get(name, UNKNOWN) for name in names]
        return np.array(known, np.float32).reshape(2, -1), names

    def learn(self, names: list[Name], known: Floats32) -> None:
        """Remember what is known by now (2, n)."""
        if len(self._least) > _MOST:
            self._least.clear()
        found = zip(names, known.ravel().tolist(), strict=True)
        self._least.update((name, room) for name, room in found if not math.isnan(room))
