"""Levers: how fast, at most, any point of a capsule's axis moves for a unit of rate of what moves it.

Points on rigid links: a point at distance r from the axis of a joint that turns at the rate w moves at most at r w, and
speeds of joints along a chain add up. Distances are sums of bone lengths, so they hold in every posture. What the
stride does to the legs is no chain of joints that turn at known rates: that is measured, over strides of all kinds.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL_GROUPS, LOWERING, DofGroup
from elbowroom.body.gait.lowered_hips import STEEPEST, hips_sinks
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.joint_tree import SpineColumn
from elbowroom.body.pose.kinematics import BodyModel, body_model, leg_capsules, pelvis_frames
from elbowroom.body.root import ROOT_STATE
from elbowroom.planning.model.even_points import evenly_spread
from elbowroom.planning.model.limb import Limb, limb_of
from elbowroom.planning.shared import Shared

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

ROTATION = 1.15  # a rotation vector of up to 1.7 rad changes at most so much faster than the rotation turns
MOVES = 3  # columns of a limb's moves, and of a stride's
_LOWERING = LOWERING - DofGroup.WAIST.at.start - 1  # its place among the waist's moves
SPARE = 1.25  # of what was measured, that what was not may do more
_STRIDES, _STEP = 2048, 1e-3  # strides that are measured, by changes so small
_VELOCITIES = np.array([[-1.5, 3.0], [-1.0, 1.0], [-2.5, 2.5]])  # m/s ahead and to the left, rad/s
_LOWEST = 0.7  # half leg lengths


def lifts_of(model: BodyModel, spans: Floats) -> Floats:
    """How far what is `spans` (C,) metres from the hips joint moves for a unit of lowering, metres (C,).

    Hips go down and back, and lean with all that is on them.
    """
    sunk = float(np.linalg.norm(hips_sinks(model.gait.half_leg, np.zeros(1), np.ones(1))[0, :2]))
    lifts: Floats = sunk + STEEPEST * (_apart(model) + spans)
    return lifts


def levers_of(model: BodyModel, limb: Limb) -> Floats:
    """Levers (C, 3) of a limb's capsules in the frame that carries it, m/s.

    The columns belong to the rate of the first two components together, of the third and of the fourth. Waist: bend
    and twist turn each spine joint by its part, neck and head back by theirs; the third lowers all. Arm: the
    swing turns it about the shoulder, the third component about the upper arm's own axis, the fourth about the elbow.
    """
    chain = limb.chain
    if chain.is_arm:
        return _arm_levers(model, limb)
    levers = np.zeros((len(chain.joints), MOVES))
    levers[:, 0] = _column_levers(model, chain.column, chain.joints, chain.ends, chain.start)
    levers[:, _LOWERING] = lifts_of(model, _lengths(model, chain.joints, chain.ends)) if chain.carries else 0.0
    return levers


def _column_levers(model: BodyModel, column: SpineColumn, joints: Indices, ends: Floats, frame: int) -> Floats:
    """What a column's rotation does at most to capsules (C,) as seen from one of its joints, or from its beginning."""
    levers, above = np.zeros(len(joints)), [frame]
    while (parent := int(model.parents[above[-1]])) >= 0:
        above.append(parent)
    turning = dict(zip(column.joints.tolist(), np.abs(column.shares).tolist(), strict=True))
    for c, joint in enumerate(joints):
        far, at = float(np.linalg.norm(ends[c].reshape(2, 3), axis=1).max()), int(joint)
        while at not in above:
            levers[c] += ROTATION * turning.get(at, 0.0) * far
            far += float(np.linalg.norm(model.offsets[at]))
            at = int(model.parents[at])
        for below in above[: above.index(at)][::-1]:
            far += float(np.linalg.norm(model.offsets[below]))
            levers[c] += ROTATION * turning.get(below, 0.0) * far
    return levers


def _arm_levers(model: BodyModel, limb: Limb) -> Floats:
    chain = limb.chain
    levers = np.zeros((len(chain.joints), MOVES))
    shoulder, elbow = int(chain.arm.joints[0]), int(chain.arm.joints[1])
    forearm = model.offsets[elbow]
    for c, joint in enumerate(chain.joints):
        ends = chain.ends[c].reshape(2, 3)
        far, at = float(np.linalg.norm(ends, axis=1).max()), int(joint)
        if at == shoulder:
            levers[c] = far, float(np.hypot(ends[:, 1], ends[:, 2]).max()), 0.0
            continue
        while at != elbow:
            far += float(np.linalg.norm(model.offsets[at]))
            at = int(model.parents[at])
        levers[c] = np.linalg.norm(forearm) + far, np.hypot(forearm[1], forearm[2]) + far, far
    return levers


