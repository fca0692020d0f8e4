"""The kernels of forward kinematics: a whole body's joint rotations, frames and capsules of its degrees of freedom.

Quaternions are rows `xyzw` of (J, 4) arrays; every kernel poses one posture after the other, in float64.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.carriage import carried_turns, hips_turn, shifted_by
from elbowroom.body.pose.frames import frames_along, offset_into, product_into, segments_into, set_turn
from elbowroom.body.pose.joint_tree import CapsuleChain, JointTree, SpineColumn
from elbowroom.body.pose.pelvis import place_hips
from elbowroom.body.pose.turned_joints import set_arm, set_column, set_legs
from elbowroom.body.root import WITH_FEET
from elbowroom.jit import inner_kernel, plain

Floats = NDArray[np.float64]
Segments = NDArray[np.float32]

_FIRST, _SECOND = plain(0), plain(1)  # places in a row of joints, or of scratch
_WAIST, _HEAD = 0, 1  # places among the columns


@inner_kernel
def _turn_before(turn: tuple[float, float, float, float], local: Floats, joint: int, scratch: Floats) -> None:
    """local[joint] = turn local[joint]; `scratch` (2, 4)."""
    set_turn(scratch, _FIRST, turn)
    for i in range(4):
        scratch[1, i] = local[joint, i]
    product_into(scratch, _FIRST, scratch, _SECOND, local, joint)


@inner_kernel
def hips_shift(tree: JointTree, row: Floats, lean: float) -> tuple[float, float, float]:
    """How far the hips joint is, in the root's axes, from where it was planned upright."""
    one, other, offsets = tree.legs[0, 0], tree.legs[1, 0], tree.offsets
    return shifted_by(
        row,
        lean,
        -0.5 * (offsets[one, 0] + offsets[other, 0]),
        -0.5 * (offsets[one, 1] + offsets[other, 1]),
        -0.5 * (offsets[one, 2] + offsets[other, 2]),
    )


@inner_kernel
def _carry_hips(tree: JointTree, row: Floats, lean: float, rotations: Floats, places: Floats, scratch: Floats) -> None:
    """Lean the hips, and carry them as a row (SHOWN,) says; they are where they were planned, turned by the heading."""
    if row.shape[0] <= WITH_FEET and lean <= 0.0:
        return
    set_turn(scratch, _FIRST, hips_turn(row, lean))
    x, y, z = hips_shift(tree, row, lean)
    offset_into(rotations, _FIRST, (x, y, z), places, _FIRST, places, _FIRST, _FIRST)
    for i in range(4):
        scratch[1, i] = rotations[0, i]
    product_into(scratch, _SECOND, scratch, _FIRST, rotations, _FIRST)


@inner_kernel
def _carry_trunk(tree: JointTree, row: Floats, lean: float, local: Floats, scratch: Floats) -> None:
    """Chest and head as a row (SHOWN,) carries them, beyond their posture."""
    chest, head = carried_turns(row, lean)
    columns = tree.columns
    _turn_before(chest, local, columns.joints[columns.begins[_WAIST]], scratch)
    _turn_before(head, local, columns.joints[columns.begins[_HEAD]], scratch)


@inner_kernel
def _set_body(tree: JointTree, q: Floats, leg_rotations: Floats, local: Floats, scratch: Floats) -> None:
    """Every joint that moves, for a posture `q` (DOF,) and legs (2, 4, 4)."""
    columns, arms = tree.columns, tree.arms
    for k in range(len(columns.first)):
        first, last, at = columns.begins[k], columns.begins[k + 1], columns.first[k]
        set_column(SpineColumn(columns.joints[first:last], columns.shares[first:last], at), q[at], q[at + 1], local)
    for k in range(len(arms.first)):
        set_arm(arms.joints[k], arms.mirrors[k], q[arms.first[k] :], local, scratch)
    set_legs(tree.legs, leg_rotations, local)


