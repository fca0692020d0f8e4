"""Posing the joints of one group and its capsules, in the frame that carries it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.carriage import about_left, leant_by
from elbowroom.body.gait.lowered_hips import hips_sink
from elbowroom.body.pose.frames import frames_along, place_frame, segments_into, set_turn
from elbowroom.body.pose.joint_tree import Chain
from elbowroom.body.pose.turned_joints import set_arm, set_column
from elbowroom.jit import helper, inner_kernel, kernel, plain

Floats = NDArray[np.float64]
Segments = NDArray[np.float32]

_FIRST = plain(0)  # place in a row of capsules


class PoseScratch(NamedTuple):
    """What the posing of one chain of joints works on."""

    local: Floats  # (J, 4) rotations in the parents' frames, those in T-pose where a chain moves nothing
    rotations: Floats  # (J, 4)
    places: Floats  # (J, 3)
    scratch: Floats  # (2, 4)
    row: Floats  # (1, 6)


@inner_kernel
def pose_scratch(chain: Chain) -> PoseScratch:
    """What `pose_chain_into` works on."""
    return PoseScratch(
        chain.base.copy(),
        np.empty(chain.base.shape),
        np.empty(chain.offsets.shape),
        np.empty((2, 4)),
        np.empty((1, 6)),
    )


@helper
def _sink(chain: Chain, lowering: float, rotations: Floats, places: Floats) -> None:
    """Put the hips, at which a chain begins, where a lowering has them in the pelvis frame."""
    below, behind, lean = hips_sink(chain.half_leg, 0.0, lowering)
    rises, goes = leant_by(lean, chain.hinge[0], chain.hinge[1])
    place_frame(chain.start, rotations, places, 0.0, rises - below, goes - behind, 0.0)
    set_turn(rotations, chain.start, about_left(lean))


@inner_kernel
def pose_chain_into(
    chain: Chain,
    configurations: Floats,
    count: int,
    scratch: PoseScratch,
    first: int,
    out: Segments,
    places: Floats,
    turns: Floats,
) -> None:
    """`pose_chain` for the first `count` configurations (N, d), written to `out` (C, 6, M) from place `first` on.

    If others hang on the chain their frames are written to the first rows of `places` (N, 3) and `turns` (N, 4).
    Where `out` has no rows no capsules are posed.
    """
    place_frame(chain.start, scratch.rotations, scratch.places, 0.0, 0.0, 0.0, 0.0)
    for n in range(count):
        if chain.is_arm:
            set_arm(chain.arm.joints, chain.arm.mirror, configurations[n], scratch.local, scratch.scratch)
        else:
            set_column(chain.column, configurations[n, 0], configurations[n, 1], scratch.local)
            if configurations.shape[1] > 2:
                _sink(chain, configurations[n, 2], scratch.rotations, scratch.places)
        frames_along(chain.order, chain.parents, chain.offsets, scratch.local, scratch.rotations, scratch.places)
        if len(out):
            segments_into(chain.joints, chain.ends, scratch.rotations, scratch.places, scratch.row, first + n, out)
        if chain.carries:
            for i in range(3):
                places[n, i] = scratch.places[chain.end, i]
            for i in range(4):
                turns[n, i] = scratch.rotations[chain.end, i]


@kernel
def pose_chain(chain: Chain, configurations: Floats) -> tuple[Segments, Floats, Floats]:
    """Capsules (C, 6, N) of a group, and place (N, 3) and rotation (N, 4) of the joint that others hang on.

    All in the frame that carries the group, for its configurations (N, d). For the waist that is the pelvis frame,
    where the hips would be without lowering; for its children the frame of the last spine joint.
    """
    count = len(configurations)
    out = np.empty((len(chain.joints), 6, count), np.float32)
    places, turns = np.empty((count, 3)), np.empty((count, 4))
    pose_chain_into(chain, configurations, count, pose_scratch(chain), _FIRST, out, places, turns)
    return out, places, turns
