"""The whole posed body for kernels, in one piece.

A kernel takes its arguments apart before it begins, array by array, and that takes longer than to pose a body: so all
that posing needs lies in few arrays, one part after the other.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOWERING
from elbowroom.body.gait.cycle import foot_poses
from elbowroom.body.gait.legs import leg_rotations
from elbowroom.body.gait.lowered_hips import hips_sinks
from elbowroom.body.gait.posed_feet import posed_feet
from elbowroom.body.gait.rises import raise_feet
from elbowroom.body.pose.joint_tree import Arms, CapsuleChain, JointTree, SpineColumns
from elbowroom.body.pose.posing import hips_shift, pose_body, pose_legs, pose_local
from elbowroom.body.root import ROOT_STATE
from elbowroom.jit import brief_exact_kernel, exact_kernel, helper, inner_exact_kernel

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Segments = NDArray[np.float32]

_PARTS = 8  # cuts of the numbers: so many come before those of the places


class PosedBy(NamedTuple):
    """What posing every capsule needs of a `BodyModel`, under the names that these things have there."""

    tree: JointTree
    capsules: CapsuleChain
    leg_rest: Floats
    gait_legs: Floats
    scale: float
    half_leg: float


class WholeBody(NamedTuple):
    """The same in arrays: for `posed_body` and `posed_capsules`."""

    numbers: Floats
    places: Indices
    cuts: Indices  # where each part begins and the last one ends: of the numbers, then of the places
    gait_legs: Floats
    scale: float


def whole_body(by: PosedBy) -> WholeBody:
    """The same for kernels, in the order in which `taken_apart` takes it."""
    tree, capsules, columns, arms = by.tree, by.capsules, by.tree.columns, by.tree.arms
    numbers = [
        tree.base, tree.offsets, columns.shares, arms.mirrors, capsules.ends, by.leg_rest, np.array([by.half_leg]),
    ]  # fmt: skip
    places = [
        tree.parents, columns.joints, columns.begins, columns.first, arms.joints, arms.first, tree.legs,
        np.array([tree.chest]), capsules.order, capsules.joints,
    ]  # fmt: skip
    cuts = [np.cumsum([0, *(part.size for part in parts)]) for parts in (numbers, places)]
    return WholeBody(
        np.concatenate([part.ravel() for part in numbers]),
        np.concatenate([part.ravel() for part in places]),
        np.concatenate(cuts).astype(np.int64),
        by.gait_legs,
        by.scale,
    )


@helper
def _numbers(body: WholeBody, part: int) -> Floats:
    return body.numbers[body.cuts[part] : body.cuts[part + 1]]


@helper
def _places(body: WholeBody, part: int) -> Indices:
    return body.places[body.cuts[_PARTS + part] : body.cuts[_PARTS + part + 1]]


@helper
def taken_apart(body: WholeBody) -> PosedBy:
    """The parts that were put together by `whole_body`."""
    base, offsets, ends, rest = _numbers(body, 0), _numbers(body, 1), _numbers(body, 4), _numbers(body, 5)
    arms, legs = _places(body, 4), _places(body, 6)
    tree = JointTree(
        base.reshape((len(base) // 4, 4)),
        _places(body, 0),
        offsets.reshape((len(offsets) // 3, 3)),
        SpineColumns(_places(body, 1), _numbers(body, 2), _places(body, 2), _places(body, 3)),
        Arms(arms.reshape((len(arms) // 3, 3)), _numbers(body, 3), _places(body, 5)),
        legs.reshape((2, len(legs) // 2)),
        _places(body, 7)[0],
    )
    capsules = CapsuleChain(_places(body, 8), _places(body, 9), ends.reshape((len(ends) // 6, 6)))
    return PosedBy(tree, capsules, rest.reshape((2, len(rest) // 2)), body.gait_legs, body.scale, _numbers(body, 6)[0])


@helper
def _lower_body(by: PosedBy, roots: Floats, lowerings: Floats) -> tuple[Floats, Floats]:
    """Local rotations (N, 2, 4, 4) of the legs' joints, and sinks (N, 3) of the hips."""
    if roots.shape[1] > ROOT_STATE:
        feet, sinks = posed_feet(by.gait_legs, by.scale, by.half_leg, roots, lowerings)
    else:
        feet, drops = foot_poses(by.gait_legs, by.scale, roots)
        raise_feet(by.gait_legs, roots, feet, drops)
        sinks = hips_sinks(by.half_leg, drops, lowerings)
    return leg_rotations(by.leg_rest, feet, sinks, roots), sinks


@brief_exact_kernel
def posed_joints(body: WholeBody, q: Floats, root: Floats) -> tuple[Floats, Floats]:
    """Normalised local rotations (J, 4) of every joint, and the hips joint (3,) in the root's frame.

    For a posture (DOF,) and a root state (7 or more,).
    """
    by, rows = taken_apart(body), root.reshape((1, len(root)))
    legs, sinks = _lower_body(by, rows, q[LOWERING : LOWERING + 1].copy())
    x, y, z = hips_shift(by.tree, root, sinks[0, 2])
    rest = by.tree.offsets[0]
    hips = np.array([rest[0] + x, rest[1] + y - sinks[0, 0], rest[2] + z - sinks[0, 1]])
    return pose_local(by.tree, q, legs[0], root, sinks[0, 2]), hips


@inner_exact_kernel
def posed_body(body: WholeBody, q: Floats, roots: Floats) -> tuple[Segments, Floats, Floats]:
    """All capsules (C, 6, N) for postures (N, DOF) and root states (N, 7), or longer ones, in the world.

    And the chest frames: places (N, 3) and rotations (N, 4) of the last spine joint.
    """
    by = taken_apart(body)
    legs, sinks = _lower_body(by, roots, q[:, LOWERING].copy())
    return pose_body(by.tree, by.capsules, q, roots, legs, sinks)


@exact_kernel
def posed_capsules(body: WholeBody, q: Floats, roots: Floats) -> Segments:
    """The capsules of `posed_body` alone."""
    return posed_body(body, q, roots)[0]


@exact_kernel
def posed_legs(body: WholeBody, roots: Floats, lowerings: Floats) -> Segments:
    """Capsules (C, 6, N) that pelvis and legs carry, of a body that has no others, in the world.

    For root states (N, 7 or more) and lowerings (N,).
    """
    by = taken_apart(body)
    legs, sinks = _lower_body(by, roots, lowerings)
    return pose_legs(by.tree, by.capsules, roots, legs, sinks)
