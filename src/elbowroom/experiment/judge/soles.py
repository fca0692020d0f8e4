"""What counts as the ground under the feet: how much of a foot may be in what it stands on.

In a walk on level ground a foot is on it, and a little of what stands for it is in it: of the capsule, which is larger
than the foot, and of the mesh where a heel strikes. Where feet stand on obstacles the same is allowed, and 3 mm more:
at each moment feet and toes are held against what stands as much higher as they are below level ground in the same
stride there; on a slope, at right angles to that. So raised they must be free, like everything else; only the soles may
be in what they stand on.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import HEIGHT, RISES, ROOT_STATE
from elbowroom.experiment.judge.capsule_shapes import CapsuleShapes
from elbowroom.experiment.judge.motion import Moments, ShownMotion
from elbowroom.experiment.judge.poses import Posed, Poser
from elbowroom.experiment.judge.skin import Skin

Floats = NDArray[np.float64]

IN_GROUND = 0.003  # metres that a sole may be in what it stands on
_SIDES = ("left", "right")


class RaisedSoles:
    """How much higher the feet of one avatar are held against obstacles, in one motion."""

    def __init__(self, humanoid: Humanoid, poser: Poser, motion: ShownMotion, *, floors: bool = False) -> None:
        """`floors` says whether all floors are in the way, those at height 0 too."""
        skeleton, self._poser, self._humanoid = poser.skeleton, poser, humanoid
        self._feet = [
            [skeleton.index(side + part) for part in ("Foot", "Toes") if skeleton.has(side + part)] for side in _SIDES
        ]
        told = motion.roots[:, RISES + 1 : ROOT_STATE : 2]  # how the ground under both feet slopes
        self._slopes = np.abs(told) if told.shape[1] == len(_SIDES) else np.zeros((len(motion), len(_SIDES)))
        self._level: ShownMotion | None = None  # the same strides on the plane; None where nothing but it is stood on
        if floors or np.abs(motion.roots[:, HEIGHT:ROOT_STATE]).max(initial=0.0) > 0.0:
            roots = motion.roots.copy()
            roots[:, HEIGHT] = roots[:, RISES:ROOT_STATE] = 0.0
            self._level = replace(motion, roots=roots)

    def raised(self, posed: Posed, moments: Moments, skin: Skin | None = None) -> Posed:
        """The poses at some moments with the feet as high as those of the capsules are held, or those of a skin."""
        if self._level is None:
            return posed
        level, positions = self._poser.at(self._level, moments), posed.positions.copy()
        slopes = np.minimum(self._slopes[moments.first], self._slopes[moments.second])
        for joints, slope in zip(self._feet, slopes.T, strict=True):
            lowest = self._capsules_over(level, joints) if skin is None else _skin_over(level, skin, joints)
            positions[:, joints, 1] += (IN_GROUND + np.maximum(-lowest, 0.0) / np.cos(slope))[:, None]
        return Posed(positions, posed.rotations)

    def _capsules_over(self, posed: Posed, joints: list[int]) -> Floats:
        """The height (N,) of the lowest point of the capsules on some joints."""
        shapes = CapsuleShapes(self._humanoid)
        placed, which = shapes.placed(posed), np.isin(self._humanoid.capsules.joints, joints)
        heights = placed.middles[..., 1] - np.abs(placed.half_axes[..., 1]) - shapes.radii
        lowest: Floats = heights[:, which].min(axis=1)
        return lowest


def _skin_over(posed: Posed, skin: Skin, joints: list[int]) -> Floats:
    """The height (N,) of the lowest vertex that follows some joints most."""
    lowest: Floats = skin.vertices(posed, skin.most_on(joints))[..., 1].min(axis=1)
    return lowest
