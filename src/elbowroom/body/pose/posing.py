"""The kernels of forward kinematics: planning degrees of freedom to joint rotations, frames and capsules.

Quaternions are rows `xyzw` of (J, 4) arrays; every kernel poses one posture after the other, in float64.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.carriage import about_left, carried_turns, hips_turn, leant_by, shifted_by
from elbowroom.body.gait.lowered_hips import hips_sink
from elbowroom.body.root import HEIGHT, WITH_FEET
from elbowroom.by_reference import by_reference
from elbowroom.jit import helper, inner_kernel, kernel, plain

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]
Segments = NDArray[np.float32]

_FIRST, _SECOND = plain(0), plain(1)  # places in a row of capsules or joints
_WAIST, _HEAD = 0, 1  # places among the columns
_OTHER_END = plain(3)  # where it begins in the row (6,) of a capsule


@inner_kernel
def _product(a: Floats, i: int, b: Floats, j: int, out: Floats, k: int) -> None:
    """out[k] = a[i] b[j]."""
    ax, ay, az, aw = a[i, 0], a[i, 1], a[i, 2], a[i, 3]
    bx, by, bz, bw = b[j, 0], b[j, 1], b[j, 2], b[j, 3]
    out[k, 0] = aw * bx + ax * bw + ay * bz - az * by
    out[k, 1] = aw * by - ax * bz + ay * bw + az * bx
    out[k, 2] = aw * bz + ax * by - ay * bx + az * bw
    out[k, 3] = aw * bw - ax * bx - ay * by - az * bz


@inner_kernel
def _offset(
    q: Floats, j: int, arm: tuple[float, float, float], base: Floats, i: int, out: Floats, k: int, at: int
) -> None:
    """out[k, at:at+3] = base[i] + the vector `arm` rotated by q[j]."""
    x, y, z = arm
    qx, qy, qz, qw = q[j, 0], q[j, 1], q[j, 2], q[j, 3]
    tx, ty, tz = 2.0 * (qy * z - qz * y), 2.0 * (qz * x - qx * z), 2.0 * (qx * y - qy * x)
    out[k, at] = base[i, 0] + x + qw * tx + qy * tz - qz * ty
    out[k, at + 1] = base[i, 1] + y + qw * ty + qz * tx - qx * tz
    out[k, at + 2] = base[i, 2] + z + qw * tz + qx * ty - qy * tx


@inner_kernel
def _set_power(x: float, y: float, z: float, scale: float, out: Floats, k: int) -> None:
    """out[k] = exp(scale (x, y, z))."""
    half = 0.5 * scale * np.sqrt(x * x + y * y + z * z)
    factor = 0.5 * scale * (1.0 - half * half / 6.0) if abs(half) < 1e-4 else 0.5 * scale * np.sin(half) / half
    out[k, 0], out[k, 1], out[k, 2], out[k, 3] = factor * x, factor * y, factor * z, np.cos(half)


class Column(NamedTuple):
    """A row of joints that share the rotation Ry(twist) Rx(bend)."""

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
    column: Column
    arm: Arm
    half_leg: float  # metres, the unit of a lowering
    hinge: Floats  # (2,) metres that the hips joint is above and ahead of the middle between those of the legs


class Columns(NamedTuple):
    """K columns one after the other."""

    joints: Indices  # (S,) as in `Column`
    shares: Floats  # (S,)
    begins: Indices  # (K + 1,) where the joints of each begin
    first: Indices  # (K,)


class Arms(NamedTuple):
    """A arms."""

    joints: Indices  # (A, 3) as in `Arm`
    mirrors: Floats  # (A,)
    first: Indices  # (A,)


class Figure(NamedTuple):
    """All joints of a body, and what turns them."""

    base: Floats  # as in `Chain`
    parents: Indices
    offsets: Floats
    columns: Columns
    arms: Arms
    legs: Indices  # (2, 4) thigh, shin, foot, toes; -1 where absent
    chest: int  # the joint that head and arms hang on


def columns_together(columns: Sequence[Column]) -> Columns:
    """These columns as arrays."""
    begins = np.cumsum([0, *(len(column.joints) for column in columns)])
    joints, shares, first = zip(*columns, strict=True)
    return Columns(np.concatenate(joints), np.concatenate(shares), begins.astype(np.int64), np.array(first, np.int64))


def arms_together(arms: Sequence[Arm]) -> Arms:
    """These arms as arrays."""
    joints, mirrors, first = zip(*arms, strict=True)
    return Arms(np.array(joints, np.int64), np.array(mirrors, np.float64), np.array(first, np.int64))


class CapsuleChain(NamedTuple):
    """Capsules of a body and the joints between the hips and them."""

    order: Indices  # the joints to pose, parents first, without the hips
    joints: Indices  # (C,)
    ends: Floats  # (C, 6)


@inner_kernel
def _set_column(column: Column, bend: float, twist: float, local: Floats) -> None:
    """The joints of a column: each takes its share of the rotation vector of Ry(twist) Rx(bend)."""
    cb, sb, ct, st = np.cos(0.5 * bend), np.sin(0.5 * bend), np.cos(0.5 * twist), np.sin(0.5 * twist)
    x, y, z, w = ct * sb, st * cb, -st * sb, ct * cb
    sine = np.sqrt(x * x + y * y + z * z)
    angle = 2.0 * np.arctan2(sine, w)
    factor = angle / sine if sine > 1e-9 else 2.0
    for i in range(len(column.joints)):
        _set_power(x * factor, y * factor, z * factor, column.shares[i], local, column.joints[i])


@inner_kernel
def _set_arm(joints: Indices, mirror: float, arm: Floats, local: Floats, scratch: Floats) -> None:
    """Upper arm and forearm for (flexion, abduction, internal rotation, elbow); `mirror` is +1 left, -1 right."""
    upper, lower = joints[0], joints[1]
    _set_power(-arm[0], 0.0, mirror * arm[1], 1.0, scratch, _FIRST)
    half = 0.5 * np.sqrt(0.5)
    # Ry(-m i) Rz(-m 90 deg): the product of two rotations about axes, written out
    c, s = 2.0 * half * np.cos(0.5 * arm[2]), -mirror * 2.0 * half * np.sin(0.5 * arm[2])
    scratch[1, 0], scratch[1, 1], scratch[1, 2], scratch[1, 3] = -mirror * s, s, -mirror * c, c
    _product(scratch, _FIRST, scratch, _SECOND, local, upper)
    local[lower, 0], local[lower, 1] = 0.0, -mirror * np.sin(0.5 * arm[3])
    local[lower, 2], local[lower, 3] = 0.0, np.cos(0.5 * arm[3])


@inner_kernel
def _set_legs(joints: Indices, rotations: Floats, local: Floats) -> None:
    """Thigh, shin, foot and toes of both legs; joints (2, 4), -1 where the avatar has no such bone."""
    for side in range(2):
        for part in range(4):
            joint = joints[side, part]
            if joint >= 0:
                for i in range(4):
                    local[joint, i] = rotations[side, part, i]


@inner_kernel
def _chain(order: Indices, parents: Indices, offsets: Floats, local: Floats, rotations: Floats, places: Floats) -> None:
    """Frames of the joints in `order`, parents first; the parent of the first is in place already."""
    for i in range(len(order)):
        joint = order[i]
        parent = parents[joint]
        arm = offsets[joint, 0], offsets[joint, 1], offsets[joint, 2]
        _offset(rotations, parent, arm, places, parent, places, joint, _FIRST)
        _product(rotations, parent, local, joint, rotations, joint)


@kernel
def _segments(
    joints: Indices, ends: Floats, rotations: Floats, places: Floats, row: Floats, n: int, out: Segments
) -> None:
    """Capsule end points of posture `n` into out (C, 6, N); `row` (1, 6) is scratch."""
    for c in range(len(joints)):
        j = joints[c]
        _offset(rotations, j, (ends[c, 0], ends[c, 1], ends[c, 2]), places, j, row, _FIRST, _FIRST)
        _offset(rotations, j, (ends[c, 3], ends[c, 4], ends[c, 5]), places, j, row, _FIRST, _OTHER_END)
        for i in range(6):
            out[c, i, n] = row[0, i]


@kernel
def _place(joint: int, rotations: Floats, places: Floats, x: float, y: float, z: float, heading: float) -> None:
    """Put a base frame at a point, turned about +Y."""
    rotations[joint, 0], rotations[joint, 1] = 0.0, np.sin(0.5 * heading)
    rotations[joint, 2], rotations[joint, 3] = 0.0, np.cos(0.5 * heading)
    places[joint, 0], places[joint, 1], places[joint, 2] = x, y, z


@inner_kernel
def _place_hips(root: Floats, hips: Floats, sink: Floats, rotations: Floats, places: Floats, joint: int) -> None:
    """The hips' frame in the world, into row `joint`: T-pose hips in the root's frame, `sink` (2,) below and behind."""
    c, s = np.cos(root[2]), np.sin(root[2])
    ahead = hips[2] - sink[1]
    x, z = root[0] + hips[0] * c + ahead * s, root[1] - hips[0] * s + ahead * c
    height = hips[1] - sink[0]
    if len(root) > HEIGHT:
        height += root[HEIGHT]
    _place(joint, rotations, places, x, height, z, root[2])


@inner_kernel
def _set(out: Floats, k: int, turn: tuple[float, float, float, float]) -> None:
    out[k, 0], out[k, 1], out[k, 2], out[k, 3] = turn


@inner_kernel
def _turn_before(turn: tuple[float, float, float, float], local: Floats, joint: int, scratch: Floats) -> None:
    """local[joint] = turn local[joint]; `scratch` (2, 4)."""
    _set(scratch, _FIRST, turn)
    for i in range(4):
        scratch[1, i] = local[joint, i]
    _product(scratch, _FIRST, scratch, _SECOND, local, joint)


@inner_kernel
def hips_shift(figure: Figure, row: Floats, lean: float) -> tuple[float, float, float]:
    """How far the hips joint is, in the root's axes, from where it was planned upright."""
    one, other, offsets = figure.legs[0, 0], figure.legs[1, 0], figure.offsets
    return shifted_by(
        row,
        lean,
        -0.5 * (offsets[one, 0] + offsets[other, 0]),
        -0.5 * (offsets[one, 1] + offsets[other, 1]),
        -0.5 * (offsets[one, 2] + offsets[other, 2]),
    )


