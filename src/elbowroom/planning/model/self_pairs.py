"""Which parts of a body must not run into each other, and by how much they may: arms, trunk, head and legs.

A pair of capsules may overlap by 2 cm, as capsules wrap the mesh generously and contact of their rims is no contact of
bodies; or that much more than it does when the avatar stands and walks naturally, as some builds leave it no choice.
So the natural walk is free for every avatar. An upper arm and the head may do what they do when it looks over a
shoulder. Belly and thighs may overlap by 3.6 cm: they meet at the hips, where flesh
gives. Not looked at is what a joint holds together: the parts of one arm, the parts of the trunk, the trunk against the
pelvis, and an upper arm against the pelvis and the trunk below the neck, where its shoulder is rooted; who folds over
the thighs can bring it to the legs.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import CHILDREN, DOF, LOCAL, SEARCH_ORDER, DofGroup, columns_of, limits
from elbowroom.body.pose.kinematics import BodyModel, chest_frames, pelvis_frames, posture_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.by_reference import by_reference
from elbowroom.jit import kernel
from elbowroom.planning.goal import GoalFunction, natural_walk
from elbowroom.planning.model.axis_distances import clear_pairs, pair_clearances
from elbowroom.planning.model.frames import compose
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

OVERLAP = 0.02  # metres
CREASE = 0.036  # metres, of belly and thigh: flesh gives where hips flex; the judge allows 4 cm
EXEMPT = -1e3  # metres: a pair that is not looked at
_SPEEDS = (0.0, 0.6, 1.1, 2.2)  # m/s of the natural walk
_PHASES = 16


@by_reference
class SelfPairs(NamedTuple):
    """One avatar's own body: the parts of its groups that must not run into each other, by the table of groups."""

    capsules: dict[DofGroup, Indices]  # (C,) of each group
    allowed: dict[tuple[DofGroup, DofGroup], Floats32]  # (C, K) metres: least distance of the axes; `EXEMPT`
    first: Indices  # (P,) the same as a list of all pairs that are looked at: one capsule
    second: Indices  # (P,) and the other
    kinds: Indices  # (P,) the number in `SEARCH_ORDER` of the group that has to keep clear
    limits: Floats32  # (P,) metres

    def beside(self, group: DofGroup, others: tuple[DofGroup, ...]) -> tuple[Indices, Floats32]:
        """The capsules (K,) of other groups, and how near those of a group may come to them, (C, K) metres."""
        rows = [
            self.allowed[group, other] if (group, other) in self.allowed else self.allowed[other, group].T
            for other in others
        ]
        none = np.empty((len(self.capsules[group]), 0), np.float32)
        capsules = [self.capsules[other] for other in others]
        return np.concatenate([*capsules, np.empty(0, np.int64)]), np.concatenate([*rows, none], axis=1)


def carriers_of(group: DofGroup) -> tuple[DofGroup, ...]:
    """The groups, among those that a group must keep clear of, that are posed by the waist alone."""
    return tuple(other for other in group.clear_of if other not in CHILDREN)


def neighbours_of(group: DofGroup) -> tuple[DofGroup, ...]:
    """The groups that a group must keep clear of, and those that must keep clear of it."""
    return (*group.clear_of, *(other for other in CHILDREN if group in other.clear_of))


def self_pairs(model: BodyModel, goals: GoalFunction | None = None) -> SelfPairs:
    """Measure the natural walk of a body, or what `goals` make of it."""
    natural = _natural_walk(model, goals or natural_walk())
    capsules = {group: model.capsules_of(group).indices for group in DofGroup}
    allowed = {
        (group, other): _allowed(model, natural, group, other) for group in SEARCH_ORDER for other in group.clear_of
    }
    listed = [
        (capsules[group][c], capsules[other][k], SEARCH_ORDER.index(group), limit[c, k])
        for (group, other), limit in allowed.items()
        for c, k in np.argwhere(limit > EXEMPT)
    ]
    first, second, kinds, least = zip(*listed, strict=True)
    return SelfPairs(capsules, allowed, np.array(first), np.array(second), np.array(kinds), np.array(least, np.float32))


