"""Which postures of a group that hangs on the waist run into the avatar's own body: trunk, head, legs, other arm.

In the chest frame the chest itself stands still, and while the waist is upright so does nearly all the rest: postures
that touch it then, at any phase of the stride, are ruled out once and for all. Where other groups have left their
natural motion, blocks of sixteen postures are held against each part; a block whose ball keeps away is passed over.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, SEARCH_ORDER, DofGroup
from elbowroom.body.pose.kinematics import BodyModel
from elbowroom.body.root import ROOT_STATE
from elbowroom.planning.exact.lattice.postures import Postures
from elbowroom.planning.exact.memory.row_contents import CONTENT
from elbowroom.planning.exact.memory.row_index import new_row_index
from elbowroom.planning.exact.sweep.own_body_nodes import SPARE, OwnBodyNodes, touches_body
from elbowroom.planning.goal import GoalFunction
from elbowroom.planning.model.self_pairs import (
    SelfPairs,
    neighbours_of,
    seen_from_chest,
    self_clearances,
    self_pairs,
    with_waist,
)
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]

_PHASES = 8  # of the stride
_SPEED, _SLOW = 1.1, 0.4  # m/s
_REMEMBERED = 96  # surroundings of a group, more than a path has key times


class PartsBeside(NamedTuple):
    """Capsules that a group must keep away from, in the chest frame, and by how much."""

    axes: Floats32  # (N, P, 6)
    allowed: Floats32  # (C, P) metres


class OwnBody:
    """One avatar's body as the groups that hang on its waist see it; frozen."""

    def __init__(self, model: BodyModel, goals: GoalFunction) -> None:
        self.model = model
        self.pairs: SelfPairs = self_pairs(model, goals)
        self._goals = goals

    def seen(self, uppers: Floats, states: Floats) -> Floats32:
        """All capsules (N, all, 6) in the chest frame, for N upper bodies (N, LOCAL) and root states (N, 7)."""
        return np.ascontiguousarray(seen_from_chest(self.model, uppers, states).transpose(2, 0, 1))

    def parts(self, group: DofGroup, others: tuple[DofGroup, ...], body: Floats32) -> PartsBeside:
        """What a group must keep away from of `others`, where these are as in a `body` that was `seen` (N, all, 6)."""
        capsules, allowed = self.pairs.beside(group, others)
        return PartsBeside(np.ascontiguousarray(body[:, capsules]), np.ascontiguousarray(allowed))

    def resting(self, group: DofGroup, postures: Postures) -> Bools:
        """Which postures (W,) touch the body at some phase of the natural walk, all other groups being natural."""
        states = _walking(_SPEED)
        natural = self._goals(RootPath(0.0, 1.0, states))
        parts = self.parts(group, neighbours_of(group), self.seen(natural, states))
        found = [touches_body(postures.lanes, postures.balls, axes, parts.allowed, SPARE) for axes in parts.axes]
        touching: Bools = np.any(found, axis=0)
        return touching

    def folded(self, waists: Floats) -> Bools:
        """Which waists (V, d) lay the trunk on the thighs at some phase of a slow walk, as who bends deep walks.

        Nothing is kept to spare: a duck is deep, and the motion between its postures is proven by itself.
        """
        states, uppers = _walking(_SLOW), with_waist(waists)
        gaps = self_clearances(
            self.model, self.pairs, np.tile(states, (len(waists), 1)), np.repeat(uppers, len(states), axis=0)
        )[SEARCH_ORDER.index(DofGroup.WAIST)]
        found: Bools = gaps.reshape(len(waists), len(states)).min(axis=1) < 0.0
        return found

    def own_body_nodes(self, group: DofGroup, postures: Postures, resting: Bools) -> OwnBodyNodes:
        """What a group is held against with `postures`, for `own_body_costs`; nothing checked yet.

        `resting` (W,) are those that touch the walking body.
        """
        wanted, allowed = self.pairs.beside(group, group.clear_of)
        return OwnBodyNodes(
            self.model.whole, wanted, np.ascontiguousarray(allowed), postures, resting,
            new_row_index(_REMEMBERED, CONTENT + LOCAL),
            np.empty((_REMEMBERED, len(wanted), 6), np.float32), np.empty((_REMEMBERED, len(resting)), np.bool_),
        )  # fmt: skip


def _walking(speed: float) -> Floats:
    """Root states (N, 7) of a stand and of a walk at several phases."""
    states = np.zeros((_PHASES + 1, ROOT_STATE))
    states[1:, 3], states[1:, 6] = speed, np.arange(_PHASES) / _PHASES
    return states
