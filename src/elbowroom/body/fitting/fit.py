"""The collision body, sized from an avatar's own surface: for each part of the body capsules that hold its points.

Every part starts from its capsule of average proportions and gets the slimmest one round most of its points. Where that
leaves more outside than it may, the part gets the slimmest capsule round all, or, if that is smaller, a second one
round the rest (a thumb, a nose, the front of a broad head).
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.capsules import Capsules
from elbowroom.body.dof import DofGroup
from elbowroom.body.fitting.body_parts import PELVIS, SIDES, leans_on, part_of_points
from elbowroom.body.fitting.flexing import FlexedPoses, PosedPoints, poses_of
from elbowroom.body.fitting.proportions import proportional_capsules
from elbowroom.body.fitting.slim_capsule import Slim, SlimSettings, slimmest
from elbowroom.body.fitting.surface import Surface
from elbowroom.body.fitting.tips import Limits, Tips, with_tips
from elbowroom.body.skeleton import Skeleton

Floats = NDArray[np.float64]

MARGIN = 0.01  # metres that the surface may be outside the capsules
_ARM = ("UpperArm", "Forearm", "Hand")
_HEAD, _THIGH = "head", "Thigh"
_SHOULDERS = "shoulders"  # from one shoulder joint to the other, as thick as the upper arms that hang there
_WHOLE = ("leftUpperArm", "rightUpperArm")  # one capsule each: what is rooted in the trunk is told by its place


@dataclass(frozen=True)
class FitSettings:
    """How closely capsules follow the surface."""

    share: float = 0.97  # of a part's points that its capsule must hold at first; the rest is loose detail
    hand_share: float = 0.9  # the same for hands, whose thumb stands out
    covered: float = 0.995  # of a part's points that must be inside its capsules and `MARGIN`
    held: float = 0.999  # of a part's points that are held where its first capsule leaves out more
    fewest: int = 8  # samples; a part with fewer keeps its average proportions
    slight: float = 0.35  # of the length of average proportions: what is shorter does not look like such a part
    most: int = 600  # points that the search looks at
    thinnest: float = 0.4  # radius, as a multiple of the average proportions'
    thickest: float = 8.0
    capsules: int = 24  # at most, of the whole body
    worth_it: float = 0.85  # two capsules are taken for one if they have less than this part of its volume
    margin: float = MARGIN
    arm_margin: float = 0.5 * MARGIN  # the same for arms: nothing passes things as closely, and that is all they keep
    tip_margin: float = 0.5 * MARGIN  # metres that any vertex of the upper body may be outside: that is all it keeps
    leg_margin: float = 0.001  # the same for legs: in narrow places they keep nothing
    head_margin: float = 0.0  # the same for the head: it ducks under things by no more than it must, and all look at it

    @property
    def slack(self) -> float:
        """Metres of the margin that a fit makes use of."""
        return 0.5 * self.margin

    def tip_margin_of(self, part: str, group: DofGroup) -> float:
        """Metres that any vertex of a part may be outside."""
        if group is DofGroup.ROOT and part != PELVIS:
            return self.leg_margin
        return self.head_margin if part == _HEAD else self.tip_margin

    def of(self, part: str) -> "FitSettings":
        """How closely one part of the body is followed."""
        return replace(self, margin=self.arm_margin) if part.endswith(_ARM) else self


class Fit(NamedTuple):
    """A collision body."""

    capsules: Capsules
    bare: tuple[str, ...]  # names of parts that had no surface to fit
    slight: tuple[str, ...]  # and of those that have too little surface to be such a part, the bare ones among them


class _Shapes(NamedTuple):
    """One part of the body: as one capsule, and as two that are smaller together, if there are such."""

    one: Slim
    two: tuple[Slim, Slim] | None

    @property
    def gain(self) -> float:
        """Cubic metres that two spare."""
        return 0.0 if self.two is None else self.one.volume - self.two[0].volume - self.two[1].volume


def fit_capsules(skeleton: Skeleton, surface: Surface, settings: FitSettings | None = None) -> Fit:
    """Capsules for `skeleton` fitted to its surface."""
    settings = settings or FitSettings()
    average = proportional_capsules(skeleton)
    parts = part_of_points(skeleton, average, surface.samples)
    rest = skeleton.positions[average.joints]
    shapes: dict[str, _Shapes] = {}
    bare: list[str] = []
    slight: list[str] = []
    for part, name in enumerate(average.names):
        first = Slim(average.starts[part] + rest[part], average.ends[part] + rest[part], float(average.radii[part]))
        own = surface.samples.positions[parts == part]
        if name == _SHOULDERS:
            shapes[name] = _Shapes(first, None)
            continue
        slight += [name] if _is_slight(first, own, settings) else []
        bare += [name] if len(own) < settings.fewest else []
        few, close = len(own) < settings.fewest, settings.of(name)
        shapes[name] = _Shapes(_grown(first, own, close), None) if few else _fitted(own, first, name, close)
    thickness = float(np.mean([shapes[f"{side}UpperArm"].one.radius for side in SIDES]))
    shapes[_SHOULDERS] = _Shapes(shapes[_SHOULDERS].one._replace(radius=thickness), None)
    poses = poses_of(skeleton)
    tips = _tips(skeleton, average, surface, poses, settings)
    joints = dict(zip(average.names, average.joints.tolist(), strict=True))
    limits = Limits(settings.capsules, settings.worth_it)
    slims = with_tips(_chosen(shapes, settings.capsules), joints, tips, poses, limits)
    return Fit(_assembled(skeleton, average, slims), tuple(bare), tuple(slight))


def _tips(
    skeleton: Skeleton, average: Capsules, surface: Surface, poses: FlexedPoses, settings: FitSettings
) -> dict[str, Tips]:
    """The surface of each part that has any vertices: from the ends of limbs inwards, but thighs last.

    They hold what pelvis and shins leave to them; else both would be thick at the hips.
    """
    parts, sampled = (part_of_points(skeleton, average, points) for points in (surface.vertices, surface.samples))
    found = {}
    present = np.unique(parts[parts >= 0])[::-1].tolist()
    for part in sorted(present, key=lambda part: average.names[part].endswith(_THIGH)):
        name = average.names[part]
        found[name] = Tips(
            joint=int(average.joints[part]),
            vertices=_posed(surface.posed[:, parts == part]),
            samples=poses.sampled(surface.samples, np.flatnonzero(sampled == part)),
            margin=settings.tip_margin_of(name, average.groups[part]),
            loose=settings.of(name).margin,
            thinnest=0.5 * settings.thinnest * float(average.radii[part]),
            leans=leans_on(average, part),
        )
    return found


def _posed(places: Floats) -> PosedPoints:
    """Vertices (P, V, 3) in all poses, one after the other."""
    return PosedPoints(places.reshape(-1, 3), np.repeat(np.arange(len(places)), places.shape[1]))


def _is_slight(first: Slim, own: Floats, settings: FitSettings) -> bool:
    """Whether the samples of a part cover but little of its length."""
    along = first.end - first.start
    length = float(np.linalg.norm(along))
    extent = float(np.ptp(own @ along)) / max(length, 1e-9) if len(own) else 0.0
    return extent < settings.slight * (length + 2.0 * first.radius)


def _chosen(shapes: dict[str, _Shapes], most: int) -> dict[str, tuple[Slim, ...]]:
    """The capsules of each part, `most` in all: two where they spare most, on both sides of the body alike."""
    twins: dict[str, list[str]] = {}
    for name, shape in shapes.items():
        if shape.gain > 0.0:
            twins.setdefault(name.removeprefix("left").removeprefix("right"), []).append(name)
    spare, doubled = most - len(shapes), set[str]()
    for names in sorted(twins.values(), key=lambda names: -sum(shapes[name].gain for name in names) / len(names)):
        if len(names) <= spare:
            spare -= len(names)
            doubled.update(names)
    return {name: (shape.two if name in doubled else None) or (shape.one,) for name, shape in shapes.items()}


def _fitted(own: Floats, first: Slim, name: str, settings: FitSettings) -> _Shapes:
    """The capsules of one part that hold its samples (P, 3)."""
    low, high = settings.thinnest * first.radius, settings.thickest * first.radius
    some = _some(own, settings.most)
    share = settings.hand_share if name.endswith("Hand") else settings.share
    loose = _clipped(slimmest(some, first.start, first.end, SlimSettings(share, 0.0)), low, high)
    loose = _clipped(loose._replace(radius=float(np.quantile(loose.outside(own) + loose.radius, share))), low, high)
    left = own[loose.outside(own) > settings.margin]
    if len(left) <= (1.0 - settings.covered) * len(own):
        return _Shapes(loose, None)
    whole = _whole(own, first, low, high, settings)
    if name in _WHOLE:
        return _Shapes(whole, None)
    pairs = [(loose, _round(left, low, settings)), *_halves(own, low, settings)]
    best = min(pairs, key=lambda pair: pair[0].volume + pair[1].volume)
    worth_it = best[0].volume + best[1].volume < settings.worth_it * whole.volume
    return _Shapes(whole, best if worth_it else None)


def _whole(own: Floats, first: Slim, low: float, high: float, settings: FitSettings) -> Slim:
    """The slimmest capsule round next to all samples."""
    whole = _clipped(
        slimmest(_some(own, settings.most), first.start, first.end, SlimSettings(1.0, settings.slack)), low, high
    )
    reach = float(np.quantile(whole.outside(own) + whole.radius, settings.held)) - settings.slack
    return whole._replace(radius=float(np.clip(reach, low, high)))


def _halves(own: Floats, low: float, settings: FitSettings) -> list[tuple[Slim, Slim]]:
    """Capsules round both halves of the samples, cut in the middle across the longest and the second longest extent."""
    middle = 0.5 * (own.min(axis=0) + own.max(axis=0))
    _, _, axes = np.linalg.svd(_some(own, settings.most) - middle, full_matrices=False)
    pairs = []
    for axis in axes[:2]:
        along = own @ axis
        upper = along > 0.5 * (along.min() + along.max())
        if settings.fewest <= np.count_nonzero(upper) <= len(own) - settings.fewest:
            pairs.append((_round(own[upper], low, settings), _round(own[~upper], low, settings)))
    return pairs


def _round(points: Floats, low: float, settings: FitSettings) -> Slim:
    """The slimmest capsule round all of some points."""
    found = slimmest(
        _some(points, settings.most), points.min(axis=0), points.max(axis=0), SlimSettings(1.0, settings.slack)
    )
    reach = float(np.quantile(found.outside(points) + found.radius, settings.held)) - settings.slack
    return found._replace(radius=max(reach, 0.5 * low))


def _some(points: Floats, most: int) -> Floats:
    """Every so many-th of the points, so that there are no more than `most`."""
    few: Floats = points[:: max(1, -(-len(points) // most))]
    return few


def _grown(first: Slim, own: Floats, settings: FitSettings) -> Slim:
    """A part of average proportions, thick enough for the few samples that it has."""
    grown = first._replace(radius=first.radius + max([0.0, *(first.outside(own) - settings.slack)]))
    return _clipped(grown, first.radius, settings.thickest * first.radius)


def _clipped(slim: Slim, low: float, high: float) -> Slim:
    return slim._replace(radius=float(np.clip(slim.radius, low, high)))


def _assembled(skeleton: Skeleton, average: Capsules, slims: dict[str, tuple[Slim, ...]]) -> Capsules:
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