@dataclass(frozen=True, eq=False)
class BodyLevers:
    """Levers of all C capsules of a body for its M moves: those of the local groups, side by side, and of the stride.

    A group's moves are as in `levers_of`; the stride's are what the velocity over the ground, the turning rate and the
    phase change.
    """

    from_pelvis: Floats  # (C, M) in the pelvis frame
    from_chest: Floats  # (C, M) in the chest frame; of the trunk and what hangs on it

    def between(self, first: Indices, second: Indices, legs: Indices) -> Floats:
        """How far the two of P pairs of capsules can move against each other for a unit of each move, (P, M).

        A pair with pelvis or legs is seen from the pelvis, any other from the chest.
        """
        beside_legs = np.isin(first, legs) | np.isin(second, legs)
        pelvis, chest = (levers[first] + levers[second] for levers in (self.from_pelvis, self.from_chest))
        levers: Floats = np.where(beside_legs[:, None], pelvis, chest)
        return levers


_LEVERS: Shared[BodyLevers] = Shared()


def body_levers(humanoid: Humanoid) -> BodyLevers:
    """The levers of an avatar's body: the same for all who ask. Measured in a fifth of a second."""
    return _LEVERS.get(humanoid, lambda: _measured(body_model(humanoid)))


def _measured(model: BodyModel) -> BodyLevers:
    capsules, waist = model.body.posed, model.chains[DofGroup.WAIST]
    spans = _lengths(model, capsules.joints, capsules.ends)
    from_pelvis, from_chest = np.zeros((2, len(model.body.radii), (len(LOCAL_GROUPS) + 1) * MOVES))
    for group in LOCAL_GROUPS:
        parts, at = model.capsules_of(group).indices, _columns(DofGroup.WAIST).start
        if group is not DofGroup.WAIST:
            from_pelvis[parts, _columns(group)] = from_chest[parts, _columns(group)] = levers_of(
                model, limb_of(model, group)
            )
        for levers, frame in ((from_pelvis, waist.start), (from_chest, waist.end)):
            levers[parts, at] = _column_levers(model, waist.column, capsules.joints[parts], capsules.ends[parts], frame)
        from_pelvis[parts, at + _LOWERING] = lifts_of(model, spans[parts])
    legs = model.roots.indices
    from_pelvis[legs, -MOVES:], from_pelvis[legs, _columns(DofGroup.WAIST).start + _LOWERING] = _stride_levers(model)
    return BodyLevers(from_pelvis, from_chest)


def _apart(model: BodyModel) -> float:
    """Metres from the hips joint to the middle between those of the legs."""
    return float(np.linalg.norm(model.offsets[model.tree.legs[:, 0]].mean(axis=0)))


def _lengths(model: BodyModel, joints: Indices, ends: Floats) -> Floats:
    """How far the axes of capsules (C,), on joints and with ends (C, 6) in their frames, get from the hips, metres."""
    out: Floats = np.linalg.norm(ends.reshape(-1, 2, 3), axis=2).max(axis=1)
    for c, joint in enumerate(joints):
        at = int(joint)
        while at > 0:
            out[c] += np.linalg.norm(model.offsets[at])
            at = int(model.parents[at])
    return out


def _stride_levers(model: BodyModel) -> tuple[Floats, Floats]:
    """Levers of pelvis and legs in the pelvis frame for the stride (C, 3), and for a unit of lowering (C,).

    They are measured, half of them upright, where knees snap most, and a quarter more is taken.
    """
    drawn = evenly_spread(_STRIDES, len(_VELOCITIES) + 2)
    states, lowerings = np.zeros((_STRIDES, ROOT_STATE)), _LOWEST * np.maximum(2.0 * drawn[:, -1] - 1.0, 0.0)
    states[:, 3:6] = _VELOCITIES[:, 0] + drawn[:, :3] * np.ptp(_VELOCITIES, axis=1)
    states[:, 6] = drawn[:, 3]
    begin, ways = _seen_from_pelvis(model, states, lowerings), []
    for row in np.eye(ROOT_STATE + 1)[[3, 4, 5, 6, ROOT_STATE]]:
        after = _seen_from_pelvis(model, states + _STEP * row[:-1], lowerings + _STEP * row[-1])
        ways.append(np.linalg.norm(after - begin, axis=2).max(axis=(1, 2)))
    ahead, aside, turn, phase, lowering = SPARE / _STEP * np.array(ways)
    return np.stack([np.hypot(ahead, aside), turn, phase], axis=1), lowering


def _seen_from_pelvis(model: BodyModel, states: Floats, lowerings: Floats) -> Floats:
    """The ends (C, 2, 3, N) of the capsules of pelvis and legs in the pelvis frame."""
    ends = leg_capsules(model, states, lowerings).astype(np.float64).reshape(len(model.roots.radii), 2, 3, -1)
    seen: Floats = ends - pelvis_frames(model, states)[0].T
    return seen


def _columns(group: DofGroup) -> slice:
    first = MOVES * LOCAL_GROUPS.index(group)
    return slice(first, first + MOVES)
