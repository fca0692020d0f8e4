"""How far a body is from what stands about it: of what its feet stand on, only from what rises above their soles.

A sole may be in what it stands on, and feet are held against obstacles so much higher (`planning/model/footing.py`). So
nothing that lies under a level sole is in the way of its foot, and of all else only as far as that hangs down to the
lower sole. A shin ends at an ankle, which is never nearer to the ground than in a stride on the plane. On level ground
that is all of the floor: who walks there is proven free as quickly as on the plane.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.pose.kinematics import BodyModel, leg_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.control.shown.standing_about import EVEN, OTHERS, ShownBody, ShownLegs
from elbowroom.planning.model.even_points import evenly_spread
from elbowroom.planning.model.footing import NOWHERE, Footing
from elbowroom.world.ground.ground import Ground

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

_STRIDES, _APART = 512, 0.01  # strides that are measured; metres above the ground from which shins need no look
_LEAST, _MOST = np.array([-1.5, -1.0, -2.5, 0.0]), np.array([3.0, 1.0, 2.5, 1.0])  # m/s, m/s, rad/s, phase


class AboveSoles:
    """Clearance of one body among what stands on some ground; frozen."""

    def __init__(self, model: BodyModel, ground: Ground) -> None:
        self.footing = Footing(model, ground)
        feet = self.footing.each_foot(model.body).any(axis=0)
        lifted = np.flatnonzero(feet & (not self.footing.plain))
        self.body = ShownBody(model.whole, model.body.radii, self._sides(model), lifted)  # for kernels
        legs = model.roots.indices
        own = np.flatnonzero(np.isin(legs, lifted))
        self.legs = ShownLegs(model.lower, model.roots.radii, self.body.sides[legs], own)
        shins = np.isin(model.body.joints, model.tree.legs[:, 1:])
        # The capsules that count for how hips live.
        self.carried: list[int] = np.flatnonzero(~(shins & (not self.footing.plain))).tolist()

    def floors(self, root: Floats) -> Floats:
        """What both soles keep above (2,) in a root state (ROOT_STATE,) that stands."""
        return NOWHERE if self.footing.plain else self.footing.floors(root[None])

    def change(self, one: Floats, other: Floats) -> bool:
        """Whether soles keep above other heights (2,) in one root state than in another."""
        if self.footing.plain:
            return False
        both = zip(one.tolist(), other.tolist(), strict=True)
        return any(first > second + EVEN or second > first + EVEN for first, second in both)

    def _sides(self, model: BodyModel) -> Longs:
        """Which capsules keep above which sole, as in `ShownBody`."""
        first = 1 if not self.footing.plain and _shins_stay_over(model) else 2
        sides = np.full(len(model.body.radii), OTHERS)
        for side, leg in enumerate(model.tree.legs):
            sides[np.isin(model.body.joints, leg[first:])] = side
        return sides


def _shins_stay_over(model: BodyModel) -> bool:
    """Whether shins keep above the ground in strides of all kinds on the plane."""
    roots, drawn = np.zeros((_STRIDES, ROOT_STATE)), evenly_spread(_STRIDES, 4)
    roots[:, 3:7] = _LEAST + drawn * (_MOST - _LEAST)
    shins = np.isin(model.roots.joints, model.tree.legs[:, 1])
    lowest = leg_capsules(model, roots)[shins][:, [1, 4]].min(axis=1) - model.roots.radii[shins, None]
    return bool(lowest.min() > _APART)
