"""The 14 planning degrees of freedom in four groups: those of the paper, section 3.1, and the lowering of the pelvis.

A configuration `q` has shape (14,), metres and radians:

    index  group      component
    0-2    ROOT       x, z on the ground; heading about +Y, 0 faces +Z, positive turns left (towards +X)
    3-5    WAIST      bend (positive forward), twist (positive to the left), lowering (0 stands, positive crouches)
    6-9    LEFT_ARM   shoulder flexion, abduction, internal rotation; elbow flexion
    10-13  RIGHT_ARM  the same, mirrored: equal values on both sides make a symmetric gesture

Lowering is counted in half leg lengths (`GaitShape.half_leg`; some 0.42 m on an adult), not in metres: so a crouch is
the same posture on every build, and a change of it moves the trunk about as far as an equal angle of bend moves the
shoulders. It goes with the waist because trunk, head and arms follow it; the legs bend under it, the feet stay where
the gait puts them.

All zero is the standing figure with hanging arms, palms to the thighs. The shoulder's flexion and abduction are the two
components of a swing (exponential map, Grassia 1998), followed by the rotation about the arm's own axis:
no gimbal lock within the limits, and Euclidean distance between configurations is meaningful.
"""

from enum import Enum

import numpy as np
from numpy.typing import ArrayLike, NDArray

DOF = 14
LOWERING = 5  # the place of the lowering in `q`


class DofGroup(Enum):
    """One of the paper's groups J; its value is the slice of `q` that it owns."""

    __hash__ = object.__hash__  # there is one of each: found in half the time that its name would be

    ROOT = slice(0, 3)
    WAIST = slice(3, 6)
    LEFT_ARM = slice(6, 10)
    RIGHT_ARM = slice(10, 14)

    @property
    def size(self) -> int:
        """The number of degrees of freedom in the group."""
        return int(self.value.stop - self.value.start)


# J*: the groups of the local motion, in the order of decoupled planning (a later group hangs on the earlier).
LOCAL_GROUPS = (DofGroup.WAIST, DofGroup.LEFT_ARM, DofGroup.RIGHT_ARM)
_LOCAL = DofGroup.WAIST.value.start
LOCAL = DOF - DofGroup.ROOT.size  # components of the local groups, side by side: an upper body (11,)

# Ranges of motion: American Academy of Orthopaedic Surgeons, "Joint Motion: Method of Measuring and Recording" (1965):
# thoracolumbar flexion 80, extension 25, rotation 45; shoulder flexion 180, extension 60, abduction 180,
# internal rotation 70, external 90; elbow flexion 150 degrees. Adduction across the body (the swing's lateral part)
# is limited to 45 degrees, after Boone & Azen, J. Bone Joint Surg. 61-A (1979).
_WAIST_DEG = [(-25.0, 80.0), (-45.0, 45.0)]
# Lowered by 0.7 half legs the knees of a walk are bent by 75 to 118 degrees (range of motion 135, in the same book) and
# the shins of a stand lean by some 35, about what ankles give with the heels down. Walking, few would go deeper.
_LOWERING = (0.0, 0.7)
_ARM_DEG = [(-60.0, 175.0), (-45.0, 175.0), (-90.0, 70.0), (0.0, 150.0)]
# Flexion and abduction together swing the arm by at most this angle from hanging (the swing vector's length).
MAX_ELEVATION = float(np.deg2rad(175.0))
_LIMITS = np.concatenate([np.deg2rad(_WAIST_DEG), [_LOWERING], np.deg2rad(2 * _ARM_DEG)])


_COLUMNS = {group: slice(group.value.start - _LOCAL, group.value.stop - _LOCAL) for group in LOCAL_GROUPS}


def columns_of(group: DofGroup) -> slice:
    """A local group's columns of an upper body (11,), a configuration without the root."""
    return _COLUMNS[group]


def limits(group: DofGroup) -> NDArray[np.float64]:
    """Lower and upper limits of a group's components, shape (size, 2); the root is unbounded."""
    if group is DofGroup.ROOT:
        return np.tile([-np.inf, np.inf], (3, 1))
    rows: NDArray[np.float64] = _LIMITS[columns_of(group)]
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
    """Whether every one of the configurations (..., 14) respects the limits of all groups, within `tolerance` rad."""
    posture = np.asarray(q, np.float64)
    groups = ((group, posture[..., group.value]) for group in LOCAL_GROUPS)
    return all(bool(np.all(np.abs(clamp(group, part) - part) <= tolerance)) for group, part in groups)
