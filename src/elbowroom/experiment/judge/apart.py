"""Two bodies against each other: whether the capsules of one ever touch those of the other, by the other library."""

from typing import NamedTuple

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.judge.capsule_shapes import CapsuleShapes, PlacedCapsules
from elbowroom.experiment.judge.motion import Moments, ShownMotion
from elbowroom.experiment.judge.obstacles import coal_library
from elbowroom.experiment.judge.poses import Poser

_AT_ONCE = 60  # poses
_TOLERANCE = 1e-5  # metres inside each other that are no contact: rounding


class ShownWalker(NamedTuple):
    """Who was shown."""

    humanoid: Humanoid
    motion: ShownMotion


class Apart(NamedTuple):
    """How two bodies were to each other."""

    touching: int  # poses
    deepest: float  # metres, 0 where they never touch


def judge_apart(one: ShownWalker, other: ShownWalker, rate: float = 240.0) -> Apart:
    """Judge two motions of the same frames, `rate` poses a second."""
    judge, moments = _Judge(one.humanoid, other.humanoid), one.motion.moments(rate)
    touching, deepest = 0, 0.0
    for first in range(0, len(moments.times), _AT_ONCE):
        some = moments.part(slice(first, first + _AT_ONCE))
        depths = judge.depths(one.motion, other.motion, some)
        touching += int((depths > _TOLERANCE).sum())
        deepest = max(deepest, float(depths.max()))
    return Apart(touching, deepest if touching else 0.0)


class _Judge:
    """Judges the collision bodies of two avatars."""

    def __init__(self, one: Humanoid, other: Humanoid) -> None:
        self._coal = coal_library()
        self._shapes = CapsuleShapes(one), CapsuleShapes(other)
        self._posers = Poser(one), Poser(other)
        self._request = self._coal.DistanceRequest()
        self._radii = self._shapes[0].radii[:, None] + self._shapes[1].radii

    def depths(self, one: ShownMotion, other: ShownMotion, some: Moments) -> np.ndarray:
        """How deep (N,) the bodies are in each other at some moments, metres; 0 where they are apart."""
        first, second = (
            shapes.placed(poser.at(motion, some))
            for shapes, poser, motion in zip(self._shapes, self._posers, (one, other), strict=True)
        )
        away = np.linalg.norm(first.middles[:, :, None] - second.middles[:, None], axis=3)
        halves = (np.linalg.norm(each.half_axes, axis=2) for each in (first, second))
        near = away - next(halves)[:, :, None] - next(halves)[:, None] - self._radii < 0.0
        depths = np.zeros(len(some.times))
        for pose, a, b in np.argwhere(near).tolist():
            depths[pose] = max(depths[pose], -self._distance(first, second, pose, a, b))
        return depths

    def _distance(self, first: PlacedCapsules, second: PlacedCapsules, pose: int, a: int, b: int) -> float:
        one, other = self._shapes
        result = self._coal.DistanceResult()
        at, there = one.place(first, pose, a), other.place(second, pose, b)
        return float(self._coal.distance(one.shapes[a], at, other.shapes[b], there, self._request, result))
