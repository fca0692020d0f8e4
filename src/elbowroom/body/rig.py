"""How the avatar's own file is posed: from normalised rotations to the local rotations of its nodes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.geometry import quaternion


@dataclass(frozen=True, eq=False)
class Rig:
    """The nodes of an avatar file that carry the skeleton's joints, and their rotations in T-pose.

    With W the world rotation of a node and L its local rotation, both in T-pose and in the model's own axes, a
    normalised rotation N becomes `L W^-1 N W` (VRM 1.0 specification, "humanoid pose conversion"). Between two
    humanoid nodes other nodes may sit; they do not move. (L W^-1 is the inverse of the parent's world rotation at
    rest, and above a node all bones have turned by the product of their N, so the node's world rotation becomes
    that product times W.)

    A viewer shows the file in the model's root frame (ground at y = 0, origin under the hips, facing +Z) by turning
    it by `-facing` about Y, scaling it by `scale`, and moving it by `to_model` of the file's origin.
    """

    nodes: NDArray[np.int64]  # (J,) node index in the file, in the order of the skeleton's joints
    local_rotations: NDArray[np.float64]  # (J, 4) L, xyzw
    world_rotations: NDArray[np.float64]  # (J, 4) W, xyzw, in the file's own axes
    hips_parent_rotation: NDArray[np.float64]  # (4,) world rotation of the hips' parent node, file axes
    hips_parent_position: NDArray[np.float64]  # (3,) its world position, file axes and units
    hips_parent_scale: float  # its uniform world scale
    facing: float  # heading of the file's model in radians: pi where it faces -Z (VRM 0.x), mostly 0
    offset: NDArray[np.float64]  # (3,) file position of the point that is the skeleton's origin (under the hips)
    scale: float  # metres per unit of the file

    def node_rotations(self, rotations: NDArray[np.float64]) -> NDArray[np.float64]:
        """Local node rotations (J, 4) for normalised local rotations (J, 4) of the skeleton."""
        turned = quaternion.multiply(
            quaternion.multiply(quaternion.about_axis(1, self.facing), rotations),
            quaternion.about_axis(1, -self.facing),
        )
        inverse = quaternion.conjugate(self.world_rotations)
        return quaternion.multiply(
            quaternion.multiply(self.local_rotations, inverse), quaternion.multiply(turned, self.world_rotations)
        )

    def hips_position(self, hips: NDArray[np.float64]) -> NDArray[np.float64]:
        """Local translation (..., 3) of the hips' node, in file units, for a hips joint (..., 3) in the root frame."""
        in_parent = quaternion.rotate(
            quaternion.conjugate(self.hips_parent_rotation), self.to_file(hips) - self.hips_parent_position
        )
        translation: NDArray[np.float64] = in_parent / self.hips_parent_scale
        return translation

    def to_model(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """Points (..., 3) of the file's world, in the model's root frame: metres, ground at y = 0, facing +Z."""
        return self.scale * quaternion.rotate(quaternion.about_axis(1, -self.facing), points - self.offset)

    def to_file(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        """The inverse of `to_model`."""
        return quaternion.rotate(quaternion.about_axis(1, self.facing), points / self.scale) + self.offset

    def normalised(self, rotations: NDArray[np.float64]) -> NDArray[np.float64]:
        """Normalised local rotations (..., J, 4) for local rotations of the nodes: the inverse of `node_rotations`."""
        inverse = quaternion.multiply(self.world_rotations, quaternion.conjugate(self.local_rotations))
        turned = quaternion.multiply(
            quaternion.multiply(inverse, rotations), quaternion.conjugate(self.world_rotations)
        )
        back, forth = quaternion.about_axis(1, -self.facing), quaternion.about_axis(1, self.facing)
        return quaternion.multiply(quaternion.multiply(back, turned), forth)

    def hips_in_root(self, translation: NDArray[np.float64]) -> NDArray[np.float64]:
        """The hips joint (..., 3) in the root frame for its node's translation: the inverse of `hips_position`."""
        turned = quaternion.rotate(self.hips_parent_rotation, translation)
        return self.to_model(self.hips_parent_position + self.hips_parent_scale * turned)
