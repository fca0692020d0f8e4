"""Where motions ran into the avatar's own body of late, so that the next plan does not try the same again."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_ALERT = 16  # plans after one that ran into the body that look at it from the beginning
_SAME = 1e-6  # radians
_MOST = 64


class _Contact(NamedTuple):
    side: int  # of the arm
    time: float  # seconds, the key time
    around: Floats  # the waist, for the right arm the left one too
    posture: Floats  # (d,) of the arm


class SelfContacts:
    """Postures of the arms at key times at which they ran into the body."""

    def __init__(self) -> None:
        self._known: list[_Contact] = []
        self._alert = 0

    @property
    def alert(self) -> bool:
        """Whether the body is better looked at from the beginning."""
        return self._alert > 0

    def forget(self) -> None:
        """Forget everything."""
        self._known.clear()
        self._alert = 0

    def begin(self, time: float) -> None:
        """Begin a plan from `time` on: what lies before it is of no use."""
        self._alert = max(self._alert - 1, 0)
        self._known = [contact for contact in self._known[-_MOST:] if contact.time >= time - _SAME]

    def add(self, side: int, time: float, around: Floats, posture: Floats) -> None:
        """An arm ran into the body at a key time, near `posture` (d,) while the groups before it were `around`."""
        self._alert = _ALERT
        self._known.append(_Contact(side, time, around, posture))

    def at(self, side: int, time: float, around: Floats) -> list[Floats]:
        """The postures (d,) near which an arm ran into the body at a key time, the groups before it being as now."""
        return [
            known.posture
            for known in self._known
            if known.side == side and abs(known.time - time) < _SAME and np.abs(known.around - around).max() < _SAME
        ]