@inner_kernel
def _carry_hips(figure: Figure, row: Floats, lean: float, rotations: Floats, places: Floats, scratch: Floats) -> None:
    """Lean the hips, and carry them as a row (SHOWN,) says; they are where they were planned, turned by the heading."""
    if row.shape[0] <= WITH_FEET and lean <= 0.0:
        return
    _set(scratch, _FIRST, hips_turn(row, lean))
    x, y, z = hips_shift(figure, row, lean)
    _offset(rotations, _FIRST, (x, y, z), places, _FIRST, places, _FIRST, _FIRST)
    for i in range(4):
        scratch[1, i] = rotations[0, i]
    _product(scratch, _SECOND, scratch, _FIRST, rotations, _FIRST)


@inner_kernel
def _carry_trunk(figure: Figure, row: Floats, lean: float, local: Floats, scratch: Floats) -> None:
    """Chest and head as a row (SHOWN,) carries them, beyond their posture."""
    chest, head = carried_turns(row, lean)
    columns = figure.columns
    _turn_before(chest, local, columns.joints[columns.begins[_WAIST]], scratch)
    _turn_before(head, local, columns.joints[columns.begins[_HEAD]], scratch)


@inner_kernel
def _set_body(figure: Figure, q: Floats, leg_rotations: Floats, local: Floats, scratch: Floats) -> None:
    """Every joint that moves, for a posture `q` (DOF,) and legs (2, 4, 4)."""
    columns, arms = figure.columns, figure.arms
    for k in range(len(columns.first)):
        first, last, at = columns.begins[k], columns.begins[k + 1], columns.first[k]
        _set_column(Column(columns.joints[first:last], columns.shares[first:last], at), q[at], q[at + 1], local)
    for k in range(len(arms.first)):
        _set_arm(arms.joints[k], arms.mirrors[k], q[arms.first[k] :], local, scratch)
    _set_legs(figure.legs, leg_rotations, local)


