"""Which postures of an arm run into the avatar's own body: trunk, head and legs where they are, and the other arm.

In the chest frame the chest itself stands still, and while the waist is upright so does nearly all the rest: postures
that touch it then, at any phase of the stride, are ruled out once and for all. Where waist or other arm have left
their natural way, blocks of sixteen postures are held against each part; a block whose ball keeps away is passed over.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup, columns_of
from elbowroom.body.kinematics import BodyModel, arm_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.body.whole_body import whole_body
from elbowroom.planning.exact.lattice.postures import Postures
from elbowroom.planning.exact.memory.row_contents import CONTENT
from elbowroom.planning.exact.memory.row_index import new_row_index
from elbowroom.planning.exact.sweep.own_body_nodes import SPARE, OwnBodyNodes, touches_body
from elbowroom.planning.goal import GoalFunction
from elbowroom.planning.model.self_pairs import SelfPairs, body_from_chest, self_pairs
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

_PHASES, _SPEED = 8, 1.1  # of the stride
_REMEMBERED = 128  # surroundings of an arm

ARMS = (DofGroup.LEFT_ARM, DofGroup.RIGHT_ARM)


class Parts(NamedTuple):
    """Capsules that an arm must keep away from, in the chest frame, and by how much."""

    axes: Floats32  # (..., P, 6)
    allowed: Floats32  # (C, P) metres


class OwnBody:
    """One avatar's body as its arms see it; frozen."""

    def __init__(self, model: BodyModel, goals: GoalFunction) -> None:
        self.model = model
        self.pairs: SelfPairs = self_pairs(model, goals)
        self._goals = goals

    def parts(self, side: int, waists: Floats, states: Floats, other: Floats | None) -> Parts:
        """What arm `side` must keep away from, at N waists (N, d), root states (N, 7), with the other arm (N, d)."""
        pairs = self.pairs
        axes = body_from_chest(self.model, pairs, waists, states).transpose(2, 0, 1)
        allowed = pairs.allowed[side]
        if other is not None:
            arm = arm_capsules(self.model, ARMS[1 - side], other).transpose(2, 0, 1)
            axes = np.concatenate([axes, arm], axis=1)
            allowed = np.concatenate([allowed, pairs.between if side == 0 else pairs.between.T], axis=1)
        return Parts(np.ascontiguousarray(axes), np.ascontiguousarray(allowed))

    def resting(self, side: int, postures: Postures) -> Bools:
        """Which postures (W,) touch the body at some phase of the natural walk, or the other arm there."""
        states = np.zeros((_PHASES + 1, ROOT_STATE))
        states[1:, 3], states[1:, 6] = _SPEED, np.arange(_PHASES) / _PHASES
        path = RootPath(0.0, 1.0, states)
        natural, groups = self._goals(path), (DofGroup.WAIST, ARMS[1 - side])
        waists, other = (np.ascontiguousarray(natural[:, columns_of(group)]) for group in groups)
        parts = self.parts(side, waists, states, other)
        found = [touches_body(postures.lanes, postures.balls, axes, parts.allowed, SPARE) for axes in parts.axes]
        touching: Bools = np.any(found, axis=0)
        return touching

    def own_body_nodes(self, side: int, postures: Postures, resting: Bools) -> OwnBodyNodes:
        """What arm `side` is held against with `postures`, for `own_body_costs`; nothing looked at yet.

        `resting` (W,) are those that touch the walking body.
        """
        pairs, arm = self.pairs, postures.limb
        wanted, allowed = pairs.rest, pairs.allowed[side]
        if side == 1:
            wanted = np.concatenate([wanted, pairs.arms[0]])
            allowed = np.concatenate([allowed, pairs.between.T], axis=1)
        return OwnBodyNodes(
            whole_body(self.model), arm.order, arm.arm_joints, arm.mirror, arm.joints, arm.ends, wanted,
            np.ascontiguousarray(allowed), postures.configurations, postures.columns, postures.step,
            postures.lanes, postures.balls, resting,
            new_row_index(_REMEMBERED, CONTENT + columns_of(ARMS[side]).start),
            np.empty((_REMEMBERED, len(wanted), 6), np.float32), np.empty((_REMEMBERED, len(resting)), np.bool_),
        )  # fmt: skip
