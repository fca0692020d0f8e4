"""Arms make way for the avatar's own legs where these stand otherwise than the walking cycle has them.

The planner holds arms against the legs of the walking cycle. Feet that stand do not follow a root that turns or goes
aside, so a thigh may be a few centimetres beside where it was planned, just where a hand passes. Then the arm is spread
by as much.
"""

import math

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import ARMS, columns_of, limits
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import BodyModel, body_model
from elbowroom.clips.motion_set import MotionSet
from elbowroom.control.feet.following import BesideLegs, Gaps, arm_gaps
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.self_pairs import self_pairs
from elbowroom.planning.shared import Shared

Floats = NDArray[np.float64]

_NEAR, _LEAST_GAP = 0.010, 0.004  # metres: an arm that would be nearer makes way, and keeps some millimetres
_BACK = 0.1  # seconds: time constant with which an arm that has made way comes back
_BARELY = 0.0005  # metres that it keeps where it has no room for more
_ROUNDS, _MOST_ROUNDS = 3, 9  # in which it is found how far: these, and more where an arm is still in a leg then
_LEAST = 0.3  # of the way to the hand: what spreading an arm opens at least
_UNFELT = 1e-4  # radians
_ABDUCTION = 1  # its place in an arm's components


class ArmsBesideLegs:
    """The arms and legs of one avatar; frozen."""

    def __init__(self, model: BodyModel, motions: MotionSet) -> None:
        """`motions` are those that it walks with: arms may come as near to the legs as in them."""
        self._model = model
        pairs = self_pairs(model, natural_walk(motions))
        arms = [pairs.capsules[arm] for arm in ARMS]
        first, second = (np.isin(side, np.concatenate(arms)) for side in (pairs.first, pairs.second))
        legs = np.isin(pairs.first, model.roots.indices) | np.isin(pairs.second, model.roots.indices)
        chosen = (first | second) & legs
        right = np.isin(pairs.first, arms[1]) | np.isin(pairs.second, arms[1])
        self.pairs = BesideLegs(
            pairs.first[chosen], pairs.second[chosen], right[chosen].astype(np.int64), pairs.limits[chosen]
        )
        self._columns = [columns_of(arm).start + _ABDUCTION for arm in ARMS]
        self._most = [float(limits(arm)[_ABDUCTION, 1]) for arm in ARMS]
        self._reach = 1.4 * model.gait.half_leg  # metres from the shoulder to the hand, about

    def apart(self, root: Floats, upper: Floats, known: Gaps | None = None) -> Floats:
        """The upper body (LOCAL,) with arms that keep clear of the legs under `root` (WITH_FEET or SHOWN,).

        What is wanted is a smooth function of the gap, so arms make way as smoothly as legs come near. The gaps as
        `arm_gaps` has them may be `known`.
        """
        both = self._gaps(root, upper) if known is None else known
        if min(both) >= _NEAR:
            return upper
        gaps = np.array(both)
        return self._spread(root, upper, gaps, _widened(gaps))

    def coming_back(self, upper: Floats, planned: Floats, made: Floats, dt: float) -> Floats:
        """An upper body (LOCAL,) with arms that do not at once come back from where they have made way.

        They were spread by what was `made` of what was planned (LOCAL,) `dt` seconds ago, radians, and are now at least
        by so much less of it as they can come back in that time.
        """
        back, left = upper, math.exp(-dt / _BACK)
        for column, most in zip(self._columns, self._most, strict=True):
            spread = left * float(made[column])
            least = min(float(planned[column]) + spread, most)
            if spread >= _UNFELT and upper[column] < least:
                back = upper.copy() if back is upper else back
                back[column] = least
        return back

    def barely_apart(self, root: Floats, upper: Floats, known: Gaps | None = None) -> Floats:
        """The same, no farther than needed: for where something else is in the arms' way."""
        both = self._gaps(root, upper) if known is None else known
        if min(both) >= 0.0:
            return upper
        gaps = np.array(both)
        return self._spread(root, upper, gaps, np.maximum(gaps, _BARELY))

    def _spread(self, root: Floats, upper: Floats, gaps: Floats, wanted: Floats) -> Floats:
        """The upper body with arms spread until the gaps of both to the legs, (2,) metres, are as wide as `wanted`."""
        angles, slopes = np.zeros(len(ARMS)), np.full(len(ARMS), self._reach)
        spread, found = upper, gaps
        for done in range(_MOST_ROUNDS):
            if done >= _ROUNDS and found.min() >= _BARELY:
                break
            angles = np.clip(angles + (wanted - found) / slopes, 0.0, np.inf)
            spread = upper.copy()
            spread[self._columns] = np.maximum(
                upper[self._columns], np.minimum(upper[self._columns] + angles, self._most)
            )
            found = np.array(self._gaps(root, spread))
            opened = np.divide(found - gaps, angles, out=np.full(len(ARMS), self._reach), where=angles > 0.0)
            slopes = np.clip(opened, _LEAST * self._reach, self._reach)
        return spread

    def are_clear(self, root: Floats, upper: Floats) -> bool:
        """Whether no arm of an upper body (LOCAL,) is deeper in the legs under `root` than it may be."""
        return self.room(root, upper) >= 0.0

    def room(self, root: Floats, upper: Floats) -> float:
        """How much nearer arms could come to the legs under `root`, metres; negative where one is too deep in them."""
        return min(self._gaps(root, upper))

    def _gaps(self, root: Floats, upper: Floats) -> Gaps:
        return arm_gaps(self._model.whole, np.ascontiguousarray(root), np.ascontiguousarray(upper), self.pairs)


_ARMS: Shared[ArmsBesideLegs] = Shared()


def arms_beside_legs(humanoid: Humanoid, motions: MotionSet) -> ArmsBesideLegs:
    """The arms and legs of an avatar that walks with some motions: the same for all who ask."""
    return _ARMS.get((humanoid, motions), lambda: ArmsBesideLegs(body_model(humanoid), motions))


def _widened(gaps: Floats) -> Floats:
    """The gaps that are wanted: those that are wide enough as they are, of the others more than the least, smoothly."""
    more = _NEAR - _LEAST_GAP
    narrow = _LEAST_GAP + more * np.exp((np.minimum(gaps, _NEAR) - _NEAR) / more)
    return np.where(gaps >= _NEAR, gaps, narrow)
