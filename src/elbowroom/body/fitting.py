"""Capsules sized from an avatar's own surface: for each part of the body the slimmest capsule that holds its points.

Every part starts from its capsule of average proportions and is then fitted: the volume of the capsule that holds the
wanted share of the part's points is minimised over its two ends (Nelder & Mead 1965). A capsule is convex, so one that
holds the vertices holds the triangles between them.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.capsules import Capsules
from elbowroom.body.nelder_mead import least_point
from elbowroom.body.proportions import last_spine, proportional_capsules, stature
from elbowroom.body.skeleton import Skeleton

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_SIDES = ("left", "right")
_LIMB_PARTS = {
    "UpperLeg": "Thigh",
    "LowerLeg": "Shin",
    "Foot": "Foot",
    "Toes": "Foot",
    "UpperArm": "UpperArm",
    "LowerArm": "Forearm",
    "Hand": "Hand",
}
_FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
_HEAD = {"neck": "neck", "head": "head", "jaw": "head", "leftEye": "head", "rightEye": "head"}
_TRUNK = ("abdomen", "torso", "chest")
_SHOULDERS = "shoulders"  # from one shoulder joint to the other, as thick as the upper arms that hang there


@dataclass(frozen=True)
class FitSettings:
    """How closely capsules follow the surface."""

    share: float = 0.97  # of a part's points that its capsule must hold; the rest is loose detail
    hand_share: float = 0.9  # the same for hands, whose thumb stands out in T-pose and lies close in a relaxed hand
    grid: float = 0.006  # metres at a stature of 1.7 m: points nearer than this count once
    fewest: int = 8  # points; a part with fewer keeps its average proportions
    most: int = 900  # points that the search looks at
    evaluations: int = 300  # of the search
    thinnest: float = 0.4  # radius, as a multiple of the average proportions'
    thickest: float = 8.0


@dataclass(frozen=True, eq=False)
class BodyPoints:
    """The surface of a T-posed avatar, each point with the joint that moves it."""

    positions: Floats  # (P, 3) metres, in the skeleton's frame
    joints: Ints  # (P,) index of the joint


def fit_capsules(
    skeleton: Skeleton, points: BodyPoints, settings: FitSettings | None = None
) -> tuple[Capsules, tuple[str, ...]]:
    """Capsules for `skeleton` fitted to its surface, and the names of parts that had no surface to fit."""
    settings = settings or FitSettings()
    average = proportional_capsules(skeleton)
    parts = part_of_points(skeleton, average, points)
    rest = skeleton.positions[average.joints]
    starts, ends, radii = average.starts + rest, average.ends + rest, average.radii.copy()
    cell = settings.grid * stature(skeleton) / 1.7
    bare: list[str] = []
    for part, name in enumerate(average.names):
        own = _thinned(points.positions[parts == part], cell)
        if name == _SHOULDERS:
            continue
        if len(own) < settings.fewest:
            bare.append(name)
            continue
        share = settings.hand_share if name.endswith("Hand") else settings.share
        both = _slimmest(own[:: -(-len(own) // settings.most)], starts[part], ends[part], share, settings.evaluations)
        starts[part], ends[part] = both[:3], both[3:]
        radius = float(np.quantile(_distances(own, both[:3], both[3:]), share))
        radii[part] = np.clip(radius, settings.thinnest * radii[part], settings.thickest * radii[part])
    radii[average.names.index(_SHOULDERS)] = radii[[average.names.index(f"{s}UpperArm") for s in _SIDES]].mean()
    fitted = Capsules(average.names, average.joints, starts - rest, ends - rest, radii, average.groups)
    return fitted, tuple(bare)


def coverage(skeleton: Skeleton, capsules: Capsules, points: BodyPoints, margin: float = 0.01) -> float:
    """The share of points that lie inside the capsule of their own body part, or less than `margin` metres outside."""
    parts = part_of_points(skeleton, capsules, points)
    known = parts >= 0
    rest = skeleton.positions[capsules.joints]
    start, end = (capsules.starts + rest)[parts[known]], (capsules.ends + rest)[parts[known]]
    outside = _distances(points.positions[known], start, end) - capsules.radii[parts[known]]
    return float(np.mean(outside <= margin)) if known.any() else 1.0


def part_of_points(skeleton: Skeleton, capsules: Capsules, points: BodyPoints) -> Ints:
    """The capsule (P,) that each point belongs to, -1 for none: fingers to the hand, toes to the foot, jaw to the head.

    Where one spine bone carries several capsules of the trunk, its points are shared out by height.
    """
    names = {name: index for index, name in enumerate(capsules.names)}
    of_joint = np.array([names.get(_part_name(bone), -1) for bone in skeleton.names], dtype=np.int64)
    parts = of_joint[points.joints]
    shoulders = [skeleton.names.index(f"{s}Shoulder") for s in _SIDES if skeleton.has(f"{s}Shoulder")]
    top = skeleton.index(last_spine(skeleton))
    bearer = np.where(np.isin(points.joints, shoulders), top, points.joints)
    trunk = [names[name] for name in _TRUNK if name in names]
    for joint in {int(capsules.joints[part]) for part in trunk}:
        own = [part for part in trunk if capsules.joints[part] == joint]
        heights = 0.5 * (capsules.starts + capsules.ends)[own, 1] + skeleton.positions[joint, 1]
        borders = 0.5 * (heights[1:] + heights[:-1])
        mine = bearer == joint
        parts[mine] = np.array(own)[np.searchsorted(borders, points.positions[mine, 1])]
    return parts


def _part_name(bone: str) -> str:
    side = next((side for side in _SIDES if bone.startswith(side)), "")
    rest = bone.removeprefix(side)
    if bone == "hips":
        return "pelvis"
    if rest.startswith(_FINGERS):
        return f"{side}Hand"
    return _HEAD.get(bone, side + _LIMB_PARTS.get(rest, ""))


def _thinned(points: Floats, cell: float) -> Floats:
    """One point for each cell of a grid, so that finely meshed places do not outweigh the others."""
    _, first = np.unique(np.round(points / cell).astype(np.int64), axis=0, return_index=True)
    thinned: Floats = points[np.sort(first)]
    return thinned


def _slimmest(points: Floats, start: Floats, end: Floats, share: float, evaluations: int) -> Floats:
    """Both ends (6,) of the slimmest capsule that holds a share of the points, from several first guesses."""
    found = [_search(points, guess, share, evaluations) for guess in _first_guesses(points, start, end)]
    return min(found, key=lambda both: _volume(both, points, share))


def _first_guesses(points: Floats, start: Floats, end: Floats) -> list[Floats]:
    """Capsules through the middle of the points, along the average proportions' axis and along their longest extent."""
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    _, _, axes = np.linalg.svd(points - middle, full_matrices=False)
    along = (end - start) / max(float(np.linalg.norm(end - start)), 1e-9)
    return [np.concatenate([middle - half, middle + half]) for half in (_half(points, d) for d in (along, axes[0]))]


