"""The collision body: capsules that ride on joints, a structure of arrays."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup


@dataclass(frozen=True, eq=False)
class Capsules:
    """Capsules fixed to joints of a skeleton.

    `starts` and `ends` are offsets from the joint in the axes of the T-posed body (the joint's normalised frame).
    A capsule belongs to the lowest group that moves its joint (`dof.group_of_bone`).
    """

    names: tuple[str, ...]  # (C,) "pelvis", "torso", "leftForearm", ...
    joints: NDArray[np.int64]  # (C,) joint that carries the capsule
    starts: NDArray[np.float64]  # (C, 3) metres
    ends: NDArray[np.float64]  # (C, 3) metres
    radii: NDArray[np.float64]  # (C,) metres
    groups: tuple[DofGroup, ...]  # (C,)

    def of(self, group: DofGroup) -> NDArray[np.int64]:
        """Indices of the capsules that belong to `group`."""
        return np.array([i for i, g in enumerate(self.groups) if g is group], dtype=np.int64)
