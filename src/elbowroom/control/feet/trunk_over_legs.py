"""Whether the trunk keeps off the avatar's own legs as its feet step on.

The planner holds who bends and crouches against the legs of the walking cycle. People's feet are raised higher, and
stay behind a root that goes aside: so a thigh may come nearer to the belly than where it was planned.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL, SEARCH_ORDER, DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import BodyModel, body_model, posture_capsules
from elbowroom.clips.motion_set import MotionSet
from elbowroom.control.feet.following import KINDS, TRUNK, BesideLegs
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.axis_distances import pair_clearances
from elbowroom.planning.model.self_pairs import self_pairs
from elbowroom.planning.shared import Shared

Floats = NDArray[np.float64]


class TrunkOverLegs:
    """The trunk and legs of one avatar; frozen."""

    def __init__(self, model: BodyModel, motions: MotionSet) -> None:
        """`motions` are those that it walks with: the trunk may come as near to the legs as in them."""
        self._model = model
        pairs = self_pairs(model, natural_walk(motions))
        chosen = np.flatnonzero(pairs.kinds == SEARCH_ORDER.index(DofGroup.WAIST))
        kinds = np.full(len(chosen), TRUNK, np.int64)
        self.pairs = BesideLegs(pairs.first[chosen], pairs.second[chosen], kinds, pairs.limits[chosen])

    def room(self, roots: Floats, upper: Floats) -> float:
        """How much nearer the trunk of an upper body (LOCAL,) may come to legs on feet (N, WITH_FEET), metres."""
        here, q = roots.copy(), np.zeros((len(roots), DOF))
        here[:, :3], q[:, DOF - LOCAL :] = 0.0, upper
        axes, pairs = posture_capsules(self._model, q, here), self.pairs
        return float(pair_clearances(axes, pairs.first, pairs.second, pairs.kinds, pairs.allowed, KINDS).min())


_TRUNKS: Shared[TrunkOverLegs] = Shared()


def trunk_over_legs(humanoid: Humanoid, motions: MotionSet) -> TrunkOverLegs:
    """The trunk and legs of an avatar that walks with some motions: the same for all who ask."""
    return _TRUNKS.get((humanoid, motions), lambda: TrunkOverLegs(body_model(humanoid), motions))