def _half(points: Floats, direction: Floats) -> Floats:
    """Half the axis of a capsule in this direction that is as long and as thick as the points reach."""
    lengths = points @ direction
    across = points - lengths[:, None] * direction
    thickness = float(np.linalg.norm(np.ptp(across, axis=0))) / np.sqrt(2.0)
    half: Floats = 0.5 * max(float(np.ptp(lengths)) - thickness, 0.0) * direction
    return half


def _search(points: Floats, first: Floats, share: float, evaluations: int) -> Floats:
    step = 0.1 * float(np.ptp(points, axis=0).max()) + 1e-6
    simplex = first + np.vstack([np.zeros(6), step * np.eye(6)])
    return least_point(lambda ends: _volume(ends, points, share), simplex, evaluations, 1e-4, 1e-8)


def _volume(ends: Floats, points: Floats, share: float) -> float:
    """Volume of the capsule with these ends (6,) that holds a share of the points; called thousands of times."""
    along = ends[3:] - ends[:3]
    from_start = points - ends[:3]
    squared = max(float(along @ along), 1e-18)
    where = np.minimum(np.maximum(from_start @ (along / squared), 0.0), 1.0)
    away = from_start - where[:, None] * along
    rank = int(np.ceil(share * (len(points) - 1)))
    radius = math.sqrt(np.partition(np.einsum("pi,pi->p", away, away), rank)[rank])
    return math.pi * radius * radius * (math.sqrt(squared) + 4.0 / 3.0 * radius)


def _distances(points: Floats, start: Floats, end: Floats) -> Floats:
    """Distances (P,) of points (P, 3) from segments given by their ends, each (3,) or (P, 3)."""
    along = end - start
    squared = np.maximum(np.sum(along * along, axis=-1), 1e-18)
    where = np.clip(np.sum((points - start) * along, axis=-1) / squared, 0.0, 1.0)
    away: Floats = np.linalg.norm(points - start - where[:, None] * along, axis=-1)
    return away
