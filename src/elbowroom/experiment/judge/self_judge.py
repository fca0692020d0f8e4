"""A body against itself: arms against trunk, head, legs and each other, these against legs, by the other library.

Capsules wrap the mesh generously, and some builds hold their arms against their sides. So what counts is how much
deeper two parts are in each other than ever in the natural walk of this avatar; that is measured here, once, on poses
of the judge's own. What a joint holds together is not looked at: parts of one arm, the trunk's parts, trunk and pelvis,
and an upper arm against pelvis and trunk below the neck.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bones import SPINE
from elbowroom.body.dof import ARMS, DOF, DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import ROOT_STATE
from elbowroom.experiment.judge.capsule_shapes import CapsuleShapes, Placed
from elbowroom.experiment.judge.ledger import Ledger, Nearness
from elbowroom.experiment.judge.obstacles import coal_library
from elbowroom.experiment.judge.poses import Posed, Poser
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]

_SPEEDS = (0.0, 0.5, 1.1, 1.6, 2.2)  # m/s of the natural walk
_PHASES = 24
_CREASE = 0.02  # metres that belly and thighs may be deeper in each other: flesh gives where hips flex
_BALLS = 4  # along an axis
_ROW = (2.0 * np.arange(_BALLS) + 1.0) / _BALLS - 1.0  # their places, in half lengths from the middle


class SelfJudge:
    """Judges one avatar's collision body against itself."""

    def __init__(self, humanoid: Humanoid) -> None:
        self._coal, self._shapes = coal_library(), CapsuleShapes(humanoid)
        self._pairs = _pairs(humanoid)
        self._lengths = np.linalg.norm(humanoid.capsules.ends - humanoid.capsules.starts, axis=1)
        self._request = self._coal.DistanceRequest()
        natural = self._shapes.placed(_natural_poses(humanoid))
        every = range(len(natural.turns))
        self._natural = np.array([min(0.0, *(self._distance(natural, n, a, b) for n in every)) for a, b in self._pairs])
        self._natural[_creases(humanoid, self._pairs)] -= _CREASE

    def allowed(self) -> dict[tuple[int, int], float]:
        """How near the pairs of capsules that are looked at may come without a tolerance, metres; below 0 is inside."""
        pairs: list[list[int]] = np.sort(self._pairs, axis=1).tolist()
        return {(one, other): float(near) for (one, other), near in zip(pairs, self._natural, strict=True)}

    def judge(self, posed: Posed, times: Floats, first: int, ledger: Ledger) -> None:
        """Enter what the parts do at N poses, whose numbers begin at `first`."""
        placed = self._shapes.placed(posed)
        bounds = self._bounds(placed)  # (N, P)
        for at in np.argsort(bounds, axis=None):
            pose, pair = (int(i) for i in np.unravel_index(at, bounds.shape))
            if bounds[pose, pair] > ledger.limit:
                return
            one, other = (int(i) for i in self._pairs[pair])
            beyond = self._distance(placed, pose, one, other) - self._natural[pair]
            names = self._shapes.names[one], self._shapes.names[other]
            ledger.enter(first + pose, Nearness(*names, float(times[pose]), float(beyond)))

    def _bounds(self, placed: Placed) -> Floats:
        """A lower bound of every distance: that of the nearest two of the balls in rows round two axes."""
        one, other = self._pairs.T
        size = 0.5 * self._lengths / _BALLS + self._shapes.radii
        rows = placed.middles[:, :, None] + _ROW[:, None] * placed.half_axes[:, :, None]  # (N, C, _BALLS, 3)
        apart = np.full((len(rows), len(one)), np.inf)
        for first in range(_BALLS):
            for second in range(_BALLS):
                between = rows[:, one, first] - rows[:, other, second]
                np.minimum(apart, np.einsum("npi,npi->np", between, between), out=apart)
        bounds: Floats = np.sqrt(apart) - size[one] - size[other] - self._natural
        return bounds

    def _distance(self, placed: Placed, pose: int, one: int, other: int) -> float:
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


def _natural_poses(humanoid: Humanoid) -> Posed:
    """The avatar standing and walking, at several speeds and phases of the stride."""
    roots = np.zeros((len(_SPEEDS) * _PHASES, ROOT_STATE))
    roots[:, 3] = np.repeat(_SPEEDS, _PHASES)
    roots[:, 6] = np.tile(np.arange(_PHASES) / _PHASES, len(_SPEEDS))
    uppers = natural_walk()(RootPath(0.0, 1.0, roots))
    q = np.concatenate([np.zeros((len(roots), DOF - uppers.shape[1])), uppers], axis=1)
    poser = Poser(humanoid)
    return poser.world(*poser.local(q, roots), roots[:, :3])
