"""How a body follows a pose that is played, all of it in one kernel: feet, hips, chest and head, and where that is.

A kernel that is entered takes its arguments apart first, which takes as long as what it computes for one body; so what
is always done together is done at once.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOCAL, DofGroup, columns_of
from elbowroom.body.gait.gliding import glide_feet
from elbowroom.body.gait.landing_places import Stepper
from elbowroom.body.gait.living import Body, live
from elbowroom.body.pose.whole_body import WholeBody, posed_capsules
from elbowroom.body.root import ROOT_STATE, SHOWN, WITH_FEET
from elbowroom.by_reference import by_reference
from elbowroom.control.feet.treading import step_on, tread_gliding
from elbowroom.control.shown.standing_about import ShownBody, hold_feet
from elbowroom.jit import brief_exact_kernel, inner_exact_kernel, plain
from elbowroom.planning.model.axis_distances import pair_clearances
from elbowroom.planning.model.footing import Underfoot

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]
Gaps = tuple[float, float]  # metres, of the left and the right arm

_TWIST, _HEAD_TURN = (columns_of(group).start + 1 for group in (DofGroup.WAIST, DofGroup.HEAD))
TRUNK, KINDS = plain(2), plain(3)
# How feet follow: they step to where the root is to come; they glide as the walking cycle swings them, and stay where
# they stand; they glide as the cycle has them, standing or not.
STEPS, HOLDS, GLIDES = range(3)


class BesideLegs(NamedTuple):
    """P pairs of capsules, one of an arm or the trunk and one of a leg."""

    first: Indices  # (P,)
    second: Indices  # (P,)
    kinds: Indices  # (P,) 0 left arm, 1 right arm, `TRUNK`
    allowed: Floats32  # (P,) metres: as near the axes may come

    def and_those(self, other: "BesideLegs") -> "BesideLegs":
        """The pairs of both."""
        return BesideLegs(
            np.concatenate([self.first, other.first]),
            np.concatenate([self.second, other.second]),
            np.concatenate([self.kinds, other.kinds]),
            np.concatenate([self.allowed, other.allowed]),
        )


@by_reference
class Follower(NamedTuple):
    """What is to be known of one body."""

    shown: ShownBody
    feet: Stepper
    body: Body
    pairs: BesideLegs  # of both arms and the trunk
    under: Underfoot  # what it stands on


class Followed(NamedTuple):
    """A body that has followed."""

    root: Floats  # (SHOWN,) with feet and carriage
    axes: Floats32  # (C, 6, 1) of its capsules, as seen from the root's place, feet as high as they are held
    gaps: Gaps  # how much nearer the left and the right arm may come to the legs
    trunk: float  # how much nearer the trunk may come to them, metres


@inner_exact_kernel
def _gaps_to_legs(axes: Floats32, pairs: BesideLegs) -> tuple[Gaps, float]:
    """How much nearer both arms of a body (C, 6, 1) may come to its legs, and the trunk; infinite without pairs."""
    found = pair_clearances(axes, pairs.first, pairs.second, pairs.kinds, pairs.allowed, KINDS)
    return (float(found[0, 0]), float(found[1, 0])), float(found[TRUNK, 0])


@brief_exact_kernel
def arm_gaps(body: WholeBody, root: Floats, upper: Floats, pairs: BesideLegs) -> Gaps:
    """How much nearer both arms of a body (LOCAL,) may come to its legs, at a root with feet (WITH_FEET or SHOWN,)."""
    q, here = np.zeros((1, DOF)), root.copy().reshape((1, len(root)))
    q[0, DOF - LOCAL :] = upper
    here[0, :3] = 0.0
    return _gaps_to_legs(posed_capsules(body, q, here), pairs)[0]


@brief_exact_kernel
def followed(
    who: Follower, before: Floats, root: Floats, upper: Floats, coming: Floats, dt: float, room: float, how: int
) -> tuple[Floats, Floats32, Gaps, float]:
    """How a root state (7 or more,) with an upper body (LOCAL,) is shown `dt` seconds after `before` (SHOWN,).

    As `Followed`. Feet step to where the root is to come, or glide into the walking cycle, `how` says which; that is
    raised as `root` tells. `coming` (m, 8) is as in `step_feet`, `room` as in `live`.
    """
    row, planned, feet = np.empty(SHOWN), root[:ROOT_STATE].copy(), who.feet
    if how != STEPS:
        glide_feet(feet.legs, feet.scale, before, planned, dt, how == HOLDS, row[:WITH_FEET])
        if not who.under.ground.plain:
            tread_gliding(who.under, feet, before, row, dt, how == HOLDS)
    else:
        step_on(who.under, who.feet, before, planned, dt, coming, row)
    live(who.body, before, dt, room, coming, upper[_TWIST] + upper[_HEAD_TURN], row)
    q, near = np.zeros((1, DOF)), row.copy().reshape((1, SHOWN))
    q[0, DOF - LOCAL :] = upper
    near[0, :2] = 0.0
    axes = posed_capsules(who.shown.whole, q, near)
    gaps, trunk = _gaps_to_legs(axes, who.pairs)
    hold_feet(who.shown, q, near, axes)
    return row, axes, gaps, trunk
