"""Forward kinematics: where a configuration and a root state put the joints and the collision body.

A posture is `q` (14,), a root state (7,); places are metres, Y up. The root frame has its origin on the ground and +Z
along the heading; the pelvis frame has the same axes, and its origin is the hips joint as the stride has it, before the
waist lowers it; the chest frame is that of the last spine joint. Capsule arrays have shape (C, 6, N): end points ax,
ay, az, bx, by, bz.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body import posing
from elbowroom.body.capsules import Capsules
from elbowroom.body.dof import ARMS, DOF, LOWERING, DofGroup
from elbowroom.body.gait import GaitShape, foot_poses, gait_shape, hips_sinks
from elbowroom.body.hands import relaxed_rotations
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.legs import leg_rest, leg_rotations
from elbowroom.body.root import ROOT_STATE
from elbowroom.body.skeleton import Skeleton

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Segments = NDArray[np.float32]

_SPINE_WEIGHTS = {"spine": 0.40, "chest": 0.35, "upperChest": 0.25}
_GAZE = 0.65  # the part of the waist's rotation that neck and head undo
_SIDES = ("left", "right")
_LEG_BONES = ("UpperLeg", "LowerLeg", "Foot", "Toes")


class CapsuleSet(NamedTuple):
    """The capsules of one group and the chain of joints that carries them."""

    indices: Indices  # (C,) into the humanoid's capsules
    joints: Indices  # (C,)
    ends: Floats  # (C, 6) both end points in the joint's frame
    radii: NDArray[np.float32]  # (C,) metres
    order: Indices  # joints to pose, parents first, without the frame they start from


class BodyModel(NamedTuple):
    """All that kinematics needs of a humanoid, as arrays; made once by `body_model`."""

    parents: Indices  # (J,)
    offsets: Floats  # (J, 3) from the parent joint in T-pose; for the hips their place in the root frame
    base: Floats  # (J, 4) local rotations of the joints that do not move: relaxed fingers, else identity
    spine: Indices  # (S,) present spine joints, the last one carries the chest frame
    spine_weights: Floats  # (S,) parts of the waist's rotation, sum 1
    gaze: Indices  # (G,) neck if present, head
    gaze_weights: Floats  # (G,) negative: they turn back
    arms: Indices  # (2, 3) upper arm, forearm, hand; left first
    legs: Indices  # (2, 4) thigh, shin, foot, toes; -1 where absent
    leg_rest: Floats  # (2, 9) see `legs.leg_rest`
    gait: GaitShape
    body: CapsuleSet  # every capsule, in the humanoid's order
    groups: dict[DofGroup, CapsuleSet]  # those of each group, its chain begins at the joint that it hangs on

    @property
    def roots(self) -> CapsuleSet:
        """The capsules of pelvis and legs."""
        return self.groups[DofGroup.ROOT]

    def capsules_of(self, group: DofGroup) -> CapsuleSet:
        """The capsules of a group."""
        return self.groups[group]


def body_model(humanoid: Humanoid) -> BodyModel:
    """Measure a humanoid. The model belongs to this object: keep it beside the humanoid."""
    skeleton, capsules = humanoid.skeleton, humanoid.capsules
    spine = _bones(skeleton, DofGroup.WAIST)
    gaze = [bone for bone in DofGroup.WAIST.value.turned_back if skeleton.has(bone)]
    weights = np.array([_SPINE_WEIGHTS[bone] for bone in spine])
    parents = np.ascontiguousarray(skeleton.parents, np.int64)
    rest = np.ascontiguousarray(skeleton.positions, np.float64)
    every = np.arange(len(capsules.names))
    return BodyModel(
        parents=parents,
        offsets=rest - np.where(parents[:, None] >= 0, rest[parents], 0.0),
        base=relaxed_rotations(skeleton),
        spine=_joints(skeleton, spine),
        spine_weights=weights / weights.sum(),
        gaze=_joints(skeleton, gaze),
        gaze_weights=np.full(len(gaze), -_GAZE / len(gaze)),
        arms=np.array([_joints(skeleton, list(arm.value.bones)) for arm in ARMS]),
        legs=np.array([_joints(skeleton, [side + bone for bone in _LEG_BONES]) for side in _SIDES]),
        leg_rest=leg_rest(skeleton),
        gait=gait_shape(skeleton),
        body=_capsule_set(skeleton, capsules, every, 0),
        groups={group: _group_capsules(skeleton, capsules, group) for group in DofGroup},
    )


def _joints(skeleton: Skeleton, bones: list[str]) -> Indices:
    return np.array([skeleton.index(bone) if skeleton.has(bone) else -1 for bone in bones], np.int64)


def _bones(skeleton: Skeleton, group: DofGroup) -> list[str]:
    """The joints that a group turns, as far as the skeleton has them."""
    return [bone for bone in group.value.bones if skeleton.has(bone)]


def _group_capsules(skeleton: Skeleton, capsules: Capsules, group: DofGroup) -> CapsuleSet:
    """The capsules of a group, and its chain down to the joint that its children hang on."""
    start = 0 if group.parent is None else skeleton.index(_bones(skeleton, group.parent)[-1])
    end = skeleton.index(_bones(skeleton, group)[-1])
    carries = any(other.parent is group for other in DofGroup)
    return _capsule_set(skeleton, capsules, capsules.of(group), start, [end] if carries else None)


def _capsule_set(
    skeleton: Skeleton, capsules: Capsules, indices: Indices, start: int, also: list[int] | None = None
) -> CapsuleSet:
    """The capsules at `indices` and the joints between joint `start` and them (and those in `also`)."""
    joints = capsules.joints[indices]
    needed: set[int] = set()
    for joint in [*joints, *(also or [])]:
        at = int(joint)
        while at not in (start, -1):
            needed.add(at)
            at = int(skeleton.parents[at])
    ends = np.concatenate([capsules.starts[indices], capsules.ends[indices]], axis=1)
    return CapsuleSet(
        indices=np.asarray(indices, np.int64),
        joints=np.ascontiguousarray(joints, np.int64),
        ends=np.ascontiguousarray(ends, np.float64),
        radii=capsules.radii[indices].astype(np.float32),
        order=np.array(sorted(needed), np.int64),
    )


def _rows(values: ArrayLike, size: int) -> Floats:
    """`values` as a contiguous float64 array (N, size); a single row is taken as N = 1."""
    array = np.ascontiguousarray(values, np.float64)
    return array.reshape(-1, size) if array.ndim != 2 else array


def _lower_body(model: BodyModel, states: Floats, lowerings: Floats) -> tuple[Floats, Floats]:
    """Rotations of the legs' joints (N, 2, 4, 4) and sinks of the hips (N, 2), see `gait.hips_sinks`."""
    feet, drops = foot_poses(model.gait.legs, model.gait.scale, states)
    sinks = hips_sinks(model.gait.half_leg, drops, np.ascontiguousarray(lowerings))
    return leg_rotations(model.leg_rest, feet, sinks), sinks