@inner_kernel
def pose_local(figure: Figure, q: Floats, leg_rotations: Floats, row: Floats, lean: float) -> Floats:
    """Local rotations (J, 4) of a posture `q` (DOF,), legs (2, 4, 4), carried as a row (7 or more,) says.

    Its hips lean forward by `lean` radians.
    """
    local, scratch = figure.base.copy(), np.empty((2, 4))
    _set_body(figure, q, leg_rotations, local, scratch)
    if row.shape[0] > WITH_FEET:
        _carry_trunk(figure, row, lean, local, scratch)
    _set(local, _FIRST, hips_turn(row, lean))
    return local


@inner_kernel
def pose_body(
    figure: Figure, capsules: CapsuleChain, q: Floats, roots: Floats, leg_rotations: Floats, sinks: Floats
) -> tuple[Segments, Floats, Floats]:
    """The body in the world for postures (N, DOF), roots (N, 7 or more), legs (N, 2, 4, 4) and hips' sinks (N, 3).

    Returns capsules (C, 6, N), and place (N, 3) and rotation (N, 4) of the chest's frame.
    """
    out = np.empty((len(capsules.joints), 6, len(q)), np.float32)
    chest_places, chest_rotations = np.empty((len(q), 3)), np.empty((len(q), 4))
    local, scratch, row = figure.base.copy(), np.empty((2, 4)), np.empty((1, 6))
    rotations, places = np.empty(figure.base.shape), np.empty(figure.offsets.shape)
    for n in range(len(q)):
        _set_body(figure, q[n], leg_rotations[n], local, scratch)
        _place_hips(roots[n], figure.offsets[0], sinks[n], rotations, places, _FIRST)
        _carry_hips(figure, roots[n], sinks[n, 2], rotations, places, scratch)
        if roots.shape[1] > WITH_FEET:
            _carry_trunk(figure, roots[n], sinks[n, 2], local, scratch)
        _chain(capsules.order, figure.parents, figure.offsets, local, rotations, places)
        _segments(capsules.joints, capsules.ends, rotations, places, row, n, out)
        for i in range(3):
            chest_places[n, i] = places[figure.chest, i]
        for i in range(4):
            chest_rotations[n, i] = rotations[figure.chest, i]
    return out, chest_places, chest_rotations


