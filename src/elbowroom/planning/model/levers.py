"""Levers: how fast, at most, any point of a capsule's axis moves for a unit of rate of what moves it.

Points on rigid links: a point at distance r from the axis of a joint that turns at the rate w moves at most at r w, and
speeds of joints along a chain add up. Distances are sums of bone lengths, so they hold in every posture. What the
stride does to the legs is no chain of joints that turn at known rates: that is measured, over strides of all kinds.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL_GROUPS, LOWERING, DofGroup, columns_of
from elbowroom.body.gait.carriage import ASIDE, CHEST_TURN, HEAD_TURN, OF_HIPS, POSING, UP
from elbowroom.body.gait.lowered_hips import STEEPEST, hips_sinks
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import BodyModel, body_model, leg_capsules, lower_body, pelvis_frames
from elbowroom.body.pose.posing import Column
from elbowroom.body.root import FOOT, HEIGHT, RISES, ROOT_STATE, SHOWN, WITH_FEET
from elbowroom.jit import brief_exact_kernel, helper
from elbowroom.planning.model.even_points import evenly_spread
from elbowroom.planning.model.limb import Limb, limb_of
from elbowroom.planning.shared import Shared

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

ROTATION = 1.15  # a rotation vector of up to 1.7 rad changes at most so much faster than the rotation turns
MOVES = 3  # columns of a limb's moves, and of a stride's
_LOWERING = LOWERING - DofGroup.WAIST.at.start - 1  # its place among the waist's moves
_STRIDES, _STEP, _SPARE = 2048, 1e-3, 1.25  # strides that are measured, by changes so small; what others may do more
_VELOCITIES = np.array([[-1.5, 3.0], [-1.0, 1.0], [-2.5, 2.5]])  # m/s ahead and to the left, rad/s
_LOWEST = 0.7  # half leg lengths
_KNEES, _ANKLES = 4.0, 1.5  # metres that a leg moves where its ground rises by one, or slopes by a radian more
_STEPS = 2.5  # and where one goes up faster by 1 m/s: steps are shorter then
# Where feet are measured: x from the hip, z, yaw, pitch, lift, share of the swing. Metres of a standard leg, radians.
_FEET_AT = np.array([[-0.15, 0.15], [-0.5, 0.5], [-0.7, 0.7], [-0.4, 1.2], [0.0, 0.07], [0.0, 1.0]])
_FOOT_MOVES = len(_FEET_AT) - 1  # of each foot: its way over the ground is one
# How hips are carried where that is measured: aside, up, ahead, turned, raised on the left. The same units.
_CARRIED_AT = np.array([[-0.04, 0.04], [-0.04, 0.02], [-0.03, 0.03], [-0.15, 0.15], [-0.1, 0.1]])
_OF_FEET = MOVES + 2 * _FOOT_MOVES  # how many moves come before those of the carriage
# Where the components of each local group begin in an upper body, and how many there are.
_COMPONENTS = np.array([[columns_of(group).start, group.size] for group in LOCAL_GROUPS])


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


def _column_levers(model: BodyModel, column: Column, joints: Indices, ends: Floats, frame: int) -> Floats:
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


class Levers(NamedTuple):
    """Levers of all C capsules of a body for its M moves, as seen from below: what `travel` goes by."""

    from_pelvis: Floats  # (C, M) in the pelvis frame
    bob: Floats  # (M,) of the pelvis frame above the ground
    steps: Floats  # (C, K) in the root's frame for the K moves of feet and carriage
    spans: Floats  # (C,) metres: no point of a capsule's axis gets farther from the root's axis


@dataclass(frozen=True, eq=False)
class BodyLevers:
    """Levers of all C capsules of a body for its M moves: those of the local groups, side by side, and of the stride.

    A group's moves are as in `levers_of`; the stride's are what the velocity over the ground, the turning rate and the
    phase change.
    """

    own: Levers
    from_chest: Floats  # (C, M) in the chest frame; of the trunk and what hangs on it

    def between(self, first: Indices, second: Indices, legs: Indices) -> Floats:
        """How far the two of P pairs of capsules can move against each other for a unit of each move, (P, M).

        A pair with pelvis or legs is seen from the pelvis, any other from the chest.
        """
        beside_legs = np.isin(first, legs) | np.isin(second, legs)
        pelvis, chest = (levers[first] + levers[second] for levers in (self.own.from_pelvis, self.from_chest))
        levers: Floats = np.where(beside_legs[:, None], pelvis, chest)
        return levers


@brief_exact_kernel
def travel(levers: Levers, roots: tuple[Floats, Floats], uppers: tuple[Floats, Floats]) -> Floats:
    """No point of a capsule's axis moves farther, (C,) metres, while a posture changes evenly to another.

    They are told by root states and upper bodies (LOCAL,). The root states have feet (WITH_FEET,), and carriage
    (SHOWN,), or go with the walking cycle (7,).
    """
    before, after, bob, steps, spans = roots[0], roots[1], levers.bob, levers.steps, levers.spans
    root, moves = after - before, np.zeros(bob.shape[0])
    _set_moves_of_groups(uppers[1] - uppers[0], moves)
    way = np.hypot(root[0], root[1])
    if root.shape[0] > HEIGHT:
        way += abs(root[HEIGHT]) + raised_between(before, after)
    on_feet, farthest = np.zeros(steps.shape[1]), 0.0
    if root.shape[0] > ROOT_STATE:
        _set_moves_of_feet(root, on_feet)
    else:
        last_of = bob.shape[0] - MOVES
        moves[last_of], moves[last_of + 1], moves[last_of + 2] = np.hypot(root[3], root[4]), abs(root[5]), abs(root[6])
        for i in range(bob.shape[0]):
            farthest += bob[i] * moves[i]
    ways = np.empty(spans.shape[0])
    for c in range(spans.shape[0]):
        ways[c] = way + farthest + abs(root[2]) * spans[c]
        for i in range(moves.shape[0]):
            ways[c] += levers.from_pelvis[c, i] * moves[i]
        for i in range(on_feet.shape[0]):
            ways[c] += steps[c, i] * on_feet[i]
    return ways


@helper
def _set_moves_of_groups(upper: Floats, moves: Floats) -> None:
    """The moves of all local groups, for a change of an upper body (LOCAL,)."""
    for k in range(_COMPONENTS.shape[0]):
        begin, size, at = _COMPONENTS[k, 0], _COMPONENTS[k, 1], MOVES * k
        moves[at] = np.hypot(upper[begin], upper[begin + 1])
        for i in range(2, size):
            moves[at + i - 1] = abs(upper[begin + i])


@helper
def _set_moves_of_feet(root: Floats, moves: Floats) -> None:
    """What feet do, and what of the root lowers the hips, (K,), for a change of a root state with feet.

    Velocity over the ground, turning rate, phase; of each foot its way, yaw, pitch, lift, and share of the swing; what
    poses the body of the carriage, where there is one.
    """
    moves[0], moves[1], moves[2] = np.hypot(root[3], root[4]), abs(root[5]), abs(root[6])
    for side in range(2):
        foot, at = root[ROOT_STATE + FOOT * side :], MOVES + (_FOOT_MOVES * side)
        moves[at] = np.hypot(foot[0], foot[1])
        for i in range(1, _FOOT_MOVES):
            moves[at + i] = abs(foot[i + 1])
    for i in range(POSING if root.shape[0] > WITH_FEET else 0):
        moves[_OF_FEET + i] = abs(root[WITH_FEET + i])


@brief_exact_kernel
def raised_between(one: Floats, other: Floats) -> float:
    """No point of a leg moves farther, metres, while what the feet of a root state stand on, and how fast that rises,
    changes to another's.
    """
    left, right = abs(other[RISES] - one[RISES]), abs(other[RISES + 2] - one[RISES + 2])
    slopes = abs(other[RISES + 1] - one[RISES + 1]) + abs(other[RISES + 3] - one[RISES + 3])
    climbs = abs(other[HEIGHT + 1] - one[HEIGHT + 1])
    return float(_KNEES * (left + right) + _ANKLES * slopes + _STEPS * climbs)


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
    legs, bob = model.roots.indices, np.zeros(from_pelvis.shape[1])
    from_pelvis[legs, -MOVES:], lowered, bob[-MOVES:] = _stride_levers(model)
    from_pelvis[legs, _columns(DofGroup.WAIST).start + _LOWERING] = lowered
    of_legs, of_hips = _foot_levers(model)
    aside = float(np.hypot(*model.offsets[0, [0, 2]])) + _LOWEST * float(lifts_of(model, np.zeros(1))[0])
    steps = np.zeros((len(from_pelvis), _OF_FEET + POSING))
    steps[:, : len(of_hips)] = of_hips
    steps[:, _OF_FEET:] += _carriage_levers(model)
    steps[legs], steps[legs, : len(of_hips)] = 0.0, of_legs
    return BodyLevers(Levers(from_pelvis, bob, steps, aside + spans), from_chest)


def _carriage_levers(model: BodyModel) -> Floats:
    """What the carriage does at most to capsules (C, POSING) that are carried by the spine, as it is planned.

    Hips that turn take the spine's lowest joint along, a chest that turns takes all above it; the head turns back
    against the chest, and by itself.
    """
    capsules = model.body.posed
    levers, spans = np.zeros((len(capsules.joints), POSING)), _lengths(model, capsules.joints, capsules.ends)
    below = int(model.chains[DofGroup.WAIST].column.joints[0])
    levers[:, : UP + 2 - ASIDE] = 1.0
    levers[:, UP + 2 - ASIDE : OF_HIPS] = float(np.linalg.norm(model.offsets[below])) + _apart(model)
    levers[:, OF_HIPS : HEAD_TURN - ASIDE] = spans[:, None]
    head = model.capsules_of(DofGroup.HEAD).indices
    levers[head, CHEST_TURN - ASIDE : HEAD_TURN - ASIDE] *= 2.0
    levers[head, HEAD_TURN - ASIDE :] = spans[head, None]
    return levers


def _apart(model: BodyModel) -> float:
    """Metres from the hips joint to the middle between those of the legs."""
    return float(np.linalg.norm(model.offsets[model.figure.legs[:, 0]].mean(axis=0)))


def _lengths(model: BodyModel, joints: Indices, ends: Floats) -> Floats:
    """How far the axes of capsules (C,), on joints and with ends (C, 6) in their frames, get from the hips, metres."""
    out: Floats = np.linalg.norm(ends.reshape(-1, 2, 3), axis=2).max(axis=1)
    for c, joint in enumerate(joints):
        at = int(joint)
        while at > 0:
            out[c] += np.linalg.norm(model.offsets[at])
            at = int(model.parents[at])
    return out


def _stride_levers(model: BodyModel) -> tuple[Floats, Floats, Floats]:
    """Levers of pelvis and legs in the pelvis frame for the stride (C, 3) and a unit of lowering (C,).

    And those of the pelvis frame itself for the stride (3,). They are measured, half of them upright, where knees snap
    most, and a quarter more is taken.
    """
    drawn = evenly_spread(_STRIDES, len(_VELOCITIES) + 2)
    states, lowerings = np.zeros((_STRIDES, ROOT_STATE)), _LOWEST * np.maximum(2.0 * drawn[:, -1] - 1.0, 0.0)
    states[:, 3:6] = _VELOCITIES[:, 0] + drawn[:, :3] * np.ptp(_VELOCITIES, axis=1)
    states[:, 6] = drawn[:, 3]
    begin, height = _seen_from_pelvis(model, states, lowerings)
    ways, bobs = [], []
    for row in np.eye(ROOT_STATE + 1)[[3, 4, 5, 6, ROOT_STATE]]:
        after, higher = _seen_from_pelvis(model, states + _STEP * row[:-1], lowerings + _STEP * row[-1])
        ways.append(np.linalg.norm(after - begin, axis=2).max(axis=(1, 2)))
        bobs.append(np.abs(higher - height).max())
    ahead, aside, turn, phase, lowering = _SPARE / _STEP * np.array(ways)
    ahead_bob, aside_bob, turn_bob, phase_bob, _ = _SPARE / _STEP * np.array(bobs)
    levers = np.stack([np.hypot(ahead, aside), turn, phase], axis=1)
    return levers, lowering, np.array([np.hypot(ahead_bob, aside_bob), turn_bob, phase_bob])


def _foot_levers(model: BodyModel) -> tuple[Floats, Floats]:
    """Levers of pelvis and legs in the root's frame for the moves of feet and hips (C, K), and of the hips (K,).

    They are measured, on feet everywhere within a stride and some beyond reach, and a quarter more is taken.
    """
    gait, drawn = model.gait, evenly_spread(_STRIDES, len(_FEET_AT) * 2 + len(_VELOCITIES) + 2 + OF_HIPS)
    rows, lowerings = np.zeros((_STRIDES, SHOWN)), _LOWEST * np.maximum(2.0 * drawn[:, 0] - 1.0, 0.0)
    rows[:, 6] = drawn[:, 1]
    rows[:, 3:6] = _VELOCITIES[:, 0] + drawn[:, 2:5] * np.ptp(_VELOCITIES, axis=1)
    rows[:, ASIDE : ASIDE + OF_HIPS] = _CARRIED_AT[:, 0] + drawn[:, -OF_HIPS:] * np.ptp(_CARRIED_AT, axis=1)
    rows[:, ASIDE : UP + 2] *= gait.scale
    sizes = np.array([gait.scale, gait.scale, 1.0, 1.0, gait.scale, 1.0])
    for side, part in enumerate(np.split(drawn[:, 5:-OF_HIPS], 2, axis=1)):
        foot = sizes * (_FEET_AT[:, 0] + part * np.ptp(_FEET_AT, axis=1))
        foot[:, 0] += gait.legs[side, 0]
        rows[:, ROOT_STATE + FOOT * side :][:, : len(sizes)] = foot
    begin, ways, dips = _seen_from_root(model, rows, lowerings), [], []
    feet = (ROOT_STATE + FOOT * side + i for side in range(2) for i in range(len(_FEET_AT)))
    for column in (*range(3, 7), *feet, *range(ASIDE, ASIDE + OF_HIPS)):
        moved = rows.copy()
        moved[:, column] += _STEP
        after = _seen_from_root(model, moved, lowerings)
        ways.append(np.linalg.norm(after[0] - begin[0], axis=2).max(axis=(1, 2)))
        dips.append(np.abs(after[1] - begin[1]).max())
    legs, hips = (_SPARE / _STEP * np.array(found) for found in (ways, dips))
    return _joined(legs).T, _joined(hips)


def _joined(levers: Floats) -> Floats:
    """Levers (21 or so, ...) for each number told of root, feet and hips, as those (K, ...) for `_moves_of_feet`."""
    of_root, of_feet = levers[:4], levers[4:-OF_HIPS].reshape(2, len(_FEET_AT), *levers.shape[1:])
    ground = np.hypot(of_feet[:, :1], of_feet[:, 1:2])
    feet = np.concatenate([ground, of_feet[:, 2:]], axis=1).reshape(-1, *levers.shape[1:])
    joined: Floats = np.concatenate([np.hypot(of_root[:1], of_root[1:2]), of_root[2:], feet, levers[-OF_HIPS:]])
    return joined


def _seen_from_root(model: BodyModel, rows: Floats, lowerings: Floats) -> tuple[Floats, Floats]:
    """The ends (C, 2, 3, N) of the capsules of pelvis and legs in the root's frame, and how deep the hips are (N,)."""
    ends = leg_capsules(model, rows, lowerings).astype(np.float64).reshape(len(model.roots.radii), 2, 3, -1)
    return ends, lower_body(model.gait, rows, lowerings)[1][:, 0]


def _seen_from_pelvis(model: BodyModel, states: Floats, lowerings: Floats) -> tuple[Floats, Floats]:
    """The ends (C, 2, 3, N) of the capsules of pelvis and legs in the pelvis frame, and its height (N,)."""
    ends = leg_capsules(model, states, lowerings).astype(np.float64).reshape(len(model.roots.radii), 2, 3, -1)
    places, _ = pelvis_frames(model, states)
    return ends - places.T, places[:, 1]


def _columns(group: DofGroup) -> slice:
    first = MOVES * LOCAL_GROUPS.index(group)
    return slice(first, first + MOVES)