def local_rotations(model: BodyModel, q: ArrayLike, root: ArrayLike) -> Floats:
    """Normalised local rotations (J, 4) of every joint for `q` (14,) and a root state (7,).

    The hips' rotation is the identity: the root's heading turns the whole body.
    """
    m, posture = model, np.ascontiguousarray(q, np.float64)
    legs = _lower_body(m, _rows(root, ROOT_STATE), posture[LOWERING : LOWERING + 1])[0][0]
    return posing.pose_local(m.base, m.spine, m.spine_weights, m.gaze, m.gaze_weights, m.arms, m.legs, posture, legs)


def hips_position(model: BodyModel, q: ArrayLike, root: ArrayLike) -> Floats:
    """The hips joint (3,) in the root frame for `q` (14,) and a root state (7,).

    It is where T-pose has it, less what the gait and the waist's lowering take.
    """
    lowering = np.ascontiguousarray(q, np.float64)[LOWERING : LOWERING + 1]
    _, sinks = _lower_body(model, _rows(root, ROOT_STATE), lowering)
    position: Floats = model.offsets[0] - np.array([0.0, sinks[0, 0], sinks[0, 1]])
    return position


def posture_capsules(model: BodyModel, q: ArrayLike, roots: ArrayLike) -> Segments:
    """All capsules (C, 6, N) in the world for postures (N, 14) and root states (N, 7).

    The first three components of `q` are ignored: the root states say where the body stands.
    """
    m, c, states, postures = model, model.body, _rows(roots, ROOT_STATE), _rows(q, DOF)
    legs, sinks = _lower_body(m, states, postures[:, LOWERING])
    return posing.pose_body(
        m.base, m.parents, m.offsets, c.order, m.spine, m.spine_weights, m.gaze, m.gaze_weights, m.arms, m.legs,
        c.joints, c.ends, postures, states, legs, sinks,
    )[0]  # fmt: skip


def leg_capsules(model: BodyModel, roots: ArrayLike, lowerings: ArrayLike = 0.0) -> Segments:
    """The capsules of the group ROOT (C, 6, N) in the world for root states (N, 7) and lowerings, one or (N,)."""
    m, c, states = model, model.roots, _rows(roots, ROOT_STATE)
    legs, sinks = _lower_body(m, states, np.full(len(states), lowerings, np.float64))
    return posing.pose_legs(m.base, m.parents, m.offsets, c.order, m.legs, c.joints, c.ends, states, legs, sinks)


def _trunk(model: BodyModel, waist: ArrayLike) -> tuple[Segments, Floats, Floats]:
    m, c = model, model.capsules_of(DofGroup.WAIST)
    return posing.pose_trunk(
        m.base, m.parents, m.offsets, c.order, m.spine, m.spine_weights, m.gaze, m.gaze_weights,
        c.joints, c.ends, m.gait.half_leg, _rows(waist, DofGroup.WAIST.size),
    )  # fmt: skip


def trunk_capsules(model: BodyModel, waist: ArrayLike) -> Segments:
    """The capsules of the group WAIST (C, 6, N) in the pelvis frame for waist configurations (N, 3)."""
    return _trunk(model, waist)[0]


def chest_frames(model: BodyModel, waist: ArrayLike) -> tuple[Floats, Floats]:
    """Positions (N, 3) and rotations (N, 4) of the last spine joint in the pelvis frame for waists (N, 3)."""
    _, positions, rotations = _trunk(model, waist)
    return positions, rotations


def arm_capsules(model: BodyModel, group: DofGroup, arm: ArrayLike) -> Segments:
    """An arm's capsules (3, 6, N) in the chest frame for arm configurations (N, 4)."""
    if not group.is_arm:
        raise ValueError(f"{group.name} is not an arm")
    m, c, side = model, model.capsules_of(group), ARMS.index(group)
    return posing.pose_arm(
        m.base, m.parents, m.offsets, c.order, int(m.spine[-1]), m.arms[side], 1.0 - 2.0 * side,
        c.joints, c.ends, _rows(arm, group.size),
    )  # fmt: skip


def pelvis_frames(model: BodyModel, roots: ArrayLike) -> tuple[Floats, Floats]:
    """Positions (N, 3) and rotations (N, 4) of the pelvis frame in the world for root states (N, 7)."""
    states = _rows(roots, ROOT_STATE)
    _, drops = foot_poses(model.gait.legs, model.gait.scale, states)
    return posing.place_pelvis(model.offsets[0], states, np.stack([drops, np.zeros(len(drops))], axis=1))
