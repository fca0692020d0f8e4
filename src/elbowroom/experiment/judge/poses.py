"""Forward kinematics once more, plain NumPy over whole arrays of poses: what `body.pose.kinematics` is judged by.

The conventions are those of the body (`body.dof`, `docs/architecture.md`), the arithmetic shares nothing with its
kernels. Only the tables of the gait (where feet and hips are at a root state, `body.pose.kinematics.lower_body`) and of
relaxed fingers are taken from there: they say what the walk is, not where the body gets to.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOWERING, DofGroup
from elbowroom.body.gait.cycle import gait_shape
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.hands import relaxed_rotations
from elbowroom.body.pose.kinematics import lower_body
from elbowroom.body.root import HEIGHT, WITH_FEET
from elbowroom.body.skeleton import Skeleton
from elbowroom.experiment.judge.motion import Moments, ShownMotion
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_SPINE_PARTS = {"spine": 0.40, "chest": 0.35, "upperChest": 0.25}
_NECK_PARTS = {"neck": 0.5, "head": 0.5}
_SIDES = "left", "right"
_RIGHT, _UP, _AHEAD = 0, 1, 2  # axes
_LEAN, _LEANING = 0.6, 0.45  # radians that lowered hips lean forward at most, and the lowering at which they do
_SETBACK = 0.5  # how far lowered hips go back, against how far they go down
_SPLAY = 1.2  # radians that the knees open for each leg length that the hips go back
_SOFT = 0.004  # of the leg: a knee that straightens more slows down


class Posed(NamedTuple):
    """Joints in the world."""

    positions: Floats  # (N, J, 3) metres
    rotations: Floats  # (N, J, 3, 3)

    def part(self, rows: slice) -> "Posed":
        """Some of the poses."""
        return Posed(self.positions[rows], self.rotations[rows])


class Poser:
    """Poses one avatar as its page does; frozen."""

    def __init__(self, humanoid: Humanoid) -> None:
        self.skeleton = humanoid.skeleton
        self._gait = gait_shape(self.skeleton, humanoid.soles)
        self._relaxed = relaxed_rotations(self.skeleton)

    def local(self, q: Floats, roots: Floats) -> tuple[Floats, Floats]:
        """Normalised joint rotations (N, J, 4) and hips (N, 3) in the root frame for `q` (N, DOF), `roots` (N, 7).

        The roots may be followed by their feet, and these by how hips, chest and head are carried.
        """
        lowerings = np.ascontiguousarray(q[:, LOWERING])
        feet, sinks = lower_body(self._gait, np.ascontiguousarray(roots, np.float64), lowerings)
        rotations = np.tile(self._relaxed, (len(q), 1, 1))
        (bend, twist, lowering), (nod, turn) = q[:, DofGroup.WAIST.at].T, q[:, DofGroup.HEAD.at].T
        _pose_column(self.skeleton, _SPINE_PARTS, bend, twist, rotations)
        _pose_column(self.skeleton, _NECK_PARTS, nod, turn, rotations)
        _pose_arm(self.skeleton, "left", 1.0, q[:, DofGroup.LEFT_ARM.at], rotations)
        _pose_arm(self.skeleton, "right", -1.0, q[:, DofGroup.RIGHT_ARM.at], rotations)
        lowered = 0.25 * self._gait.legs[:, 8:10].sum() * lowering[:, None]
        moved = -sinks[:, :1] * np.eye(3)[_UP] - _SETBACK * lowered * np.eye(3)[_AHEAD]
        carriage = _carriage(roots, _lean(lowering))
        middle = 0.5 * sum(self.skeleton.positions[self.skeleton.index(f"{side}UpperLeg")] for side in _SIDES)
        for side, name in enumerate(_SIDES):
            hip = self.skeleton.positions[self.skeleton.index(f"{name}UpperLeg")]
            shifted = middle + carriage.moved + quaternion.rotate(carriage.hips, hip - middle)
            _pose_leg(self.skeleton, name, feet[:, side], (moved, shifted, carriage.hips), rotations)
        _carry(self.skeleton, carriage, rotations)
        arm = quaternion.rotate(carriage.hips, self.skeleton.positions[0] - middle)
        return rotations, middle + carriage.moved + arm + moved

    def world(self, local: Floats, hips: Floats, places: Floats) -> Posed:
        """Joints in the world for rotations (N, J, 4), hips (N, 3) and places (N, 3 or 4) of the root.

        Places are x, z, heading, and its height where it is not 0.
        """
        rest, parents = self.skeleton.positions, self.skeleton.parents
        turns = _matrices(local)
        heading = quaternion.to_matrix(quaternion.about_axis(_UP, places[:, 2]))
        heights = places[:, 3] if places.shape[1] > 3 else np.zeros(len(places))
        ground = np.stack([places[:, 0], heights, places[:, 1]], axis=-1)
        positions, rotations = np.empty((*local.shape[:2], 3)), np.empty_like(turns)
        for joint, parent in enumerate(parents):
            above = heading if parent < 0 else rotations[:, parent]
            origin = ground if parent < 0 else positions[:, parent]
            offset = hips if parent < 0 else np.broadcast_to(rest[joint] - rest[parent], hips.shape)
            positions[:, joint] = origin + np.einsum("nij,nj->ni", above, offset)
            rotations[:, joint] = above @ turns[:, joint]
        return Posed(positions, rotations)

    def at(self, motion: ShownMotion, moments: Moments) -> Posed:
        """The poses that are shown at some moments.

        Between two frames as on the page: joint rotations by the shortest arc, root and hips in straight lines.
        """
        frames, place = np.unique(np.concatenate([moments.first, moments.second]), return_inverse=True)
        a, b = place[: len(moments.first)], place[len(moments.first) :]
        local, hips = self.local(motion.q[frames], motion.roots[frames])
        share = moments.share[:, None]
        places = motion.roots[frames][:, [0, 1, 2, HEIGHT] if motion.roots.shape[1] > HEIGHT else [0, 1, 2]]
        return self.world(
            quaternion.slerp(local[a], local[b], share),
            hips[a] + share * (hips[b] - hips[a]),
            places[a] + share * (places[b] - places[a]),
        )


class _Carriage(NamedTuple):
    """How hips, chest and head are carried beyond the planned pose, in the root's axes."""

    moved: Floats  # (N, 3) metres
    hips: Floats  # (N, 4), leaning
    chest: Floats  # (N, 4) of where it was planned: on hips that lean
    bent: Floats  # (N, 4) the same without the lean
    gaze: Floats  # (N, 4) of the head against where it was planned


