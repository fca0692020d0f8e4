"""The normalised skeleton: VRM bones in T-pose, all rest rotations identity."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Joints of a humanoid in T-pose, facing +Z, the ground at y = 0, the hips above the origin.

    As in three-vrm's normalised humanoid, every joint's rest rotation is the identity, so a pose is one rotation
    per joint about the joint's rest position, in the axes of the T-posed body.
    """

    names: tuple[str, ...]  # (J,) VRM 1.0 bone names, parents before children, "hips" first
    parents: NDArray[np.int64]  # (J,) index of the parent joint, -1 for the hips
    positions: NDArray[np.float64]  # (J, 3) T-pose joint positions, metres

    def index(self, bone: str) -> int:
        """The joint of a bone; raises KeyError if the avatar has no such bone."""
        try:
            return self.names.index(bone)
        except ValueError:
            raise KeyError(bone) from None

    def has(self, bone: str) -> bool:
        """Whether the avatar has this bone."""
        return bone in self.names

    def joints(self, rotations: Floats, hips: Floats) -> Floats:
        """Places (..., J, 3) of all joints, by local `rotations` (..., J, 4) and the place of the hips (..., 3)."""
        places, turns = np.empty((*rotations.shape[:-1], 3)), rotations.copy()
        places[..., 0, :] = hips
        for joint, parent in enumerate(self.parents):
            if parent >= 0:
                bone = self.positions[joint] - self.positions[parent]
                places[..., joint, :] = places[..., parent, :] + quaternion.rotate(turns[..., parent, :], bone)
                turns[..., joint, :] = quaternion.multiply(turns[..., parent, :], rotations[..., joint, :])
        return places

    @property
    def height(self) -> float:
        """Height of the head joint above the ground, metres (the crown is some 13 % of stature higher)."""
        return float(self.positions[self.index("head"), 1])
