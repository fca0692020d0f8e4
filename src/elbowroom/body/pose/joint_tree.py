"""The joints of a body as kernels see them: in one tree, in the chain of each group, and under capsules."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]


class SpineColumn(NamedTuple):
    """A row of joints of the trunk, or of neck and head, that share the rotation Ry(twist) Rx(bend)."""

    joints: Indices  # (S,)
    shares: Floats  # (S,) of its rotation vector that each takes; negative: it turns back
    first: int  # the place of the bend in a configuration `q`; the twist is the next


class Arm(NamedTuple):
    """A shoulder and an elbow."""

    joints: Indices  # (3,) upper arm, forearm, hand
    mirror: float  # +1 left, -1 right
    first: int  # the place of the flexion in a configuration `q`


@by_reference
class Chain(NamedTuple):
    """The joints of one group and the capsules on them, beginning at the joint that the group hangs on."""

    base: Floats  # (J, 4) rotations of all joints in T-pose
    parents: Indices  # (J,)
    offsets: Floats  # (J, 3) metres
    order: Indices  # the joints to pose, parents first, without the one that it begins at
    joints: Indices  # (C,) joints that carry its capsules
    ends: Floats  # (C, 6) capsule end points in their joints' frames
    start: int  # the joint that it hangs on
    end: int  # the joint that others hang on
    carries: bool  # whether any do
    is_arm: bool  # whether `arm` turns it; else `column` does
    column: SpineColumn
    arm: Arm
    half_leg: float  # metres, the unit of a lowering
    hinge: Floats  # (2,) metres that the hips joint is above and ahead of the middle between those of the legs


class SpineColumns(NamedTuple):
    """K columns one after the other."""

    joints: Indices  # (S,) as in `SpineColumn`
    shares: Floats  # (S,)
    begins: Indices  # (K + 1,) where the joints of each begin
    first: Indices  # (K,)


class Arms(NamedTuple):
    """A arms."""

    joints: Indices  # (A, 3) as in `Arm`
    mirrors: Floats  # (A,)
    first: Indices  # (A,)


class JointTree(NamedTuple):
    """All joints of a body, and what turns them."""

    base: Floats  # as in `Chain`
    parents: Indices
    offsets: Floats
    columns: SpineColumns
    arms: Arms
    legs: Indices  # (2, 4) thigh, shin, foot, toes; -1 where absent
    chest: int  # the joint that head and arms hang on


class CapsuleChain(NamedTuple):
    """Capsules of a body and the joints between the hips and them."""

    order: Indices  # the joints to pose, parents first, without the hips
    joints: Indices  # (C,)
    ends: Floats  # (C, 6)


def columns_together(columns: Sequence[SpineColumn]) -> SpineColumns:
    """These columns as arrays."""
    begins = np.cumsum([0, *(len(column.joints) for column in columns)])
    joints, shares, first = zip(*columns, strict=True)
    return SpineColumns(
        np.concatenate(joints), np.concatenate(shares), begins.astype(np.int64), np.array(first, np.int64)
    )


def arms_together(arms: Sequence[Arm]) -> Arms:
    """These arms as arrays."""
    joints, mirrors, first = zip(*arms, strict=True)
    return Arms(np.array(joints, np.int64), np.array(mirrors, np.float64), np.array(first, np.int64))
