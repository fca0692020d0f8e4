"""Forward kinematics: where a configuration and a root state put the joints and the collision body.

A posture is `q` (DOF,), a root state (7,), or one with feet and carriage (`root`); places are metres, Y up. The root
frame has its origin on the ground and +Z along the heading; the pelvis frame has the same axes, and its origin is the
hips joint as the stride has it, before the waist or a foot lowers it; the chest frame is that of the last spine joint.
Capsule arrays have shape (C, 6, N): end points ax, ay, az, bx, by, bz.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body.capsules import Capsules
from elbowroom.body.dof import ARMS, DOF, LOCAL_GROUPS, DofGroup, Turning, followers_of
from elbowroom.body.gait.cycle import GaitShape, foot_poses, gait_shape
from elbowroom.body.gait.legs import leg_rest
from elbowroom.body.gait.lowered_hips import hips_sinks
from elbowroom.body.gait.posed_feet import posed_feet
from elbowroom.body.gait.rises import raise_feet
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.made_once import made_once
from elbowroom.body.pose.chain_posing import pose_chain
from elbowroom.body.pose.hands import relaxed_rotations
from elbowroom.body.pose.joint_tree import (
    Arm,
    CapsuleChain,
    Chain,
    JointTree,
    SpineColumn,
    arms_together,
    columns_together,
)
from elbowroom.body.pose.pelvis import place_pelvis
from elbowroom.body.pose.whole_body import PosedBy, WholeBody, posed_capsules, posed_joints, posed_legs, whole_body
from elbowroom.body.root import ROOT_STATE
from elbowroom.body.skeleton import Skeleton

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Segments = NDArray[np.float32]

_SIDES = ("left", "right")
_LEG_BONES = ("UpperLeg", "LowerLeg", "Foot", "Toes")


class CapsuleSet(NamedTuple):
    """The capsules of one group, or of the whole body, and the joints that carry them."""

    indices: Indices  # (C,) into the humanoid's capsules
    radii: NDArray[np.float32]  # (C,) metres
    posed: CapsuleChain

    @property
    def joints(self) -> Indices:
        """The joint that carries each capsule, (C,)."""
        return self.posed.joints


class BodyModel(NamedTuple):
    """All that kinematics needs of a humanoid, as arrays; made once by `body_model`."""

    tree: JointTree  # its joints, and what turns them
    leg_rest: Floats  # (2, 9) see `legs.leg_rest`
    gait: GaitShape
    body: CapsuleSet  # every capsule, in the humanoid's order
    whole: WholeBody  # all of that, for kernels
    lower: WholeBody  # the same with the capsules of pelvis and legs alone
    groups: dict[DofGroup, CapsuleSet]
    chains: dict[DofGroup, Chain]  # of the local groups
    trunk: tuple[Chain, CapsuleSet]  # the waist with all that follows it

    @property
    def parents(self) -> Indices:
        """The parent (J,) of each joint."""
        return self.tree.parents

    @property
    def offsets(self) -> Floats:
        """Each joint's place (J, 3) from its parent in T-pose; for the hips their place in the root frame."""
        return self.tree.offsets

    @property
    def base(self) -> Floats:
        """Local rotations (J, 4) of the joints that do not move: relaxed fingers, else identity."""
        return self.tree.base

    @property
    def roots(self) -> CapsuleSet:
        """The capsules of pelvis and legs."""
        return self.groups[DofGroup.ROOT]

    def capsules_of(self, group: DofGroup) -> CapsuleSet:
        """The capsules of a group."""
        return self.groups[group]


@made_once
def body_model(humanoid: Humanoid) -> BodyModel:
    """Measure a humanoid."""
    skeleton, capsules = humanoid.skeleton, humanoid.capsules
    parents = np.ascontiguousarray(skeleton.parents, np.int64)
    rest = np.ascontiguousarray(skeleton.positions, np.float64)
    gait = gait_shape(skeleton, humanoid.soles)
    tree = JointTree(
        base=relaxed_rotations(skeleton),
        parents=parents,
        offsets=rest - np.where(parents[:, None] >= 0, rest[parents], 0.0),
        columns=columns_together([_column(skeleton, group) for group in LOCAL_GROUPS if _is_column(group)]),
        arms=arms_together([_arm(skeleton, group) for group in ARMS]),
        legs=np.array([_joints(skeleton, [side + bone for bone in _LEG_BONES]) for side in _SIDES]),
        chest=_end(skeleton, DofGroup.WAIST),
    )
    chains = {group: _chain(skeleton, capsules, tree, group, gait.half_leg) for group in LOCAL_GROUPS}
    legs, every, rest_of_legs = capsules.of(DofGroup.ROOT), np.arange(len(capsules.names)), leg_rest(skeleton)
    roots, body = (_capsule_set(capsules, own, _posed(skeleton, capsules, own, 0)) for own in (legs, every))
    sets = {group: _set_of_chain(capsules, capsules.of(group), chain) for group, chain in chains.items()}
    trunk = np.sort(np.concatenate([capsules.of(g) for g in (DofGroup.WAIST, *followers_of(DofGroup.WAIST))]))
    column = _following_column(skeleton, DofGroup.WAIST)
    whole = _chain_of(skeleton, capsules, tree, DofGroup.WAIST, gait.half_leg, trunk, column)
    by = PosedBy(tree, body.posed, rest_of_legs, gait.legs, gait.scale, gait.half_leg)
    return BodyModel(
        tree=tree,
        leg_rest=rest_of_legs,
        gait=gait,
        body=body,
        whole=whole_body(by),
        lower=whole_body(by._replace(capsules=roots.posed)),
        groups={DofGroup.ROOT: roots} | sets,
        chains=chains,
        trunk=(whole, _set_of_chain(capsules, trunk, whole)),
    )


