"""Levers: how fast, at most, any point of a capsule's axis moves for a unit of rate of what moves it.

Points on rigid links: a point at distance r from the axis of a joint that turns at the rate w moves at most at r w, and
speeds of joints along a chain add up. Distances are sums of bone lengths, so they hold in every posture. What the
stride does to the legs is no chain of joints that turn at known rates: that is measured, over strides of all kinds.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import CHILDREN, LOCAL_GROUPS, LOWERING, DofGroup
from elbowroom.body.gait import hips_sinks
from elbowroom.body.kinematics import BodyModel, leg_capsules, pelvis_frames
from elbowroom.body.root import ROOT_STATE
from elbowroom.planning.exact.lattice.drawing import evenly_spread
from elbowroom.planning.model.limb import Limb, limb_of
from elbowroom.planning.model.self_pairs import SelfPairs

Floats = NDArray[np.float64]

ROTATION = 1.15  # a rotation vector of up to 1.7 rad changes at most so much faster than the rotation turns
MOVES = 3  # columns of a limb's moves, and of a stride's
_LOWERING = LOWERING - DofGroup.WAIST.at.start - 1  # its column among the waist's moves
_STRIDES, _STEP, _SPARE = 2048, 1e-3, 1.25  # strides that are measured, by changes so small; what others may do more
_VELOCITIES = np.array([[-1.5, 3.0], [-1.0, 1.0], [-2.5, 2.5]])  # m/s ahead and to the left, rad/s
_LOWEST = 0.7  # half leg lengths


def lift_of(model: BodyModel) -> float:
    """How far the hips move, down and back, for a unit of lowering, metres."""
    return float(np.linalg.norm(hips_sinks(model.gait.half_leg, np.zeros(1), np.ones(1))))


def levers_of(model: BodyModel, limb: Limb) -> Floats:
    """Levers (C, 3) of a limb's capsules in the frame that carries it, m/s.

    The columns belong to the rate of the first two components together, of the third and of the fourth. Waist: bend
    and twist turn each spine joint by its part, neck and head back by theirs; the third lowers all. Arm: the
    swing turns it about the shoulder, the third component about the upper arm's own axis, the fourth about the elbow.
    """
    chain = limb.chain
    return _arm_levers(model, limb) if chain.is_arm else _column_levers(model, limb, chain.start)


def _column_levers(model: BodyModel, limb: Limb, frame: int) -> Floats:
    """Levers of a column's capsules as seen from a joint of it, or from the one that it hangs on."""
    chain = limb.chain
    levers, above = np.zeros((len(chain.joints), MOVES)), [frame]
    if chain.carries and frame == chain.start:
        levers[:, _LOWERING] = lift_of(model)
    while (parent := int(model.parents[above[-1]])) >= 0:
        above.append(parent)
    turning = dict(zip(chain.column.joints.tolist(), np.abs(chain.column.shares).tolist(), strict=True))
    for c, joint in enumerate(chain.joints):
        ends = chain.ends[c].reshape(2, 3)
        far, speed, at = float(np.linalg.norm(ends, axis=1).max()), 0.0, int(joint)
        while at not in above:
            speed += turning.get(at, 0.0) * far
            far += float(np.linalg.norm(model.offsets[at]))
            at = int(model.parents[at])
        for below in above[: above.index(at)][::-1]:
            far += float(np.linalg.norm(model.offsets[below]))
            speed += turning.get(below, 0.0) * far
        levers[c, 0] = ROTATION * speed
    return levers


def _arm_levers(model: BodyModel, limb: Limb) -> Floats:
    chain = limb.chain
    levers = np.zeros((len(chain.joints), 3))
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


def stride_levers(model: BodyModel) -> tuple[Floats, Floats]:
    """Levers (C, 3) of pelvis and legs in the pelvis frame, and (C,) for a unit of lowering.

    The columns belong to the rates of the velocity over the ground (m for each m/s), of the turning rate (m for each
    rad/s) and of the phase (m for each stride). They are measured, half of them upright, where knees snap most, and a
    quarter more is taken.
    """
    drawn = evenly_spread(_STRIDES, len(_VELOCITIES) + 2)
    states, lowerings = np.zeros((_STRIDES, ROOT_STATE)), _LOWEST * np.maximum(2.0 * drawn[:, -1] - 1.0, 0.0)
    states[:, 3:6] = _VELOCITIES[:, 0] + drawn[:, :3] * np.ptp(_VELOCITIES, axis=1)
    states[:, 6] = drawn[:, 3]
    begin = _seen_from_pelvis(model, states, lowerings)
    steps = [(_seen_from_pelvis(model, states + _STEP * row, lowerings)) for row in np.eye(ROOT_STATE)[3:]]
    steps.append(_seen_from_pelvis(model, states, lowerings + _STEP))
    ways = np.stack([np.linalg.norm(after - begin, axis=2).max(axis=(1, 2)) for after in steps], axis=1)
    ahead, aside, turn, phase, lowering = (_SPARE / _STEP * ways).T
    return np.stack([np.hypot(ahead, aside), turn, phase], axis=1), lowering


def _seen_from_pelvis(model: BodyModel, states: Floats, lowerings: Floats) -> Floats:
    """The ends (C, 2, 3, N) of the capsules of pelvis and legs in the pelvis frame."""
    ends = leg_capsules(model, states, lowerings).astype(np.float64).reshape(len(model.roots.radii), 2, 3, -1)
    return ends - pelvis_frames(model, states)[0].T


def own_levers(model: BodyModel, pairs: SelfPairs, carried: Floats) -> Floats:
    """How far the two of each pair of a body can move against each other (P, M) for a unit of each of its M moves.

    The moves are those of the local groups, one after the other, and of the stride: as `own_moves` has them. A pair
    with pelvis or legs is seen from the pelvis, any other from the chest. `carried` (3,) are the levers of what the
    waist carries.
    """
    count, waist = len(model.body.radii), DofGroup.WAIST
    from_pelvis, from_chest = np.zeros((2, count, (len(LOCAL_GROUPS) + 1) * MOVES))
    for group in CHILDREN:
        parts, at = model.capsules_of(group).indices, _columns(group)
        from_pelvis[parts, at] = from_chest[parts, at] = levers_of(model, limb_of(model, group))
        from_pelvis[parts, _columns(waist)] = carried
    trunk, legs, limb = model.capsules_of(waist).indices, model.roots.indices, limb_of(model, waist)
    from_pelvis[trunk, _columns(waist)] = levers_of(model, limb)
    from_chest[trunk, _columns(waist)] = _column_levers(model, limb, limb.chain.end)
    strides, lowered = stride_levers(model)
    from_pelvis[legs, -MOVES:] = strides
    from_pelvis[legs, _columns(waist).start + _LOWERING] = lowered
    beside_legs = np.isin(pairs.first, legs) | np.isin(pairs.second, legs)
    levers: Floats = np.where(
        beside_legs[:, None],
        from_pelvis[pairs.first] + from_pelvis[pairs.second],
        from_chest[pairs.first] + from_chest[pairs.second],
    )
    return levers


def _columns(group: DofGroup) -> slice:
    first = MOVES * LOCAL_GROUPS.index(group)
    return slice(first, first + MOVES)
