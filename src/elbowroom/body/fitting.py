"""The collision body, sized from an avatar's own surface: for each part of the body capsules that hold its points.

Every part starts from its capsule of average proportions and gets the slimmest one round most of its points. Where that
leaves more outside than it may, the part gets the slimmest capsule round all, or, if that is smaller, a second one
round the rest (a thumb, a nose, the front of a broad head).
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.body_parts import SIDES, BodyPoints, part_of_points, with_relaxed_hands
from elbowroom.body.capsules import Capsules
from elbowroom.body.proportions import proportional_capsules, stature
from elbowroom.body.skeleton import Skeleton
from elbowroom.body.slim_capsule import Slim, Wanted, slimmest

Floats = NDArray[np.float64]

MARGIN = 0.01  # metres that the surface may be outside the capsules
_SHOULDERS = "shoulders"  # from one shoulder joint to the other, as thick as the upper arms that hang there
_WHOLE = ("leftUpperArm", "rightUpperArm")  # one capsule each: what is rooted in the trunk is told by its place


@dataclass(frozen=True)
class FitSettings:
    """How closely capsules follow the surface."""

    share: float = 0.97  # of a part's points that its capsule must hold at first; the rest is loose detail
    hand_share: float = 0.9  # the same for hands, whose thumb stands out
    covered: float = 0.995  # of a part's points that must be inside its capsules and `MARGIN`
    grid: float = 0.006  # metres at a stature of 1.7 m: points nearer than this count once
    fewest: int = 4  # points; a part with fewer keeps its average proportions
    most: int = 900  # points that the search looks at
    thinnest: float = 0.4  # radius, as a multiple of the average proportions'
    thickest: float = 8.0
    capsules: int = 24  # at most, of the whole body
    worth_it: float = 0.85  # two capsules are taken for one if they have less than this part of its volume


class Fit(NamedTuple):
    """A collision body."""

    capsules: Capsules
    bare: tuple[str, ...]  # names of parts that had no surface to fit


def fit_capsules(skeleton: Skeleton, points: BodyPoints, settings: FitSettings | None = None) -> Fit:
    """Capsules for `skeleton` fitted to its surface."""
    settings = settings or FitSettings()
    average = proportional_capsules(skeleton)
    relaxed = with_relaxed_hands(skeleton, points)
    parts = part_of_points(skeleton, average, points)
    cell = settings.grid * stature(skeleton) / 1.7
    spare = settings.capsules - len(average.names)
    rest = skeleton.positions[average.joints]
    slims: dict[str, list[Slim]] = {}
    bare: list[str] = []
    for part, name in enumerate(average.names):
        first = Slim(average.starts[part] + rest[part], average.ends[part] + rest[part], float(average.radii[part]))
        own = _thinned(relaxed.positions[parts == part], cell)
        if name == _SHOULDERS or len(own) < settings.fewest:
            slims[name] = [_grown(first, own)]
            bare += [name] if name != _SHOULDERS else []
            continue
        slims[name] = _fitted(own[:: -(-len(own) // settings.most)], own, first, name, spare > 0, settings)
        spare -= len(slims[name]) - 1
    thickness = float(np.mean([slims[f"{side}UpperArm"][0].radius for side in SIDES]))
    slims[_SHOULDERS] = [slims[_SHOULDERS][0]._replace(radius=thickness)]
    return Fit(_assembled(skeleton, average, slims), tuple(bare))


def coverage(skeleton: Skeleton, capsules: Capsules, points: BodyPoints, margin: float = MARGIN) -> float:
    """The share of points inside the capsules of the bone that moves them, or less than `margin` metres outside.

    The points are those of the T-posed avatar; its fingers are relaxed before they are looked at.
    """
    covered, counted = _covered(skeleton, capsules, points, margin)
    return float(covered.sum() / counted.sum()) if counted.sum() else 1.0


def coverage_of_parts(
    skeleton: Skeleton, capsules: Capsules, points: BodyPoints, margin: float = MARGIN
) -> dict[str, float]:
    """The same for each part of the body that has points."""
    covered, counted = _covered(skeleton, capsules, points, margin)
    names = proportional_capsules(skeleton).names
    return {name: float(c / n) for name, c, n in zip(names, covered, counted, strict=True) if n}


def _covered(skeleton: Skeleton, capsules: Capsules, points: BodyPoints, margin: float) -> tuple[Floats, Floats]:
    """How many points of each part of average proportions are covered, and how many there are."""
    average = proportional_capsules(skeleton)
    parts = part_of_points(skeleton, average, points)
    relaxed = with_relaxed_hands(skeleton, points).positions
    rest = skeleton.positions[capsules.joints]
    covered, counted = np.zeros(len(average.names)), np.zeros(len(average.names))
    for part, joint in enumerate(average.joints):
        own = relaxed[parts == part]
        counted[part] = len(own)
        held = np.zeros(len(own), bool)
        for i in np.flatnonzero(capsules.joints == joint):
            slim = Slim(capsules.starts[i] + rest[i], capsules.ends[i] + rest[i], float(capsules.radii[i]))
            held |= slim.outside(own) <= margin
        covered[part] = held.sum()
    return covered, counted


def _fitted(some: Floats, own: Floats, first: Slim, name: str, may_be_two: bool, settings: FitSettings) -> list[Slim]:
    """The capsules of one part, from a sample of its points and all of them."""
    low, high = settings.thinnest * first.radius, settings.thickest * first.radius
    share = settings.hand_share if name.endswith("Hand") else settings.share
    loose = _clipped(slimmest(some, first.start, first.end, Wanted(share, 0.0)), low, high)
    loose = _clipped(loose._replace(radius=float(np.quantile(loose.outside(own) + loose.radius, share))), low, high)
    left = own[loose.outside(own) > MARGIN]
    if len(left) <= (1.0 - settings.covered) * len(own):
        return [loose]
    slack = 0.8 * MARGIN
    whole = _clipped(slimmest(some, first.start, first.end, Wanted(1.0, slack)), low, high)
    reach = float(np.quantile(whole.outside(own) + whole.radius, settings.covered)) - slack
    whole = whole._replace(radius=float(np.clip(reach, low, high)))
    if not may_be_two or name in _WHOLE or len(left) < settings.fewest:
        return [whole]
    rest = slimmest(left[:: -(-len(left) // settings.most)], left.min(axis=0), left.max(axis=0), Wanted(1.0, slack))
    rest = rest._replace(radius=max(rest.radius, 0.5 * low))
    both = loose.volume + rest.volume
    return [loose, rest] if both < settings.worth_it * whole.volume else [whole]


def _grown(first: Slim, own: Floats) -> Slim:
    """A part of average proportions, thick enough for the few points that it has."""
    return first._replace(radius=first.radius + max([0.0, *(first.outside(own) - 0.8 * MARGIN)]))


def _clipped(slim: Slim, low: float, high: float) -> Slim:
    return slim._replace(radius=float(np.clip(slim.radius, low, high)))


def _assembled(skeleton: Skeleton, average: Capsules, slims: dict[str, list[Slim]]) -> Capsules:
    """All capsules in the order of their parts; the second of a part is named after it."""
    rows = [(part, count, slim) for part, name in enumerate(average.names) for count, slim in enumerate(slims[name])]
    parts = np.array([part for part, _, _ in rows], np.int64)
    rest = skeleton.positions[average.joints[parts]]
    return replace(
        average,
        names=tuple(average.names[part] + (f" {count + 1}" if count else "") for part, count, _ in rows),
        joints=average.joints[parts],
        starts=np.array([slim.start for _, _, slim in rows]) - rest,
        ends=np.array([slim.end for _, _, slim in rows]) - rest,
        radii=np.array([slim.radius for _, _, slim in rows]),
        groups=tuple(average.groups[part] for part in parts),
    )


def _thinned(points: Floats, cell: float) -> Floats:
    """One point for each cell of a grid, so that finely meshed places do not outweigh the others."""
    _, first = np.unique(np.round(points / cell).astype(np.int64), axis=0, return_index=True)
    thinned: Floats = points[np.sort(first)]
    return thinned