def _allowed(model: BodyModel, natural: Floats32, group: DofGroup, other: DofGroup) -> Floats32:
    """How near the axes of two groups may come to each other, (C, K) metres, for the natural walk (all, 6, N).

    Where a head turns to a shoulder the arm can do nothing about it; all else is measured where it looks ahead.
    """
    one, two = model.capsules_of(group), model.capsules_of(other)
    touching = one.radii[:, None] + two.radii
    ahead = np.ascontiguousarray(natural[..., : natural.shape[2] // 3])
    distances = np.array([[clear_pairs(ahead[a], ahead[b]).min() for b in two.indices] for a in one.indices])
    if group.is_arm and other is DofGroup.HEAD:
        shoulder = natural[one.indices[0]]
        distances[0] = [clear_pairs(shoulder, natural[b]).min() for b in two.indices]
    least: Floats32 = (np.minimum(distances, touching) - OVERLAP).astype(np.float32)
    if group not in CHILDREN:
        least[:, two.joints == model.chains[group].start] = EXEMPT  # it is rooted there
        belly, thighs = one.joints == model.chains[group].column.joints[0], np.isin(two.joints, model.tree.legs[:, 0])
        least[np.ix_(belly, thighs)] -= CREASE - OVERLAP
    elif group.is_arm and other not in CHILDREN:
        least[0, two.joints == 0 if other is DofGroup.ROOT else slice(None)] = EXEMPT  # its joint is rooted there
    return least


def _natural_walk(model: BodyModel, goals: GoalFunction) -> Floats32:
    """All capsules (C, 6, N) over strides at several speeds; the first third looks ahead, the others to either side."""
    states = np.zeros((len(_SPEEDS) * _PHASES, ROOT_STATE))
    states[:, 3] = np.repeat(_SPEEDS, _PHASES)
    states[:, 6] = np.tile(np.arange(_PHASES) / _PHASES, len(_SPEEDS))
    uppers, turn = np.tile(goals(RootPath(0.0, 1.0, states)), (3, 1)), columns_of(DofGroup.HEAD).start + 1
    uppers[len(states) :, turn] = np.repeat(limits(DofGroup.HEAD)[1], len(states))
    return posture_capsules(model, _postures(uppers), np.tile(states, (3, 1)))


def _postures(uppers: Floats) -> Floats:
    """Configurations (N, DOF) at the origin for upper bodies (N, LOCAL)."""
    out = np.zeros((len(uppers), DOF))
    out[:, DofGroup.ROOT.size :] = uppers
    return out


def with_waist(waists: Floats) -> Floats:
    """Upper bodies (N, LOCAL) with these waists (N, d), all else zero."""
    out = np.zeros((len(waists), LOCAL))
    out[:, columns_of(DofGroup.WAIST)] = waists
    return out


def seen_from_chest(model: BodyModel, uppers: Floats, roots: Floats) -> Floats32:
    """All capsules (all, 6, N) in the chest frame, for upper bodies (N, LOCAL) and root states (N, 7)."""
    here = roots.copy()
    here[:, :3] = 0.0
    postures = _postures(uppers)
    chests = chest_frames(model, np.ascontiguousarray(postures[:, DofGroup.WAIST.at]))
    segments = posture_capsules(model, postures, here)
    return _into_frames(segments, *compose(*pelvis_frames(model, here), *chests))


def self_clearances(model: BodyModel, pairs: SelfPairs, roots: Floats, uppers: Floats) -> Floats32:
    """How much nearer parts could come to each other, the nearest pair's, metres: shape (len(SEARCH_ORDER), N).

    A row holds the pairs of one group and those that it must keep clear of, for root states (N, 7) and upper bodies
    (N, LOCAL). Negative: in contact.
    """
    here = roots.copy()
    here[:, :3] = 0.0
    capsules = posture_capsules(model, _postures(uppers), here)
    return pair_clearances(capsules, pairs.first, pairs.second, pairs.kinds, pairs.limits, len(SEARCH_ORDER))


@kernel
def _into_frames(segments: Floats32, places: Floats, turns: Floats) -> Floats32:
    """Segments (K, 6, N) as seen from frames at `places` (N, 3) with unit quaternions `turns` (N, 4)."""
    out = np.empty(segments.shape, np.float32)
    for n in range(segments.shape[2]):
        x, y, z, w = -turns[n, 0], -turns[n, 1], -turns[n, 2], turns[n, 3]
        for k in range(segments.shape[0]):
            for e in range(0, 6, 3):
                a, b, c = segments[k, e, n] - places[n, 0], segments[k, e + 1, n] - places[n, 1], segments[k, e + 2, n]
                c -= places[n, 2]
                tx, ty, tz = 2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)
                out[k, e, n] = a + w * tx + y * tz - z * ty
                out[k, e + 1, n] = b + w * ty + z * tx - x * tz
                out[k, e + 2, n] = c + w * tz + x * ty - y * tx
    return out
