"""From a configuration to what a client sets on the avatar's nodes, with everything constant worked out beforehand."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import BodyModel, body_model, joint_pose, posture_capsules
from elbowroom.body.rig import Rig
from elbowroom.geometry import quaternion
from elbowroom.server.schema.picture import Placement

Floats = NDArray[np.float64]


class NodePose(NamedTuple):
    """A pose in the terms of the avatar's file."""

    hips: Floats  # (3,) local translation of the hips node, file units
    rotations: NDArray[np.float32]  # (J, 4) local rotations of the nodes


class Poser:
    """Poses one avatar: frozen tables, no state."""

    def __init__(self, humanoid: Humanoid) -> None:
        self.model: BodyModel = body_model(humanoid)
        joints = len(humanoid.skeleton.names)
        self._rotation = _rotation_maps(humanoid.rig, joints)  # (J, 4, 4)
        self._hips, self._hips_rest = _hips_map(humanoid.rig)

    def node_pose(self, q: Floats, root: Floats) -> NodePose:
        """What the nodes get for a configuration (DOF,) and a root state (7,)."""
        return self.full_pose(*joint_pose(self.model, q, root))

    def full_pose(self, local: Floats, hips: Floats) -> NodePose:
        """What the nodes get for normalised local rotations (J, 4) and the hips joint (3,) in the root's frame."""
        rotations = np.matmul(self._rotation, local[:, :, None])[:, :, 0]
        return NodePose(self._hips @ hips + self._hips_rest, rotations.astype(np.float32))

    def segments(self, q: Floats, roots: Floats) -> NDArray[np.float32]:
        """End points of all capsules in the world, (N, C, 6), for configurations (N, DOF) and root states (N, 7)."""
        return np.ascontiguousarray(np.moveaxis(posture_capsules(self.model, q, roots), -1, 0))


def placement(rig: Rig | None) -> Placement:
    """How the file's scene stands in the root's frame."""
    if rig is None:
        return Placement((0.0, 0.0, 0.0), 0.0, 1.0)
    turned = quaternion.rotate(quaternion.about_axis(1, -rig.facing), rig.offset)
    x, y, z = (-rig.scale * turned).tolist()
    return Placement((x, y, z), -rig.facing, rig.scale)


def _rotation_maps(rig: Rig | None, joints: int) -> Floats:
    """The matrices (J, 4, 4) that do `Rig.node_rotations`, which is linear in each joint's quaternion."""
    basis = [np.tile(row, (joints, 1)) for row in np.eye(4)]
    columns = basis if rig is None else [rig.node_rotations(column) for column in basis]
    return np.stack(columns, axis=-1)


def _hips_map(rig: Rig | None) -> tuple[Floats, Floats]:
    """Matrix (3, 3) and vector (3,) from the hips joint in the root's frame to its node's local translation."""
    if rig is None:
        return np.eye(3), np.zeros(3)
    to_file = quaternion.to_matrix(quaternion.about_axis(1, rig.facing)) / rig.scale
    to_parent = quaternion.to_matrix(rig.hips_parent_rotation).T / rig.hips_parent_scale
    return to_parent @ to_file, to_parent @ (rig.offset - rig.hips_parent_position)
