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
from elbowroom.planning.model.even_points import evenly_spread
from elbowroom.planning.model.footing import NOWHERE, Footing
from elbowroom.planning.model.levers import raised_between
from elbowroom.world.ground.ground import Ground
from elbowroom.world.obstacles.obstacles import Obstacles

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]

_STRIDES, _APART = 512, 0.01  # strides that are measured; metres above the ground from which shins need no look
_LEAST, _MOST = np.array([-1.5, -1.0, -2.5, 0.0]), np.array([3.0, 1.0, 2.5, 1.0])  # m/s, m/s, rad/s, phase
_RAISED = 0.04  # metres that legs move at most while feet are raised: less goes straight, nearly
_EVEN = 5e-4  # metres by which what feet stand on may differ and be one height


class AboveSoles:
    """Clearance of one body among what stands on some ground; frozen."""

    def __init__(self, model: BodyModel, ground: Ground) -> None:
        self.footing, self._model = Footing(model, ground), model
        self._radii, shins = model.body.radii, not ground.plain and _shins_stay_over(model)
        left, right = (np.isin(model.body.joints, own[1:] if shins else own[2:]) for own in model.figure.legs)
        self._parts: tuple[Bools, Bools, Bools] = left, right, ~(left | right)
        self._nowhere = np.full(len(self._radii), -np.inf)

    def floors(self, *roots: Floats) -> Floats:
        """What both soles keep above (2,) in root states (ROOT_STATE,) that stand, shown one after the other."""
        return NOWHERE if self.footing.plain else self.footing.floors(np.stack(roots))

    def change(self, one: Floats, other: Floats) -> bool:
        """Whether soles are at other heights in one root state than in another."""
        if self.footing.plain:
            return False
        both = zip(self.floors(one).tolist(), self.floors(other).tolist(), strict=True)
        return any(first > second + _EVEN or second > first + _EVEN for first, second in both)

    def raised(self, one: Floats, other: Floats) -> bool:
        """Whether feet are raised or tilted so much from one root state to another that screens show them elsewhere."""
        return not self.footing.plain and raised_between(one, other) > _RAISED

    def soles_above(self, axes: Floats32, floors: Floats) -> float:
        """How far the capsules of the feet (C, 6, N) keep above what is not looked at under both soles (2,), metres."""
        feet = self.footing.each_foot(self._model.body)
        lowest = np.minimum(axes[:, 1], axes[:, 4]).min(axis=1) - self._radii
        return float(min(lowest[own].min(initial=np.inf) - floor for own, floor in zip(feet, floors, strict=True)))

    def clearances(self, obstacles: Obstacles, axes: Floats32, origin: Floats, floors: Floats) -> Floats32:
        """The clearance (N, C) of each capsule of postures (C, 6, N) about a place from what stands, metres.

        As `Obstacles.clearances` of all of them together, with what both soles keep above (2,) in all postures; what is
        no foot is held above that too.
        """
        count, low = axes.shape[2], float(floors.min())
        lanes, radii, heights = axes, self._radii, self._nowhere
        if not self.footing.plain:
            heights = np.full(len(axes), low)
            if floors.max() > low + _EVEN:
                heights[self._parts[0]], heights[self._parts[1]] = floors
        if count > 1:
            lanes = np.ascontiguousarray(axes.transpose(2, 0, 1)).reshape(-1, 6, 1)
            radii, heights = np.tile(radii, count), np.tile(heights, count)
        found = obstacles.clearances(lanes, radii, origin, 0.0, heights).reshape(count, -1)
        if low > -np.inf:
            others = self._parts[2]
            lowest = np.minimum(axes[others, 1], axes[others, 4]) - self._radii[others, None]
            found[:, others] = np.minimum(found[:, others], lowest.T - np.float32(low))
        return found


def _shins_stay_over(model: BodyModel) -> bool:
    """Whether shins keep above the ground in strides of all kinds on the plane."""
    roots, drawn = np.zeros((_STRIDES, ROOT_STATE)), evenly_spread(_STRIDES, 4)
    roots[:, 3:7] = _LEAST + drawn * (_MOST - _LEAST)
    shins = np.isin(model.roots.joints, model.figure.legs[:, 1])
    lowest = leg_capsules(model, roots)[shins][:, [1, 4]].min(axis=1) - model.roots.radii[shins, None]
    return bool(lowest.min() > _APART)
