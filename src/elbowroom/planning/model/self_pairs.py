"""Which parts of a body must not run into each other, and by how much they may: arms, trunk, head and legs.

A pair of capsules may overlap by 2 cm, as capsules wrap the mesh generously and contact of their rims is no contact of
bodies; or that much more than it does when the avatar stands and walks naturally, as some builds leave it no choice.
So the natural walk is free for every avatar. Not looked at is what a joint holds together: the parts of one arm, the
parts of the trunk, and an upper arm against the trunk below the neck, where its shoulder is rooted.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import ARMS, DOF, LOCAL_GROUPS, DofGroup
from elbowroom.body.kinematics import BodyModel, chest_frames, pelvis_frames, posture_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.jit import kernel
from elbowroom.planning.goal import GoalFunction, natural_walk
from elbowroom.planning.model.axis_distances import clear_pairs, pair_clearances
from elbowroom.planning.model.frames import compose
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

SKIN = 0.02  # metres
EXEMPT = -1e3  # metres: a pair that is not looked at
_SPEEDS = (0.0, 0.6, 1.1, 2.2)  # m/s of the natural walk
_PHASES = 16


class SelfPairs(NamedTuple):
    """One avatar's own body: K parts that are not of an arm, and the arms' parts, as indices of its capsules."""

    rest: Indices  # (K,) pelvis and legs, trunk, neck, head
    arms: tuple[Indices, Indices]  # (C,) left, right
    allowed: tuple[Floats32, Floats32]  # (C, K) metres: least distance of the axes; `EXEMPT`
    between: Floats32  # (C, C) of left and right arm
    first: Indices  # (P,) the same as a list of all pairs that are looked at: one capsule
    second: Indices  # (P,) and the other
    kinds: Indices  # (P,) 0: left arm and body, 1: right arm and body, 2: the arms
    limits: Floats32  # (P,) metres


def self_pairs(model: BodyModel, goals: GoalFunction | None = None) -> SelfPairs:
    """Measure the natural walk of a body, or what `goals` make of it."""
    rest = np.concatenate([model.roots.indices, model.capsules_of(DofGroup.WAIST).indices])
    joints = np.concatenate([model.roots.joints, model.capsules_of(DofGroup.WAIST).joints])
    left, right = (model.capsules_of(arm).indices for arm in ARMS)
    arms = left, right
    natural = _natural_walk(model, goals or natural_walk())
    head = np.isin(joints, model.gaze)

    def allowed(one: Indices, other: Indices) -> Floats32:
        touching = model.body.radii[one][:, None] + model.body.radii[other]
        distances = np.array([[clear_pairs(natural[a], natural[b]).min() for b in other] for a in one])
        least: Floats32 = (np.minimum(distances, touching) - SKIN).astype(np.float32)
        return least

    limits = tuple(allowed(arm, rest) for arm in arms)
    for limit in limits:
        limit[0, ~head] = EXEMPT
    between = allowed(*arms)
    listed = [
        (arm[c], rest[k], side, limit[c, k])
        for side, (arm, limit) in enumerate(zip(arms, limits, strict=True))
        for c, k in np.argwhere(limit > EXEMPT)
    ]
    listed += [(arms[0][c], arms[1][k], 2, between[c, k]) for c, k in np.ndindex(between.shape)]
    first, second, kinds, least = zip(*listed, strict=True)
    return SelfPairs(
        rest, arms, (limits[0], limits[1]), between, np.array(first), np.array(second),
        np.array(kinds), np.array(least, np.float32),
    )  # fmt: skip


def _natural_walk(model: BodyModel, goals: GoalFunction) -> Floats32:
    """All capsules (C, 6, N) over strides at several speeds."""
    states = np.zeros((len(_SPEEDS) * _PHASES, ROOT_STATE))
    states[:, 3] = np.repeat(_SPEEDS, _PHASES)
    states[:, 6] = np.tile(np.arange(_PHASES) / _PHASES, len(_SPEEDS))
    return posture_capsules(model, _postures(goals(RootPath(0.0, 1.0, states))), states)


def _postures(uppers: Floats) -> Floats:
    """Configurations (N, DOF) at the origin for upper bodies (N, DOF - 3)."""
    out = np.zeros((len(uppers), DOF))
    out[:, DOF - uppers.shape[1] :] = uppers
    return out


def body_from_chest(model: BodyModel, pairs: SelfPairs, waists: Floats, roots: Floats) -> Floats32:
    """The parts that are not of an arm (K, 6, N) in the chest frame, for waists (N, d) and root states (N, 7)."""
    here = roots.copy()
    here[:, :3] = 0.0
    uppers = np.zeros((len(waists), sum(group.size for group in LOCAL_GROUPS)))
    uppers[:, : DofGroup.WAIST.size] = waists
    capsules = posture_capsules(model, _postures(uppers), here)[pairs.rest]
    return _into_frames(capsules, *compose(*pelvis_frames(model, here), *chest_frames(model, waists)))


def self_clearances(model: BodyModel, pairs: SelfPairs, roots: Floats, uppers: Floats) -> Floats32:
    """How much nearer parts could come to each other, the nearest pair's, metres: shape (3, N).

    Of left arm and body, right arm and body, left arm and right arm, for root states (N, 7) and upper bodies
    (N, DOF - 3): waist, left arm, right arm. Negative: in contact.
    """
    here = roots.copy()
    here[:, :3] = 0.0
    capsules = posture_capsules(model, _postures(uppers), here)
    return pair_clearances(capsules, pairs.first, pairs.second, pairs.kinds, pairs.limits, 3)


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
