"""Where motions ran into the avatar's own body of late, so that the next plan does not try the same again."""

from bisect import bisect_left
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.paper.activity_graph import squared_distance

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_ALERT = 16  # plans after one that ran into the body that look at it from the beginning
_SAME = 1e-6  # radians
_MOST = 64


class Contact(NamedTuple):
    """An arm ran into the body."""

    side: int  # of the arm
    time: float  # seconds, the key time
    around: Floats  # the waist, for the right arm the left one too
    posture: Floats  # (d,) of the arm

    def happens(self, around: Floats) -> bool:
        """Whether the groups before the arm are as they were then."""
        return bool(np.abs(self.around - around).max() < _SAME)


@exact_kernel
def rule_out_near(costs: Floats32, known: Floats, own: Floats, posture: Floats, near: float) -> None:
    """Make infinite what nodes cost that are `near` to a posture (d,), radians: `prices` (W + E,) of a key time.

    The first nodes are the postures `known` (V, d), the last ones those of the key time alone, `own` (E, d).
    """
    width = costs.shape[0] - own.shape[0]
    for node in range(known.shape[0]):
        if np.sqrt(squared_distance(known[node], posture)) < near:
            costs[node] = np.inf
    for node in range(own.shape[0]):
        if np.sqrt(squared_distance(own[node], posture)) < near:
            costs[width + node] = np.inf


class OwnContacts:
    """Postures of the arms at key times at which they ran into the body."""

    def __init__(self) -> None:
        self._known: list[Contact] = []
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
        self._known.append(Contact(side, time, around, posture))

    def of(self, side: int, times: Floats) -> list[tuple[int, Contact]]:
        """What is known of an arm at some of the ascending key times (n,), each with the number of its key time."""
        known = [one for one in self._known if one.side == side]
        if not known:
            return []
        grid = times.tolist()
        found = [(bisect_left(grid, one.time - _SAME), one) for one in known]
        return [(t, one) for t, one in found if t < len(grid) and grid[t] - one.time < _SAME]
