"""Crouching only where the legs have room: what a way of the waist does to them is checked, and ruled out where wrong.

Most ways do not crouch at all, and cost nothing here. Of one that does, the shown motion of the legs is checked, and
that the trunk keeps off the thighs; on uneven ground, which raises thighs, of one that only bends too. Where legs touch
what stands about, every posture is looked at around every key time, once for the path; where that does not help,
because they touch between key times, postures that crouch as deep are ruled out there. Where the trunk comes to the
thighs it is those that bend and crouch as deep: who bends less may crouch, who crouches less may bend. At last nobody
crouches, or bends.
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

_BEND, _COLUMN = 0, LOWERING - DofGroup.WAIST.at.start
_MARGIN = (
    0.02  # metres of clearance of crouching legs; less where the start has less, so that who stands close by can go
)
_UPRIGHT = 1e-3  # half leg lengths
_STRAIGHT = 0.35  # radians: who bends no more does not come to his thighs
ROUNDS = 9  # ways of the waist that may let the legs touch before it gives up
_PATIENCE = 5  # of these rounds, in which a little less deep is tried
_SHALLOWER = 0.1  # half leg lengths by which to come up where legs touch between key times
_LESS = 0.1  # radians by which to bend less, or half leg lengths to come up, where the trunk comes to the thighs


class Crouch:
    """The ways of one waist's search along one root path, and which of its nodes the legs cannot follow."""

    def __init__(
        self,
        legs: LoweredLegs,
        path: RootPath,
        nodes: Callable[[], Floats],
        folds: Callable[[Floats, Floats], Bools],
        shown: Callable[[], Floats],
    ) -> None:
        """`nodes` gives the waists of all nodes of the search, (n+1, V, 3).

        `folds` tells in which key intervals (n,) a way lays the trunk on the thighs; `shown` gives what `legs.shown`
        has of the path, which is asked for again and again.
        """
        self._legs, self._path, self._nodes, self._folds, self._shown = legs, path, nodes, folds, shown
        self._known: Floats | None = None
        self._round = 0
        self._margin: float | None = None

    def rules_out(self, keys: Floats, velocities: Floats, extra: Floats32) -> bool:
        """Whether the legs touch on a waist's way (n+1, 3); then the prices `extra` (n+1, V) forbid what did it."""
        if not self._concerns_legs(keys):
            return False
        deep, rates = keys[:, _COLUMN], velocities[:, _COLUMN]
        if self._margin is None:
            now = self._legs.clearances(self._path.states[:1], deep[:1], farthest=2.0 * _MARGIN)
            self._margin = min(_MARGIN, max(0.5 * float(now[0]), 0.0))
        blocked = self._legs.blocked_intervals(self._path, deep, rates, self._margin, self._shown())
        folded = self._folds(keys, velocities)
        if not (blocked | folded).any():
            return False
        self._round += 1
        if self._known is None:
            self._known = self._nodes()
        before = np.isinf(extra)
        if self._round == 1 and blocked.any():
            lowerings = np.ascontiguousarray(self._known[..., _COLUMN])
            extra[self._legs.blocked_nodes(self._path, lowerings, self._margin)] = np.inf
        elif self._round == ROUNDS - 1:
            extra[1:][_is_low(self._known[1:])] = np.inf
        else:
            self._come_up(np.flatnonzero(blocked), deep, self._known, extra)
            self._unfold(np.flatnonzero(folded), keys, self._known, extra)
        return bool((np.isinf(extra) != before).any()) or bool(blocked.any())

    def _concerns_legs(self, keys: Floats) -> bool:
        """Whether a way crouches, or bends where the ground raises thighs."""
        if max(keys[:, _COLUMN].tolist()) > _UPRIGHT:
            return True
        return not self._legs.footing.plain and max(keys[:, _BEND].tolist()) > _STRAIGHT

    def _come_up(self, blocked: NDArray[np.intp], deep: Floats, nodes: Floats, extra: Floats32) -> None:
        """Forbid what crouches as deep, or nearly, at both ends of blocked intervals; after a while, all that does."""
        for k in blocked:
            most = max(deep[k], deep[k + 1]) - _SHALLOWER if self._round < _PATIENCE else _UPRIGHT
            for at in (k, k + 1):
                extra[at, nodes[at, :, _COLUMN] > max(most, _UPRIGHT)] = np.inf

    def _unfold(self, folded: NDArray[np.intp], keys: Floats, nodes: Floats, extra: Floats32) -> None:
        """Forbid what bends and crouches as a way does at both ends of folded intervals; after a while, all that does.

        Where it stands upright it is not that, and nothing is forbidden.
        """
        for at in sorted({end for k in folded.tolist() for end in (k, k + 1)}):
            if _is_low(keys[at]):
                bend, lowering = keys[at, [_BEND, _COLUMN]] - _LESS
                alike = (nodes[at, :, _BEND] >= bend) & (nodes[at, :, _COLUMN] >= lowering)
                extra[at, _is_low(nodes[at]) & (alike | (self._round >= _PATIENCE))] = np.inf


def _is_low(waists: Floats) -> Bools:
    """Which of some waists (..., 3) crouch, or bend far."""
    low: Bools = (waists[..., _COLUMN] > _UPRIGHT) | (waists[..., _BEND] > _STRAIGHT)
    return low


def too_deep(legs: LoweredLegs, root: Floats, waists: Floats) -> Bools:
    """Which of some waists (N, 3) crouch deeper in a root state (7,) than legs can, among what stands there."""
    clear = legs.clearances(np.tile(root, (len(waists), 1)), waists[:, _COLUMN], farthest=2.0 * _MARGIN)
    deep: Bools = clear < _MARGIN
    return deep


def node_waists(postures: Floats, goals: Floats, previous: Floats, start: Floats) -> Floats:
    """The waists (n+1, V + 4, 3) of postures (V, 3) and of each key time's own: its goal, the last plan's, the start's.

    The last one is on the way from the start to the goal, and bent and lowered no more than the one that is more so.
    """
    hold = np.tile(start, (len(goals), 1))
    own = np.stack([goals, previous, hold, np.maximum(hold, goals)], axis=1)
    return np.concatenate([np.tile(postures, (len(goals), 1, 1)), own], axis=1)
