"""What is known of the legs among things that stand: how near they come in a key interval, and in a stop.

Who follows a path walks its key intervals again in the next plan, and what stands has not moved. So each is checked
once, and known under the very bits of the states that it depends on: what is recalled is what would be found.
"""

import numpy as np
from numpy.typing import NDArray

Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]

Name = tuple[float, bytes]  # seconds of a key interval, and the bits of the states at its ends or of a stop's beginning

_MOST = 4096  # are remembered


class KnownLegs:
    """The least clearances of legs and pelvis in key intervals and stops, of one body among boxes that stand."""

    def __init__(self) -> None:
        self._least: dict[Name, float] = {}

    def recalled(self, names: list[Name], wanted: Bools, skin: float) -> tuple[Floats32, Bools]:
        """What is known (n,) of those `wanted` (n,), infinity elsewhere; and which have still to be checked (n,).

        None is after the first that is known to come nearer than `skin`.
        """
        found, fresh = np.full(len(names), np.inf, np.float32), np.zeros(len(names), np.bool_)
        for k in np.flatnonzero(wanted).tolist():
            known = self._least.get(names[k])
            if known is None:
                fresh[k] = True
                continue
            found[k] = known
            if found[k] < skin:
                break
        return found, fresh

    def learn(self, names: list[Name], fresh: Bools, found: Floats32) -> None:
        """Remember what was found (n,) for those that were checked."""
        if len(self._least) > _MOST:
            self._least.clear()
        for k in np.flatnonzero(fresh).tolist():
            self._least[names[k]] = float(found[k])