def _is_column(group: DofGroup) -> bool:
    return group.value.turning is Turning.COLUMN


def _joints(skeleton: Skeleton, bones: Sequence[str]) -> Indices:
    return np.array([skeleton.index(bone) if skeleton.has(bone) else -1 for bone in bones], np.int64)


def _end(skeleton: Skeleton, group: DofGroup) -> int:
    """The last joint that a group turns, of those that the skeleton has."""
    return next(skeleton.index(bone) for bone in reversed(group.value.bones) if skeleton.has(bone))


def _column(skeleton: Skeleton, group: DofGroup) -> SpineColumn:
    spec = group.value
    present = [(bone, share) for bone, share in zip(spec.bones, spec.shares, strict=True) if skeleton.has(bone)]
    shares = np.array([share for _, share in present])
    return SpineColumn(_joints(skeleton, [bone for bone, _ in present]), shares / shares.sum(), group.at.start)


def _following_column(skeleton: Skeleton, group: DofGroup) -> SpineColumn:
    """A column with the joints of the groups that follow it: they turn back by equal parts."""
    column = _column(skeleton, group)
    joints, shares = [column.joints], [column.shares]
    for other in followers_of(group):
        present = [bone for bone in other.value.bones if skeleton.has(bone)]
        joints.append(_joints(skeleton, present))
        shares.append(np.full(len(present), -other.value.undoes / len(present)))
    return SpineColumn(np.concatenate(joints), np.concatenate(shares), column.first)


def _arm(skeleton: Skeleton, group: DofGroup) -> Arm:
    mirror = -1.0 if group.label.startswith("right") else 1.0
    return Arm(_joints(skeleton, group.value.bones), mirror, group.at.start)


def _chain(skeleton: Skeleton, capsules: Capsules, tree: JointTree, group: DofGroup, half_leg: float) -> Chain:
    """The joints of a local group, down to the one that its children hang on."""
    column = _column(skeleton, DofGroup.WAIST if group.is_arm else group)
    return _chain_of(skeleton, capsules, tree, group, half_leg, capsules.of(group), column)


def _chain_of(
    skeleton: Skeleton,
    capsules: Capsules,
    tree: JointTree,
    group: DofGroup,
    half_leg: float,
    indices: Indices,
    column: SpineColumn,
) -> Chain:
    """The joints that a column or an arm turns, and those that carry the capsules at `indices`."""
    assert group.parent is not None
    start, end = _end(skeleton, group.parent), _end(skeleton, group)
    carries = any(other.parent is group for other in DofGroup)
    posed = _posed(skeleton, capsules, indices, start, [end] if carries else [])
    arm = _arm(skeleton, group if group.is_arm else ARMS[0])
    return Chain(
        tree.base, tree.parents, tree.offsets, posed.order, posed.joints, posed.ends,
        start, end, carries, group.is_arm, column, arm, half_leg, -tree.offsets[tree.legs[:, 0]].mean(axis=0)[1:],
    )  # fmt: skip


def _posed(
    skeleton: Skeleton, capsules: Capsules, indices: Indices, start: int, also: Sequence[int] = ()
) -> CapsuleChain:
    """The capsules at `indices` and the joints between joint `start` and them (and those in `also`)."""
    joints = capsules.joints[indices]
    needed: set[int] = set()
    for joint in [*joints, *also]:
        at = int(joint)
        while at not in (start, -1):
            needed.add(at)
            at = int(skeleton.parents[at])
    ends = np.concatenate([capsules.starts[indices], capsules.ends[indices]], axis=1)
    return CapsuleChain(
        np.array(sorted(needed), np.int64),
        np.ascontiguousarray(joints, np.int64),
        np.ascontiguousarray(ends, np.float64),
    )


