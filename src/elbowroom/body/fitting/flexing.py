"""What skinned surfaces do where joints bend: a body in several poses, and what its joints see of it."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.fitting.body_mesh import BodyMesh
from elbowroom.body.fitting.body_parts import BodyPoints
from elbowroom.body.fitting.slim_capsule import Slim, distances
from elbowroom.body.skeleton import Skeleton
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

# Degrees that thigh (forward), knee, ankle (toes up), toes and elbow of both sides are bent: standing, in mid-stride
# (left, right) with arms that swing or fold, on a high step (left, right), crouching.
_STRAIGHT = (0.0, 0.0, 0.0, 0.0, 0.0)
_AHEAD, _BEHIND = (30.0, 12.0, -8.0, 25.0, 30.0), (-18.0, 35.0, -20.0, 62.0, 70.0)
_RAISED, _CROUCHED = (60.0, 80.0, 15.0, 10.0, 30.0), (55.0, 90.0, 35.0, 0.0, 110.0)
_X, _Y = 0, 1
_BENT = {
    "UpperLeg": (_X, 0, -1.0),
    "LowerLeg": (_X, 1, 1.0),
    "Foot": (_X, 2, -1.0),
    "Toes": (_X, 3, -1.0),
    "LowerArm": (_Y, 4, 1.0),
}
_POSES = (
    (_STRAIGHT, _STRAIGHT),
    (_AHEAD, _BEHIND),
    (_BEHIND, _AHEAD),
    (_RAISED, _STRAIGHT),
    (_STRAIGHT, _RAISED),
    (_CROUCHED, _CROUCHED),
)


class PosedPoints(NamedTuple):
    """Points of a surface, each where it is in one of several poses."""

    places: Floats  # (N, 3) metres
    pose: Ints  # (N,)


@dataclass(frozen=True, eq=False)
class FlexedPoses:
    """The joints of a skeleton in all poses, the hips where they are in T-pose; the first is T-pose itself."""

    rest: Floats  # (J, 3) where the joints are in T-pose
    turns: Floats  # (P, J, 4) world rotations
    places: Floats  # (P, J, 3)

    def __len__(self) -> int:
        return len(self.turns)

    def carried(self, joints: Ints, points: Floats) -> Floats:
        """Where T-posed points (..., 3) are in all poses (P, ..., 3), each carried by one of the joints (...)."""
        moved: Floats = quaternion.rotate(self.turns[:, joints], points - self.rest[joints]) + self.places[:, joints]
        return moved

    def skinned(self, body: BodyMesh, vertices: Ints) -> Floats:
        """Where some vertices (V,) of a body are in all poses (P, V, 3)."""
        moved = self.carried(body.joints[vertices], body.places[vertices])
        means: Floats = np.einsum("vk,pvki->pvi", body.weights[vertices], moved)
        return means

    def sampled(self, samples: BodyPoints, some: Ints) -> PosedPoints:
        """Where some (S,) of the samples of a surface are, each in its pose: they are `in_turn`."""
        pose = in_turn(len(samples.joints), self)[some]
        placed = self.carried(samples.joints[some], samples.positions[some])
        return PosedPoints(placed[pose, np.arange(len(some))], pose)

    def seen(self, joint: int | Ints, points: PosedPoints) -> Floats:
        """Points in the T-posed frame of a joint, or each in that of its own (N,): (N, 3) metres."""
        back = quaternion.conjugate(self.turns[points.pose, joint])
        ways = points.places - self.places[points.pose, joint]
        still: Floats = quaternion.rotate(back, ways) + self.rest[joint]
        return still

    def outside(self, slim: Slim, joint: int, points: PosedPoints) -> Floats:
        """How far points are outside a capsule that rides on a joint (N,), metres; negative inside."""
        starts, ends = (self.carried(np.array(joint), end)[points.pose] for end in (slim.start, slim.end))
        return distances(points.places, starts, ends) - slim.radius


def poses_of(skeleton: Skeleton) -> FlexedPoses:
    """A skeleton in all poses."""
    rest, count = skeleton.positions, len(_POSES)
    turns = np.tile(quaternion.IDENTITY, (count, len(rest), 1))
    places = np.tile(rest, (count, 1, 1))
    for joint, (bone, parent) in enumerate(zip(skeleton.names, skeleton.parents, strict=True)):
        if parent < 0:
            continue
        turns[:, joint] = quaternion.multiply(turns[:, parent], _bent(bone))
        places[:, joint] = places[:, parent] + quaternion.rotate(turns[:, parent], rest[joint] - rest[parent])
    return FlexedPoses(rest, turns, places)


def flexed(body: BodyMesh, poses: FlexedPoses, corners: Ints, shares: Floats, carriers: Ints) -> Floats:
    """Samples (S, 3) of a T-posed body, each in one of the poses in turn, in the T-posed frame of its carrier.

    A sample is the mean of the vertices `corners` (S, 3) with weights `shares` (S, 3), and is carried by a joint (S,).
    """
    rest, turns, places = poses.rest, poses.turns, poses.places
    pose = in_turn(len(corners), poses)
    total = np.zeros((len(corners), 3))
    for corner in range(3):
        vertices = corners[:, corner]
        joints = body.joints[vertices]
        ways = body.places[vertices] - rest[joints]
        carried = quaternion.rotate(turns[pose[:, None], joints], ways) + places[pose[:, None], joints]
        total += shares[:, corner, None] * np.einsum("sk,ski->si", body.weights[vertices], carried)
    return poses.seen(carriers, PosedPoints(total, pose))


def in_turn(count: int, poses: FlexedPoses) -> Ints:
    """In which of the poses each of so many samples is (S,)."""
    return np.arange(count) % len(poses)


def _bent(bone: str) -> Floats:
    """Local rotations (P, 4) of a bone in all poses; positive about X is forward and down, about Y to the left."""
    side, part = (0 if bone.startswith("left") else 1), bone.removeprefix("left").removeprefix("right")
    inward = -1.0 if side == 0 else 1.0
    axis, number, sign = _BENT.get(part, (_X, 0, 0.0))
    turned = sign * (inward if axis == _Y else 1.0)
    return quaternion.about_axis(axis, turned * np.deg2rad([pose[side][number] for pose in _POSES]))
