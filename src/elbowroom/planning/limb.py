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
from elbowroom.jit import exact_inner_kernel, exact_kernel
from elbowroom.planning.self_contact import allowed_distances

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]


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


@exact_kernel
def pose(limb: Limb, configurations: Floats) -> Floats32:
    """Capsule end points (C, 6, N) for configurations (N, d), in the pelvis frame (waist) or the chest frame (arms)."""
    if limb.is_waist:
        return posing.pose_trunk(
            limb.base, limb.parents, limb.offsets, limb.order, limb.spine, limb.spine_weights,
            limb.gaze, limb.gaze_weights, limb.joints, limb.ends, limb.half_leg, configurations,
        )[0]  # fmt: skip
    return posing.pose_arm(
        limb.base, limb.parents, limb.offsets, limb.order, limb.spine[-1], limb.arm_joints, limb.mirror,
        limb.joints, limb.ends, configurations,
    )  # fmt: skip


@exact_inner_kernel
def carried_frames(limb: Limb, configurations: Floats) -> tuple[Floats, Floats]:
    """The frames (N, 3), (N, 4) that the waist's limb carries, the chest's, in the pelvis frame, for waists (N, d)."""
    _, places, turns = posing.pose_trunk(
        limb.base, limb.parents, limb.offsets, limb.order, limb.spine, limb.spine_weights,
        limb.gaze, limb.gaze_weights, limb.joints, limb.ends, limb.half_leg, configurations,
    )  # fmt: skip
    return places, turns
