"""A local group as compiled code sees it: from its configuration to its capsules in the frame that carries it.

The waist's capsules live in the pelvis frame, those of the groups that hang on it in the chest frame: there they depend
on the group's own configuration alone, so that each vertex of an activity graph is posed once.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import CHILDREN, DofGroup
from elbowroom.body.pose.chain_posing import PoseScratch, pose_chain, pose_chain_into, pose_scratch
from elbowroom.body.pose.joint_tree import Chain
from elbowroom.body.pose.kinematics import BodyModel, chest_frames, group_capsules
from elbowroom.by_reference import by_reference
from elbowroom.geometry import quaternion
from elbowroom.jit import exact_kernel, inner_exact_kernel, plain
from elbowroom.planning.model.self_contact import allowed_distances

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

_FIRST = plain(0)  # place in a row of capsules


@by_reference
class Limb(NamedTuple):
    """What posing one local group needs of a `BodyModel`, and what it must keep off however the body stands."""

    chain: Chain
    radii: Floats32  # (C,) metres
    trunk: Floats  # (K, 6) in the chest frame with the waist at rest; none for the waist
    allowed: Floats  # (C, K) metres: how near the limb's axes may come to those of the trunk


def limb_of(model: BodyModel, group: DofGroup) -> Limb:
    """The limb that a local group moves."""
    return Limb(model.chains[group], model.capsules_of(group).radii, *_trunk_limits(model, group))


def trunk_limb(model: BodyModel) -> Limb:
    """The waist's limb with all that follows the waist where nobody plans it, as one: the paper's trunk."""
    chain, capsules = model.trunk
    return Limb(chain, capsules.radii, *_trunk_limits(model, DofGroup.WAIST))


def _trunk_limits(model: BodyModel, group: DofGroup) -> tuple[Floats, Floats]:
    """The trunk at rest, in the chest frame, and the distances from it that a group on it has to keep."""
    radii = model.capsules_of(group).radii
    parent = group.parent
    if group not in CHILDREN or parent is None or parent not in group.clear_of:
        return np.empty((0, 6)), np.empty((len(radii), 0))
    rest = np.zeros((1, parent.size))
    positions, rotations = chest_frames(model, rest)
    chain, capsules = model.trunk
    ends = pose_chain(chain, rest)[0][:, :, 0].astype(np.float64).reshape(-1, 2, 3)
    trunk = quaternion.rotate(quaternion.conjugate(rotations[0]), ends - positions[0]).reshape(-1, 6)
    hanging = group_capsules(model, group, np.zeros((1, group.size)))
    return trunk, allowed_distances(hanging, radii, trunk, capsules.radii)


class LimbScratch(NamedTuple):
    """What the posing of a limb works on; it belongs to that limb."""

    joints: PoseScratch
    places: Floats  # (N, 3) of the frames that the waist's limb carries
    turns: Floats  # (N, 4)
    none: Floats32  # (0, 6, 0) no capsules


@inner_exact_kernel
def limb_scratch(limb: Limb, count: int) -> LimbScratch:
    """What posing a limb in `count` configurations at once works on."""
    return LimbScratch(
        pose_scratch(limb.chain),
        np.empty((count, 3)),
        np.empty((count, 4)),
        np.empty((0, 6, 0), np.float32),
    )


@inner_exact_kernel
def pose_into(limb: Limb, scratch: LimbScratch, configurations: Floats, count: int, first: int, out: Floats32) -> None:
    """`pose` for the first `count` configurations (N, d), written to `out` (C, 6 or more, M) from `first` on.

    The frames that the waist's limb carries are written to the scratch memory.
    """
    pose_chain_into(limb.chain, configurations, count, scratch.joints, first, out, scratch.places, scratch.turns)


@inner_exact_kernel
def carry_frames(limb: Limb, scratch: LimbScratch, configurations: Floats, count: int) -> None:
    """The frames that the waist's limb carries, in the pelvis frame, into the scratch memory; no capsules."""
    pose_into(limb, scratch, configurations, count, _FIRST, scratch.none)


@exact_kernel
def pose(limb: Limb, configurations: Floats) -> Floats32:
    """Capsule end points (C, 6, N) for configurations (N, d), in the frame that carries the limb."""
    count = configurations.shape[0]
    out = np.empty((limb.radii.shape[0], 6, count), np.float32)
    pose_into(limb, limb_scratch(limb, count), configurations, count, _FIRST, out)
    return out
