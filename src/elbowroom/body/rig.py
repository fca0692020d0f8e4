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
    humanoid nodes other nodes may sit; they do not move.
    """

    nodes: NDArray[np.int64]  # (J,) node index in the file, in the order of the skeleton's joints
    local_rotations: NDArray[np.float64]  # (J, 4) L, xyzw
    world_rotations: NDArray[np.float64]  # (J, 4) W, xyzw, in the file's own axes
    hips_parent_rotation: NDArray[np.float64]  # (4,) world rotation of the hips' parent node, file axes
    hips_parent_position: NDArray[np.float64]  # (3,) its world position, file axes and units
    hips_parent_scale: float  # its uniform world scale
    facing: float  # heading of the file's model in radians: pi where it faces -Z (VRM 0.x), else 0
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
