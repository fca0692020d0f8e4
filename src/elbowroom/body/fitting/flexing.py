"""What skinned surfaces do at hips, knees, toes and elbows: samples as a rigid capsule of one joint sees them."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.fitting.body_mesh import BodyMesh
from elbowroom.body.skeleton import Skeleton
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

# Degrees that thigh (forward), knee, toes and elbow of both sides are bent: standing, in mid-stride (left, right) with
# arms that swing or fold, crouching.
_STANDING = ((0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0))
_AHEAD, _BEHIND = (30.0, 12.0, 25.0, 30.0), (-18.0, 35.0, 62.0, 70.0)
_CROUCHING = ((55.0, 90.0, 0.0, 110.0), (55.0, 90.0, 0.0, 110.0))
_X, _Y = 0, 1
_BENT = {"UpperLeg": (_X, 0, -1.0), "LowerLeg": (_X, 1, 1.0), "Toes": (_X, 2, -1.0), "LowerArm": (_Y, 3, 1.0)}
_POSES = (_STANDING, (_AHEAD, _BEHIND), (_BEHIND, _AHEAD), _CROUCHING)


def flexed(body: BodyMesh, skeleton: Skeleton, corners: Ints, shares: Floats, carriers: Ints) -> Floats:
    """Samples (S, 3) of a T-posed body, each in one of the poses in turn, in the T-posed frame of its carrier.

    A sample is the mean of the vertices `corners` (S, 3) with weights `shares` (S, 3), and is carried by a joint (S,).
    """
    rest = skeleton.positions
    turns, places = _posed(skeleton)
    pose = np.arange(len(corners)) % len(_POSES)
    total = np.zeros((len(corners), 3))
    for corner in range(3):
        vertices = corners[:, corner]
        joints = body.joints[vertices]
        ways = body.places[vertices] - rest[joints]
        carried = quaternion.rotate(turns[pose[:, None], joints], ways) + places[pose[:, None], joints]
        total += shares[:, corner, None] * np.einsum("sk,ski->si", body.weights[vertices], carried)
    back = quaternion.conjugate(turns[pose, carriers])
    seen: Floats = quaternion.rotate(back, total - places[pose, carriers]) + rest[carriers]
    return seen


def _posed(skeleton: Skeleton) -> tuple[Floats, Floats]:
    """World rotations (P, J, 4) and places (P, J, 3) of the joints in all poses, the hips where they are in T-pose."""
    rest = skeleton.positions
    turns = np.tile(quaternion.IDENTITY, (len(_POSES), len(rest), 1))
    places = np.tile(rest, (len(_POSES), 1, 1))
    for joint, (bone, parent) in enumerate(zip(skeleton.names, skeleton.parents, strict=True)):
        if parent < 0:
            continue
        turns[:, joint] = quaternion.multiply(turns[:, parent], _bent(bone))
        places[:, joint] = places[:, parent] + quaternion.rotate(turns[:, parent], rest[joint] - rest[parent])
    return turns, places


def _bent(bone: str) -> Floats:
    """Local rotations (P, 4) of a bone in all poses; positive about X is forward and down, about Y to the left."""
    side, part = (0 if bone.startswith("left") else 1), bone.removeprefix("left").removeprefix("right")
    inward = -1.0 if side == 0 else 1.0
    axis, number, sign = _BENT.get(part, (_X, 0, 0.0))
    turned = sign * (inward if axis == _Y else 1.0)
    return quaternion.about_axis(axis, turned * np.deg2rad([pose[side][number] for pose in _POSES]))