def _lean(lowering: Floats) -> Floats:
    """Radians (N,) that the hips lean forward about the joints of the legs."""
    part = np.clip(lowering / _LEANING, 0.0, 1.0)
    lean: Floats = _LEAN * part**2 * (3.0 - 2.0 * part)
    return lean


def _carriage(roots: Floats, lean: Floats) -> _Carriage:
    told = roots[:, WITH_FEET:]
    if not told.shape[1]:
        told = np.zeros((len(roots), 10))
    (turn, raised, chest_turn, chest_raised, bend, gaze, nod) = told[:, 3:10].T
    hips = quaternion.multiply(quaternion.about_axis(_UP, turn), quaternion.about_axis(_AHEAD, raised))
    chest = quaternion.multiply(quaternion.about_axis(_UP, chest_turn), quaternion.about_axis(_AHEAD, chest_raised))
    chest = quaternion.multiply(chest, quaternion.about_axis(_RIGHT, bend))
    looks = quaternion.multiply(quaternion.about_axis(_UP, gaze), quaternion.about_axis(_RIGHT, nod))
    leaning = quaternion.about_axis(_RIGHT, lean)
    on_hips = quaternion.multiply(chest, leaning)
    return _Carriage(told[:, :3], quaternion.multiply(hips, leaning), on_hips, chest, looks)


def _carry(skeleton: Skeleton, carriage: _Carriage, out: Floats) -> None:
    """Hips turn with all on them; the spine's first bone turns the chest back, and the neck's the head."""
    spine = next(skeleton.index(bone) for bone in _SPINE_PARTS if skeleton.has(bone))
    neck = next(skeleton.index(bone) for bone in _NECK_PARTS if skeleton.has(bone))
    out[:, 0] = carriage.hips
    against = quaternion.multiply(quaternion.conjugate(carriage.hips), carriage.chest)
    out[:, spine] = quaternion.multiply(against, out[:, spine])
    back = quaternion.multiply(carriage.gaze, quaternion.conjugate(carriage.bent))
    out[:, neck] = quaternion.multiply(back, out[:, neck])


def _pose_column(skeleton: Skeleton, parts: Mapping[str, float], bend: Floats, twist: Floats, out: Floats) -> None:
    """The rotation vector of Ry(twist) Rx(bend), spread over those of a column's bones that the avatar has."""
    end = quaternion.multiply(quaternion.about_axis(_UP, twist), quaternion.about_axis(_RIGHT, bend))
    vector = quaternion.to_rotation_vector(end)
    present = {bone: part for bone, part in parts.items() if skeleton.has(bone)}
    for bone, part in present.items():
        share = part / sum(present.values())
        out[:, skeleton.index(bone)] = quaternion.from_rotation_vector(share * vector)


def _pose_arm(skeleton: Skeleton, side: str, mirror: float, arm: Floats, out: Floats) -> None:
    """exp(swing) Ry(-internal) Rz(-90 deg) for the upper arm, Ry(-elbow) for the forearm; mirrored on the right."""
    flexion, abduction, internal, elbow = arm.T
    swing = quaternion.from_rotation_vector(np.stack([-flexion, np.zeros(len(arm)), mirror * abduction], axis=-1))
    spin = quaternion.about_axis(_UP, -mirror * internal)
    hang = quaternion.about_axis(_AHEAD, -mirror * 0.5 * np.pi)
    out[:, skeleton.index(f"{side}UpperArm")] = quaternion.multiply(quaternion.multiply(swing, spin), hang)
    out[:, skeleton.index(f"{side}LowerArm")] = quaternion.about_axis(_UP, -mirror * elbow)


