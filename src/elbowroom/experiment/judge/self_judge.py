"""A body against itself: arms against trunk, head, legs and each other, these against legs, by the other library.

Capsules wrap the mesh generously, and some builds hold their arms against their sides. So what counts is how much
deeper two parts are in each other than ever in the natural walk of this avatar, for upper arm and head also where it
looks over a shoulder; that is measured here, once, on poses of the judge's own. What a joint holds together is not
looked at: parts of one arm, the trunk's parts, trunk and pelvis, and an upper arm against pelvis and trunk below the
neck.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bones import SPINE
from elbowroom.body.dof import ARMS, DOF, DofGroup, limits
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.made_once import made_once
from elbowroom.body.root import ROOT_STATE
from elbowroom.experiment.judge.capsule_shapes import CapsuleShapes, PlacedCapsules
from elbowroom.experiment.judge.case import Case
from elbowroom.experiment.judge.nearest_first import nearest_first
from elbowroom.experiment.judge.obstacles import coal_library
from elbowroom.experiment.judge.poses import Posed, Poser
from elbowroom.experiment.judge.stretches import stretches_of
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_AT_ONCE = 32  # pairs, each in a stretch, that are looked at before the limit is asked again

_SPEEDS = (0.0, 0.5, 1.1, 1.6, 2.2)  # m/s of the natural walk
_PHASES = 24
_CREASE = 0.02  # metres that belly and thighs may be deeper in each other: flesh gives where hips flex
_BALLS = 4  # along an axis
_ROW = (2.0 * np.arange(_BALLS) + 1.0) / _BALLS - 1.0  # their places, in half lengths from the middle


@made_once
def self_judge(humanoid: Humanoid) -> "SelfJudge":
    """That of an avatar; it measures the natural walk once."""
    return SelfJudge(humanoid)


class SelfJudge:
    """Judges one avatar's collision body against itself."""

    def __init__(self, humanoid: Humanoid) -> None:
        self._coal, self._shapes = coal_library(), CapsuleShapes(humanoid)
        self._pairs = _pairs(humanoid)
        self._lengths = np.linalg.norm(humanoid.capsules.ends - humanoid.capsules.starts, axis=1)
        self._request = self._coal.DistanceRequest()
        natural = self._shapes.placed(_natural_poses(humanoid))
        every, ahead = range(len(natural.turns)), range(len(natural.turns) // 3)
        looks = [every if aside else ahead for aside in _shoulders(humanoid, self._pairs)]
        self._natural = np.array(
            [
                min(0.0, *(self._distance(natural, n, a, b) for n in poses))
                for (a, b), poses in zip(self._pairs, looks, strict=True)
            ]
        )
        self._natural[_creases(humanoid, self._pairs)] -= _CREASE

    def allowed(self) -> dict[tuple[int, int], float]:
        """How near the pairs of capsules that are looked at may come without a tolerance, metres; below 0 is inside."""
        pairs: list[list[int]] = np.sort(self._pairs, axis=1).tolist()
        return {(one, other): float(near) for (one, other), near in zip(pairs, self._natural, strict=True)}

    def judge(self, case: Case) -> None:
        """Enter what the parts do."""
        posed = case.posed
        still = Posed(posed.positions - posed.positions[:, :1], posed.rotations)  # about the hips: it moves less
        placed, stretches = self._shapes.placed(still), stretches_of(still)
        one, other = self._pairs.T
        away, every = self._shapes.away(stretches), np.arange(len(one))
        wide = self._bounds(placed, stretches.middles[:, None], every) - away[:, one] - away[:, other]  # (S, P)
        for some, pairs in nearest_first(wide, lambda: case.ledger.depth_limit, _AT_ONCE):
            rows = stretches.rows(some)
            of_row = np.broadcast_to(pairs[:, None], rows.shape)
            self._judge_near(placed, rows.ravel(), of_row.ravel(), case)

    def _judge_near(self, placed: PlacedCapsules, rows: Ints, pairs: Ints, case: Case) -> None:
        """Enter what pairs (n,) do at poses `rows` (n,)."""
        bounds = self._bounds(placed, rows, pairs)
        for (some,) in nearest_first(bounds, lambda: case.ledger.depth_limit, 1):
            pose, pair = int(rows[some[0]]), int(pairs[some[0]])
            one, other = (int(i) for i in self._pairs[pair])
            beyond = self._distance(placed, pose, one, other) - self._natural[pair]
            case.enter(pose, self._shapes.names[one], self._shapes.names[other], float(beyond))

    def _bounds(self, placed: PlacedCapsules, poses: Ints, pairs: Ints) -> Floats:
        """A lower bound of the distances of pairs at poses: that of the nearest two of the balls round two axes."""
        one, other = self._pairs[pairs].T
        size = 0.5 * self._lengths / _BALLS + self._shapes.radii
        begins, ends = (
            placed.middles[poses, each][..., None, :] + _ROW[:, None] * placed.half_axes[poses, each][..., None, :]
            for each in (one, other)
        )
        between = begins[..., :, None, :] - ends[..., None, :, :]  # (..., _BALLS, _BALLS, 3)
        apart = np.einsum("...i,...i->...", between, between).min(axis=(-1, -2))
        bounds: Floats = np.sqrt(apart) - size[one] - size[other] - self._natural[pairs]
        return bounds

    def _distance(self, placed: PlacedCapsules, pose: int, one: int, other: int) -> float:
        shapes, places = self._shapes.shapes, [self._shapes.place(placed, pose, part) for part in (one, other)]
        result = self._coal.DistanceResult()
        return float(self._coal.distance(shapes[one], places[0], shapes[other], places[1], self._request, result))


def _pairs(humanoid: Humanoid) -> NDArray[np.int64]:
    """The capsules (P, 2) that are not held together by a joint."""
    capsules, names = humanoid.capsules, humanoid.skeleton.names
    bones = [names[joint] for joint in capsules.joints]
    left, right = ([i for i, group in enumerate(capsules.groups) if group is arm] for arm in ARMS)
    rest = [i for i, group in enumerate(capsules.groups) if not group.is_arm]
    rooted = [i for i in rest if bones[i] in (*SPINE, "hips")]
    pairs = [
        (one, other)
        for arm in (left, right)
        for one in arm
        for other in rest
        if not (bones[one].endswith("UpperArm") and other in rooted)
    ]
    pairs += [(one, other) for one in left for other in right]
    trunk = [i for i, group in enumerate(capsules.groups) if group is DofGroup.WAIST]
    legs = [i for i, group in enumerate(capsules.groups) if group is DofGroup.ROOT and bones[i] != "hips"]
    pairs += [(one, other) for one in trunk for other in legs]
    head = [i for i, group in enumerate(capsules.groups) if group is DofGroup.HEAD]
    below = [i for i, group in enumerate(capsules.groups) if group is DofGroup.ROOT]
    return np.array(pairs + [(one, other) for one in head for other in below], np.int64)


def _creases(humanoid: Humanoid, pairs: NDArray[np.int64]) -> NDArray[np.bool_]:
    """Which pairs (P, 2) are the lowest part of the trunk and a thigh."""
    names = humanoid.skeleton.names
    bones = np.array([names[joint] for joint in humanoid.capsules.joints])
    belly = next(bone for bone in SPINE if bone in names)
    creases: NDArray[np.bool_] = (bones[pairs[:, 0]] == belly) & np.char.endswith(bones[pairs[:, 1]], "UpperLeg")
    return creases


def _shoulders(humanoid: Humanoid, pairs: NDArray[np.int64]) -> list[bool]:
    """Which pairs (P, 2) are an upper arm and the head or neck: an arm can do nothing about a head that turns to it."""
    bones = [humanoid.skeleton.names[joint] for joint in humanoid.capsules.joints]
    groups = humanoid.capsules.groups
    return [bones[one].endswith("UpperArm") and groups[other] is DofGroup.HEAD for one, other in pairs.tolist()]


def _natural_poses(humanoid: Humanoid) -> Posed:
    """The avatar standing and walking, at several speeds and phases of the stride.

    In the first third it looks ahead, in the others as far as it can to either side.
    """
    roots = np.zeros((len(_SPEEDS) * _PHASES, ROOT_STATE))
    roots[:, 3] = np.repeat(_SPEEDS, _PHASES)
    roots[:, 6] = np.tile(np.arange(_PHASES) / _PHASES, len(_SPEEDS))
    uppers = natural_walk()(RootPath(0.0, 1.0, roots))
    ahead = np.concatenate([np.zeros((len(roots), DOF - uppers.shape[1])), uppers], axis=1)
    q, turn = np.tile(ahead, (3, 1)), DofGroup.HEAD.at.start + 1
    q[len(roots) :, turn] = np.repeat(limits(DofGroup.HEAD)[1], len(roots))
    roots = np.tile(roots, (3, 1))
    poser = Poser(humanoid)
    return poser.world(*poser.local(q, roots), roots[:, :3])
