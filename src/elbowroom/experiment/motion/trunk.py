"""Hips and trunk in a steady walk, as seen along the way that is walked."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.skeleton import Skeleton
from elbowroom.experiment.judge.poses import Posed
from elbowroom.experiment.motion.cycles import in_strides, mean_range
from elbowroom.experiment.motion.walked import RATE

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Trunk:
    """Whole ranges in a stride."""

    up_down: float  # centimetres, of the hips joint
    side: float  # centimetres
    rotation: float  # degrees, of the pelvis about the vertical
    list: float  # degrees, of the pelvis about the way ahead
    thorax: float  # degrees, of the chest about the vertical
    against: float  # how chest and pelvis turn together: -1 against each other, 1 together; 0 where one does not turn
    ripple: float  # m/s, of the hips' speed ahead


def trunk(joints: Posed, skeleton: Skeleton, roots: Floats) -> Trunk:
    """The figures of a steady walk with root states (N, 7)."""
    phase, headings = roots[:, 6], roots[:, 2]
    hips, chest = skeleton.index("hips"), chest_joint(skeleton)
    places = _along(joints.positions[:, hips] - joints.positions[0, hips], headings)
    pelvis, thorax = (turned_about(joints.rotations[:, joint], headings) for joint in (hips, chest))
    ahead = RATE * np.gradient(places[:, 2])
    return Trunk(
        up_down=100.0 * mean_range(places[:, 1], phase),
        side=100.0 * mean_range(places[:, 0], phase),
        rotation=mean_range(pelvis[:, 0], phase),
        list=mean_range(pelvis[:, 1], phase),
        thorax=mean_range(thorax[:, 0], phase),
        against=_together(pelvis[:, 0], thorax[:, 0], phase),
        ripple=mean_range(ahead, phase),
    )


def chest_joint(skeleton: Skeleton) -> int:
    """The topmost spine joint that an avatar has."""
    return next(skeleton.index(bone) for bone in ("upperChest", "chest", "spine", "hips") if skeleton.has(bone))


def turned_about(rotations: Floats, headings: Floats) -> Floats:
    """How far a part with world rotations (N, 3, 3) is turned left, and its left side raised, degrees (N, 2)."""
    left = _along(rotations[:, :, 0], headings)
    angles = np.arctan2(-left[:, 2], left[:, 0]), np.arcsin(np.clip(left[:, 1], -1.0, 1.0))
    degrees: Floats = np.degrees(np.stack(angles, axis=1))
    return degrees


def _along(vectors: Floats, headings: Floats) -> Floats:
    """Vectors (N, 3) in the axes of who faces the headings (N,)."""
    c, s = np.cos(headings), np.sin(headings)
    x, y, z = vectors.T
    seen: Floats = np.stack([x * c - z * s, y, x * s + z * c], axis=1)
    return seen


def _together(first: Floats, second: Floats, phase: Floats) -> float:
    a, b = in_strides(first, phase), in_strides(second, phase)
    a, b = a - a.mean(), b - b.mean()
    size = float(np.sqrt((a * a).sum() * (b * b).sum()))
    return float((a * b).sum()) / size if size > 1e-3 else 0.0