@inner_kernel
def pose_local(tree: JointTree, q: Floats, leg_rotations: Floats, row: Floats, lean: float) -> Floats:
    """Local rotations (J, 4) of a posture `q` (DOF,), legs (2, 4, 4), carried as a row (7 or more,) says.

    Its hips lean forward by `lean` radians.
    """
    local, scratch = tree.base.copy(), np.empty((2, 4))
    _set_body(tree, q, leg_rotations, local, scratch)
    if row.shape[0] > WITH_FEET:
        _carry_trunk(tree, row, lean, local, scratch)
    set_turn(local, _FIRST, hips_turn(row, lean))
    return local


@inner_kernel
def pose_body(
    tree: JointTree, capsules: CapsuleChain, q: Floats, roots: Floats, leg_rotations: Floats, sinks: Floats
) -> tuple[Segments, Floats, Floats]:
    """The body in the world for postures (N, DOF), roots (N, 7 or more), legs (N, 2, 4, 4) and hips' sinks (N, 3).

    Returns capsules (C, 6, N), and place (N, 3) and rotation (N, 4) of the chest's frame.
    """
    out = np.empty((len(capsules.joints), 6, len(q)), np.float32)
    chest_places, chest_rotations = np.empty((len(q), 3)), np.empty((len(q), 4))
    local, scratch, row = tree.base.copy(), np.empty((2, 4)), np.empty((1, 6))
    rotations, places = np.empty(tree.base.shape), np.empty(tree.offsets.shape)
    for n in range(len(q)):
        _set_body(tree, q[n], leg_rotations[n], local, scratch)
        place_hips(roots[n], tree.offsets[0], sinks[n], rotations, places, _FIRST)
        _carry_hips(tree, roots[n], sinks[n, 2], rotations, places, scratch)
        if roots.shape[1] > WITH_FEET:
            _carry_trunk(tree, roots[n], sinks[n, 2], local, scratch)
        frames_along(capsules.order, tree.parents, tree.offsets, local, rotations, places)
        segments_into(capsules.joints, capsules.ends, rotations, places, row, n, out)
        for i in range(3):
            chest_places[n, i] = places[tree.chest, i]
        for i in range(4):
            chest_rotations[n, i] = rotations[tree.chest, i]
    return out, chest_places, chest_rotations


@inner_kernel
def pose_joints(tree: JointTree, capsules: CapsuleChain, roots: Floats, local: Floats, hips: Floats) -> Segments:
    """Capsules (C, 6, N) in the world for rotations (N, J, 4) of all joints and places (N, 3) of the hips' joint.

    As `pose_local` gives them: in the axes of roots (N, 7 or more).
    """
    out = np.empty((len(capsules.joints), 6, len(roots)), np.float32)
    row, scratch, here = np.empty((1, 6)), np.empty((2, 4)), np.zeros(2)
    rotations, places = np.empty(tree.base.shape), np.empty(tree.offsets.shape)
    for n in range(len(roots)):
        place_hips(roots[n], hips[n], here, rotations, places, _FIRST)
        for i in range(4):
            scratch[0, i] = rotations[0, i]
        product_into(scratch, _FIRST, local[n], _FIRST, rotations, _FIRST)
        frames_along(capsules.order, tree.parents, tree.offsets, local[n], rotations, places)
        segments_into(capsules.joints, capsules.ends, rotations, places, row, n, out)
    return out


@inner_kernel
def pose_legs(tree: JointTree, capsules: CapsuleChain, roots: Floats, leg_rotations: Floats, sinks: Floats) -> Segments:
    """Capsules (C, 6, N) of pelvis and legs in the world."""
    out = np.empty((len(capsules.joints), 6, len(roots)), np.float32)
    local, row, scratch = tree.base.copy(), np.empty((1, 6)), np.empty((2, 4))
    rotations, places = np.empty(tree.base.shape), np.empty(tree.offsets.shape)
    for n in range(len(roots)):
        set_legs(tree.legs, leg_rotations[n], local)
        place_hips(roots[n], tree.offsets[0], sinks[n], rotations, places, _FIRST)
        _carry_hips(tree, roots[n], sinks[n, 2], rotations, places, scratch)
        frames_along(capsules.order, tree.parents, tree.offsets, local, rotations, places)
        segments_into(capsules.joints, capsules.ends, rotations, places, row, n, out)
    return out
