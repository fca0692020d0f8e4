"""A local group as compiled code sees it: from its configuration to its capsules in the frame that carries it.

The waist's capsules live in the pelvis frame, an arm's in the chest frame: there they depend on the group's own
configuration alone, so that each vertex of an activity graph is posed once.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body import posing
from elbowroom.body.dof import DofGroup
from elbowroom.body.kinematics import BodyModel, arm_capsules, chest_frames, trunk_capsules
from elbowroom.geometry import quaternion
from elbowroom.jit import exact_kernel, plain
from elbowroom.planning.model.self_contact import allowed_distances

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

_FIRST = plain(0)  # place in a row of capsules


class Limb(NamedTuple):
    """What posing one local group needs of a `BodyModel`."""

    is_waist: bool
    base: Floats
    parents: Indices
    offsets: Floats
    order: Indices
    spine: Indices
    spine_weights: Floats
    gaze: Indices
    gaze_weights: Floats
    arm_joints: Indices  # (3,) of the arm; of the left arm, unused, for the waist
    mirror: float  # +1 left arm, -1 right arm
    joints: Indices  # (C,) joints that carry the group's capsules
    ends: Floats  # (C, 6) capsule end points in their joints' frames
    half_leg: float  # metres, the unit of the waist's lowering
    radii: Floats32  # (C,) metres
    trunk: (
        Floats  # (K, 6) for an arm, the trunk's capsules in the chest frame with the waist at rest; none for the waist
    )
    allowed: Floats  # (C, K) metres: how near the limb's axes may come to those of the trunk


def limb_of(model: BodyModel, group: DofGroup) -> Limb:
    """The limb that a local group moves."""
    capsules = model.capsules_of(group)
    side = 1 if group is DofGroup.RIGHT_ARM else 0
    trunk, allowed = _trunk_limits(model, group)
    return Limb(
        group is DofGroup.WAIST,
        model.base,
        model.parents,
        model.offsets,
        capsules.order,
        model.spine,
        model.spine_weights,
        model.gaze,
        model.gaze_weights,
        np.ascontiguousarray(model.arms[side]),
        1.0 - 2.0 * side,
        capsules.joints,
        capsules.ends,
        model.gait.half_leg,
        capsules.radii,
        trunk,
        allowed,
    )


def _trunk_limits(model: BodyModel, group: DofGroup) -> tuple[Floats, Floats]:
    """The trunk in the chest frame and the distances from it that an arm has to keep."""
    radii = model.capsules_of(group).radii
    if group is DofGroup.WAIST:
        return np.empty((0, 6)), np.empty((len(radii), 0))
    rest = np.zeros((1, DofGroup.WAIST.size))
    positions, rotations = chest_frames(model, rest)
    ends = trunk_capsules(model, rest)[:, :, 0].astype(np.float64).reshape(-1, 2, 3)
    trunk = quaternion.rotate(quaternion.conjugate(rotations[0]), ends - positions[0]).reshape(-1, 6)
    hanging = arm_capsules(model, group, np.zeros((1, group.size)))
    return trunk, allowed_distances(hanging, radii, trunk, model.capsules_of(DofGroup.WAIST).radii)


class LimbScratch(NamedTuple):
    """What the posing of a limb works on; it belongs to that limb."""

    joints: posing.PoseScratch
    places: Floats  # (N, 3) of the frames that the waist's limb carries
    turns: Floats  # (N, 4)
    none: Floats32  # (0, 6, 0) no capsules


@exact_kernel
def limb_scratch(limb: Limb, count: int) -> LimbScratch:
    """Room to pose a limb in `count` configurations at once."""
    return LimbScratch(
        posing.pose_scratch(limb.base, limb.offsets),
        np.empty((count, 3)),
        np.empty((count, 4)),
        np.empty((0, 6, 0), np.float32),
    )


@exact_kernel
def pose_into(limb: Limb, scratch: LimbScratch, configurations: Floats, count: int, first: int, out: Floats32) -> None:
    """`pose` for the first `count` configurations (N, d), written to `out` (C, 6 or more, M) from `first` on.

    The frames that the waist's limb carries are written to the room.
    """
    if limb.is_waist:
        posing.pose_trunk_into(
            limb.parents, limb.offsets, limb.order, limb.spine, limb.spine_weights, limb.gaze, limb.gaze_weights,
            limb.joints, limb.ends, limb.half_leg, configurations, count, scratch.joints, first, out,
            scratch.places, scratch.turns,
        )  # fmt: skip
    else:
        posing.pose_arm_into(
            limb.parents, limb.offsets, limb.order, limb.spine[len(limb.spine) - 1], limb.arm_joints, limb.mirror,
            limb.joints, limb.ends, configurations, count, scratch.joints, first, out,
        )  # fmt: skip


@exact_kernel
def carry_frames(limb: Limb, scratch: LimbScratch, configurations: Floats, count: int) -> None:
    """The frames that the waist's limb carries, the chest's, in the pelvis frame, into the room; no capsules."""
    posing.pose_trunk_into(
        limb.parents, limb.offsets, limb.order, limb.spine, limb.spine_weights, limb.gaze, limb.gaze_weights,
        limb.joints[:0], limb.ends, limb.half_leg, configurations, count, scratch.joints, _FIRST, scratch.none,
        scratch.places, scratch.turns,
    )  # fmt: skip


@exact_kernel
def pose(limb: Limb, configurations: Floats) -> Floats32:
    """Capsule end points (C, 6, N) for configurations (N, d), in the pelvis frame (waist) or the chest frame (arms)."""
    count = configurations.shape[0]
    out = np.empty((limb.joints.shape[0], 6, count), np.float32)
    pose_into(limb, limb_scratch(limb, count), configurations, count, _FIRST, out)
    return out
