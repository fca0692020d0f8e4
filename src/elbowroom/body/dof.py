"""The 13 planning degrees of freedom in four groups, as in the paper, section 3.1.

A configuration `q` has shape (13,), metres and radians:

    index  group      component
    0-2    ROOT       x, z on the ground; heading about +Y, 0 faces +Z, positive turns left (towards +X)
    3-4    WAIST      bend (positive forward), twist (positive to the left)
    5-8    LEFT_ARM   shoulder flexion, abduction, internal rotation; elbow flexion
    9-12   RIGHT_ARM  the same, mirrored: equal values on both sides make a symmetric gesture

All zero is the standing figure with hanging arms, palms to the thighs. The shoulder's flexion and abduction are the two
components of a swing (exponential map, Grassia 1998), followed by the rotation about the arm's own axis:
no gimbal lock within the limits, and Euclidean distance between configurations is meaningful.
"""

from enum import Enum

import numpy as np
from numpy.typing import ArrayLike, NDArray

DOF = 13


class DofGroup(Enum):
    """One of the paper's groups J; its value is the slice of `q` that it owns."""

    ROOT = slice(0, 3)
    WAIST = slice(3, 5)
    LEFT_ARM = slice(5, 9)
    RIGHT_ARM = slice(9, 13)

    @property
    def size(self) -> int:
        """The number of degrees of freedom in the group."""
        return int(self.value.stop - self.value.start)


# J*: the groups of the local motion, in the order of decoupled planning (a later group hangs on the earlier).
LOCAL_GROUPS = (DofGroup.WAIST, DofGroup.LEFT_ARM, DofGroup.RIGHT_ARM)

# Ranges of motion: American Academy of Orthopaedic Surgeons, "Joint Motion: Method of Measuring and Recording" (1965):
# thoracolumbar flexion 80, extension 25, rotation 45; shoulder flexion 180, extension 60, abduction 180,
# internal rotation 70, external 90; elbow flexion 150 degrees. Adduction across the body (the swing's lateral part)
# is limited to 45 degrees, after Boone & Azen, J. Bone Joint Surg. 61-A (1979).
_WAIST_DEG = [(-25.0, 80.0), (-45.0, 45.0)]
_ARM_DEG = [(-60.0, 175.0), (-45.0, 175.0), (-90.0, 70.0), (0.0, 150.0)]
# Flexion and abduction together swing the arm by at most this angle from hanging (the swing vector's length).
MAX_ELEVATION = float(np.deg2rad(175.0))
_LIMITS = np.deg2rad(np.array(_WAIST_DEG + 2 * _ARM_DEG))


def limits(group: DofGroup) -> NDArray[np.float64]:
    """Lower and upper limits of a group's components, shape (size, 2); the root is unbounded."""
    if group is DofGroup.ROOT:
        return np.tile([-np.inf, np.inf], (3, 1))
    rows: NDArray[np.float64] = _LIMITS[group.value.start - 3 : group.value.stop - 3]
    return rows.copy()


def clamp(group: DofGroup, q: ArrayLike) -> NDArray[np.float64]:
    """The group's configurations (..., size) brought within the limits; an arm's elevation too."""
    low, high = limits(group).T
    inside: NDArray[np.float64] = np.clip(np.asarray(q, np.float64), low, high)
    if group in (DofGroup.LEFT_ARM, DofGroup.RIGHT_ARM):
        elevation = np.linalg.norm(inside[..., :2], axis=-1, keepdims=True)
        inside[..., :2] *= np.minimum(1.0, MAX_ELEVATION / np.maximum(elevation, MAX_ELEVATION))
    return inside


def within_limits(q: ArrayLike, tolerance: float = 1e-9) -> bool:
    """Whether every one of the configurations (..., 13) respects the limits of all groups, within `tolerance` rad."""
    posture = np.asarray(q, np.float64)
    groups = ((group, posture[..., group.value]) for group in LOCAL_GROUPS)
    return all(bool(np.all(np.abs(clamp(group, part) - part) <= tolerance)) for group, part in groups)
