"""A pose in the terms of VRM: what a program needs that draws an avatar, or hangs something on a bone of it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, joint_pose
from elbowroom.body.root import HEIGHT
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]


class Pose(NamedTuple):
    """One pose of an avatar; J joints, by the VRM bones that begin there, the hips first."""

    bones: tuple[str, ...]  # (J,) VRM 1.0 names
    rotations: Floats  # (J, 4) of each bone in its parent, of the hips in the world; T-pose facing +Z has none
    joints: Floats  # (J, 3) in the world, metres

    def rotation(self, bone: str) -> Floats:
        """The rotation (4,) of a bone; raises KeyError where the avatar has none of this name."""
        found: Floats = self.rotations[self._number(bone)]
        return found

    def joint(self, bone: str) -> Floats:
        """Where a bone begins (3,) in the world, metres; raises KeyError where the avatar has none of this name."""
        found: Floats = self.joints[self._number(bone)]
        return found

    def _number(self, bone: str) -> int:
        if bone not in self.bones:
            raise KeyError(bone)
        return self.bones.index(bone)


def pose_of(humanoid: Humanoid, q: Floats, root: Floats) -> Pose:
    """The pose of an avatar in a configuration `q` (DOF,) and a root state (7,), or one with feet (SHOWN,)."""
    rotations, hips = joint_pose(body_model(humanoid), q, root)
    height = root[HEIGHT] if len(root) > HEIGHT else 0.0
    turn, place = quaternion.about_axis(1, root[2]), np.array([root[0], height, root[1]])
    rotations[0] = quaternion.multiply(turn, rotations[0])
    joints = humanoid.skeleton.joints(rotations, place + quaternion.rotate(turn, hips))
    return Pose(humanoid.skeleton.names, rotations, joints)