@inner_kernel
def pose_joints(figure: Figure, capsules: CapsuleChain, roots: Floats, local: Floats, hips: Floats) -> Segments:
    """Capsules (C, 6, N) in the world for rotations (N, J, 4) of all joints and places (N, 3) of the hips' joint.

    As `pose_local` gives them: in the axes of roots (N, 7 or more).
    """
    out = np.empty((len(capsules.joints), 6, len(roots)), np.float32)
    row, scratch, here = np.empty((1, 6)), np.empty((2, 4)), np.zeros(2)
    rotations, places = np.empty(figure.base.shape), np.empty(figure.offsets.shape)
    for n in range(len(roots)):
        _place_hips(roots[n], hips[n], here, rotations, places, _FIRST)
        for i in range(4):
            scratch[0, i] = rotations[0, i]
        _product(scratch, _FIRST, local[n], _FIRST, rotations, _FIRST)
        _chain(capsules.order, figure.parents, figure.offsets, local[n], rotations, places)
        _segments(capsules.joints, capsules.ends, rotations, places, row, n, out)
    return out


@inner_kernel
def pose_legs(figure: Figure, capsules: CapsuleChain, roots: Floats, leg_rotations: Floats, sinks: Floats) -> Segments:
    """Capsules (C, 6, N) of pelvis and legs in the world."""
    out = np.empty((len(capsules.joints), 6, len(roots)), np.float32)
    local, row, scratch = figure.base.copy(), np.empty((1, 6)), np.empty((2, 4))
    rotations, places = np.empty(figure.base.shape), np.empty(figure.offsets.shape)
    for n in range(len(roots)):
        _set_legs(figure.legs, leg_rotations[n], local)
        _place_hips(roots[n], figure.offsets[0], sinks[n], rotations, places, _FIRST)
        _carry_hips(figure, roots[n], sinks[n, 2], rotations, places, scratch)
        _chain(capsules.order, figure.parents, figure.offsets, local, rotations, places)
        _segments(capsules.joints, capsules.ends, rotations, places, row, n, out)
    return out


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
    _place(chain.start, rotations, places, 0.0, rises - below, goes - behind, 0.0)
    _set(rotations, chain.start, about_left(lean))


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
    _place(chain.start, scratch.rotations, scratch.places, 0.0, 0.0, 0.0, 0.0)
    for n in range(count):
        if chain.is_arm:
            _set_arm(chain.arm.joints, chain.arm.mirror, configurations[n], scratch.local, scratch.scratch)
        else:
            _set_column(chain.column, configurations[n, 0], configurations[n, 1], scratch.local)
            if configurations.shape[1] > 2:
                _sink(chain, configurations[n, 2], scratch.rotations, scratch.places)
        _chain(chain.order, chain.parents, chain.offsets, scratch.local, scratch.rotations, scratch.places)
        if len(out):
            _segments(chain.joints, chain.ends, scratch.rotations, scratch.places, scratch.row, first + n, out)
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


@inner_kernel
def place_pelvis_into(
    hips: Floats, roots: Floats, sinks: Floats, count: int, places: Floats, rotations: Floats
) -> None:
    """`place_pelvis` for the first `count` roots, written to `places` (N, 3) and `rotations` (N, 4)."""
    for n in range(count):
        _place_hips(roots[n], hips, sinks[n], rotations, places, n)


@kernel
def place_pelvis(hips: Floats, roots: Floats, sinks: Floats) -> tuple[Floats, Floats]:
    """Pelvis frames in the world: places (N, 3) and rotations (N, 4)."""
    places, rotations = np.empty((len(roots), 3)), np.empty((len(roots), 4))
    place_pelvis_into(hips, roots, sinks, len(roots), places, rotations)
    return places, rotations