def _set_of_chain(capsules: Capsules, indices: Indices, chain: Chain) -> CapsuleSet:
    return _capsule_set(capsules, indices, CapsuleChain(chain.order, chain.joints, chain.ends))


def _capsule_set(capsules: Capsules, indices: Indices, posed: CapsuleChain) -> CapsuleSet:
    return CapsuleSet(np.asarray(indices, np.int64), capsules.radii[indices].astype(np.float32), posed)


def _rows(values: ArrayLike, size: int) -> Floats:
    """`values` as a contiguous float64 array (N, size); a single row is taken as N = 1."""
    array = np.ascontiguousarray(values, np.float64)
    return array.reshape(-1, size) if array.ndim != 2 else array


def _states(values: ArrayLike) -> Floats:
    """Root states as rows: of ROOT_STATE numbers, of those before the height, WITH_FEET or SHOWN."""
    array = np.ascontiguousarray(values, np.float64)
    return array[None] if array.ndim == 1 else array.reshape(-1, array.shape[-1])


def lower_body(gait: GaitShape, states: Floats, lowerings: Floats) -> tuple[Floats, Floats]:
    """Feet (N, 2, 6) as in `gait.foot_poses`, and sinks of the hips (N, 3) as in `gait.hips_sinks`.

    The feet are those of the states (N, WITH_FEET or more), or of the walking cycle where these have none (N, 7).
    """
    if states.shape[1] > ROOT_STATE:
        return posed_feet(gait.legs, gait.scale, gait.half_leg, states, lowerings)
    feet, drops = foot_poses(gait.legs, gait.scale, states)
    raise_feet(gait.legs, states, feet, drops)
    return feet, hips_sinks(gait.half_leg, drops, lowerings)


def joint_pose(model: BodyModel, q: ArrayLike, root: ArrayLike) -> tuple[Floats, Floats]:
    """Normalised local rotations (J, 4) of every joint, and the hips joint (3,) in the root frame.

    For `q` (DOF,) and a root state (7,). The hips' own rotation is in the root's axes: the root's heading turns the
    whole body. Their place is where T-pose has it, less what gait and lowering take, and as it is carried.
    """
    return posed_joints(model.whole, np.ascontiguousarray(q, np.float64), np.ascontiguousarray(root, np.float64))


def local_rotations(model: BodyModel, q: ArrayLike, root: ArrayLike) -> Floats:
    """The rotations (J, 4) of `joint_pose`."""
    return joint_pose(model, q, root)[0]


def hips_position(model: BodyModel, q: ArrayLike, root: ArrayLike) -> Floats:
    """The hips joint (3,) of `joint_pose`."""
    return joint_pose(model, q, root)[1]


def posture_capsules(model: BodyModel, q: ArrayLike, roots: ArrayLike) -> Segments:
    """All capsules (C, 6, N) in the world for postures (N, DOF) and root states (N, 7).

    The first three components of `q` are ignored: the root states say where the body stands.
    """
    states, postures = _states(roots), _rows(q, DOF)
    return posed_capsules(model.whole, postures, states)


def leg_capsules(model: BodyModel, roots: ArrayLike, lowerings: ArrayLike = 0.0) -> Segments:
    """The capsules of the group ROOT (C, 6, N) in the world for root states (N, 7) and lowerings, one or (N,)."""
    states = _states(roots)
    return posed_legs(model.lower, states, np.full(len(states), lowerings, np.float64))


def group_capsules(model: BodyModel, group: DofGroup, configurations: ArrayLike) -> Segments:
    """A local group's capsules (C, 6, N) for its configurations (N, d), in the frame that carries it.

    That is the pelvis frame for the waist, the chest frame for the groups that hang on the waist.
    """
    return pose_chain(model.chains[group], _rows(configurations, group.size))[0]


def chest_frames(model: BodyModel, waist: ArrayLike) -> tuple[Floats, Floats]:
    """Positions (N, 3) and rotations (N, 4) of the last spine joint in the pelvis frame for waists (N, 3)."""
    group = DofGroup.WAIST
    _, positions, rotations = pose_chain(model.chains[group], _rows(waist, group.size))
    return positions, rotations


def pelvis_frames(model: BodyModel, roots: ArrayLike) -> tuple[Floats, Floats]:
    """Positions (N, 3) and rotations (N, 4) of the pelvis frame in the world for root states (N, 7)."""
    states = _states(roots)
    _, drops = foot_poses(model.gait.legs, model.gait.scale, states)
    return place_pelvis(model.offsets[0], states, np.stack([drops, np.zeros(len(drops))], axis=1))
