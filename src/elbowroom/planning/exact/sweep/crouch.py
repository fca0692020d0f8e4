"""Crouching only where the legs have room: what a way of the waist does to them is checked, and ruled out where wrong.

Most ways do not crouch at all, and cost nothing here. Of one that does, the shown motion of the legs is checked, and
that the trunk keeps off the thighs. Where legs touch what stands about, every posture is looked at around every key
time, once for the path; where that does not help, because they touch between key times, or under the trunk, postures
that crouch as deep are ruled out there, and at last all crouching.
"""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOWERING, DofGroup
from elbowroom.planning.model.lowered_legs import LoweredLegs
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]

_COLUMN = LOWERING - DofGroup.WAIST.at.start
_MARGIN = (
    0.02  # metres of clearance of crouching legs; less where the start has less, so that who stands close by can go
)
_UPRIGHT = 1e-3  # half leg lengths
ROUNDS = 9  # ways of the waist that may let the legs touch before it gives up
_PATIENCE = 5  # of these rounds, in which a little less deep is tried
_SHALLOWER = 0.1  # half leg lengths by which to come up where legs touch between key times


class Crouch:
    """The lowerings of one waist's search along one root path, and which of them the legs cannot follow."""

    def __init__(
        self,
        legs: LoweredLegs,
        path: RootPath,
        lowerings: Callable[[], Floats],
        folds: Callable[[Floats, Floats], Bools],
        shown: Callable[[], Floats],
    ) -> None:
        """`lowerings` gives those of all nodes of the search, (n+1, V).

        `folds` tells in which key intervals (n,) a way lays the trunk on the thighs; `shown` gives what `legs.shown`
        has of the path, which is asked for again and again.
        """
        self._legs, self._path, self._lowerings, self._folds, self._shown = legs, path, lowerings, folds, shown
        self._known: Floats | None = None
        self._round = 0
        self._margin: float | None = None

    def rules_out(self, keys: Floats, velocities: Floats, extra: Floats32) -> bool:
        """Whether the legs touch on a waist's way (n+1, 3); then the prices `extra` (n+1, V) forbid what did it."""
        deep, rates = keys[:, _COLUMN], velocities[:, _COLUMN]
        if max(deep.tolist()) <= _UPRIGHT:
            return False
        if self._margin is None:
            now = self._legs.clearances(self._path.states[:1], deep[:1], farthest=2.0 * _MARGIN)
            self._margin = min(_MARGIN, max(0.5 * float(now[0]), 0.0))
        blocked = self._legs.blocked_intervals(self._path, deep, rates, self._margin, self._shown())
        folded = self._folds(keys, velocities)
        if not (blocked | folded).any():
            return False
        self._round += 1
        if self._known is None:
            self._known = self._lowerings()
        if self._round == 1 and blocked.any():
            extra[self._legs.blocked_nodes(self._path, self._known, self._margin)] = np.inf
        elif self._round == ROUNDS - 1:
            extra[1:][self._known[1:] > _UPRIGHT] = np.inf
        else:
            self._come_up(np.flatnonzero(blocked | folded), deep, self._known, extra)
        return True

    def _come_up(self, blocked: NDArray[np.intp], deep: Floats, lowerings: Floats, extra: Floats32) -> None:
        """Forbid what crouches as deep, or nearly, at both ends of blocked intervals; after a while, all that does."""
        for k in blocked:
            most = max(deep[k], deep[k + 1]) - _SHALLOWER if self._round < _PATIENCE else _UPRIGHT
            for at in (k, k + 1):
                extra[at, lowerings[at] > max(most, _UPRIGHT)] = np.inf


def too_deep(legs: LoweredLegs, root: Floats, waists: Floats) -> Bools:
    """Which of some waists (N, 3) crouch deeper in a root state (7,) than legs can, among what stands there."""
    clear = legs.clearances(np.tile(root, (len(waists), 1)), waists[:, _COLUMN], farthest=2.0 * _MARGIN)
    deep: Bools = clear < _MARGIN
    return deep


def node_lowerings(postures: Floats, goals: Floats, previous: Floats, start: Floats) -> Floats:
    """The lowerings (n+1, V + 4) of postures (V, 3) and of each key time's own: its goal, the last plan's, the start's.

    The last one is on the way from the start to the goal, and lowered no more than the deeper of the two.
    """
    goal, last = goals[:, _COLUMN], previous[:, _COLUMN]
    hold = np.full(len(goals), start[_COLUMN])
    own = np.stack([goal, last, hold, np.maximum(hold, goal)], axis=1)
    return np.concatenate([np.tile(postures[:, _COLUMN], (len(goals), 1)), own], axis=1)