def _pose_leg(skeleton: Skeleton, side: str, foot: Floats, hips: tuple[Floats, Floats, Floats], out: Floats) -> None:
    """Hip, knee, ankle and toes for feet (N, 6): ankle x, y, z, yaw, pitch, bend of the toes, in the root frame.

    `hips` tell how far they are from their place in T-pose without carriage (N, 3), where the leg's joint is with
    carriage alone (N, 3), and how they are turned (N, 4).
    """
    moved, shifted, turned = hips
    bones = [f"{side}{part}" for part in ("UpperLeg", "LowerLeg", "Foot", "Toes")]
    hip, knee, ankle = (skeleton.positions[skeleton.index(bone)] for bone in bones[:3])
    thigh, shin = knee - hip, ankle - knee
    outward = foot[:, :3] - moved - shifted
    lengths = np.linalg.norm(thigh), np.linalg.norm(shin)
    opening = (1.0 if side == "left" else -1.0) * _SPLAY * -moved[:, _AHEAD] / sum(lengths)
    knee_axis = quaternion.rotate(quaternion.about_axis(_UP, 0.5 * foot[:, 3] + opening), [1.0, 0.0, 0.0])
    to_knee, to_ankle, axis = _bent(outward, *lengths, knee_axis)
    upper = quaternion.from_matrix(_axes(to_knee, axis) @ _axes(thigh, np.eye(3)[_RIGHT]).T)
    lower = quaternion.from_matrix(_axes(to_ankle, axis) @ _axes(shin, np.eye(3)[_RIGHT]).T)
    sole = quaternion.multiply(quaternion.about_axis(_UP, foot[:, 3]), quaternion.about_axis(_RIGHT, foot[:, 4]))
    turns = [
        quaternion.multiply(quaternion.conjugate(turned), upper),
        quaternion.multiply(quaternion.conjugate(upper), lower),
        quaternion.multiply(quaternion.conjugate(lower), sole),
        quaternion.about_axis(_RIGHT, foot[:, 5]),
    ]
    for bone, turn in zip(bones, turns, strict=True):
        if skeleton.has(bone):
            out[:, skeleton.index(bone)] = turn


def _bent(target: Floats, thigh: np.floating, shin: np.floating, hint: Floats) -> tuple[Floats, Floats, Floats]:
    """Hip to knee, knee to ankle, and the knee's axis, all (N, 3), for ankles at `target` (N, 3) from the hip."""
    distance = np.linalg.norm(target, axis=-1)
    direction = target / distance[:, None]
    axis = _unit(hint - np.sum(hint * direction, axis=-1, keepdims=True) * direction)
    near = np.maximum(distance, abs(thigh - shin) + 0.05 * thigh)
    soft = _SOFT * (thigh + shin)
    edge = thigh + shin - soft
    reach = np.where(near <= edge, near, edge + soft * -np.expm1(-np.maximum(near - edge, 0.0) / soft))
    along = (thigh**2 + reach**2 - shin**2) / (2.0 * reach)
    aside = np.sqrt(np.maximum(thigh**2 - along**2, 0.0))
    to_knee = along[:, None] * direction + aside[:, None] * np.cross(direction, axis)
    return to_knee, reach[:, None] * direction - to_knee, axis


def _matrices(turns: Floats) -> Floats:
    """The matrices (..., 3, 3) of unit quaternions (..., 4)."""
    x, y, z, w = np.moveaxis(turns, -1, 0)
    matrices = np.empty((*turns.shape[:-1], 3, 3))
    matrices[..., 0, 0], matrices[..., 1, 1] = 1.0 - 2.0 * (y * y + z * z), 1.0 - 2.0 * (x * x + z * z)
    matrices[..., 2, 2] = 1.0 - 2.0 * (x * x + y * y)
    matrices[..., 0, 1], matrices[..., 1, 0] = 2.0 * (x * y - z * w), 2.0 * (x * y + z * w)
    matrices[..., 0, 2], matrices[..., 2, 0] = 2.0 * (x * z + y * w), 2.0 * (x * z - y * w)
    matrices[..., 1, 2], matrices[..., 2, 1] = 2.0 * (y * z - x * w), 2.0 * (y * z + x * w)
    return matrices


def _axes(bone: Floats, hint: Floats) -> Floats:
    """Orthonormal columns (..., 3, 3): along the bone, the part of `hint` across it, and their cross product."""
    along = _unit(bone)
    across = _unit(hint - np.sum(hint * along, axis=-1, keepdims=True) * along)
    return np.stack([along, across, np.cross(along, across)], axis=-1)


def _unit(vector: Floats) -> Floats:
    unit: Floats = vector / np.linalg.norm(vector, axis=-1, keepdims=True)
    return unit
