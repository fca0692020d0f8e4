"""What stands out of fitted capsules at single places: the tip of a nose, the edge of a sole, a kneecap.

Capsules are fitted to points spread over the area, and may leave out a little of that, however far it stands out. But
what is seen to pass through something is just such a tip. So every vertex is held in the end, in every pose, by the
least that holds it: a thicker capsule, others for the whole part, or a small one more.
"""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.fitting.flexing import FlexedPoses, PosedPoints
from elbowroom.body.fitting.slim_capsule import Slim, SlimSettings, slimmest

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
HeldCapsules = dict[str, tuple[Slim, ...]]  # the capsules of each part


def _even_directions(count: int) -> Floats:
    """Unit vectors (count, 3) that are about equally far apart: a spiral of equal steps by the golden angle."""
    number = np.arange(count)
    height = 1.0 - (2.0 * number + 1.0) / count
    turn, out = math.pi * (3.0 - math.sqrt(5.0)) * number, np.sqrt(1.0 - height * height)
    return np.stack([out * np.cos(turn), height, out * np.sin(turn)], axis=1)


_TURNS = 3  # that all parts have
_DIRECTIONS = _even_directions(400)  # in which the outermost points are looked at: what holds these holds about all
_SEARCHES = 2  # one after the other, the second also with what the first left out farthest
_FARTHEST = 20  # such points
_EVALUATIONS = 900  # of each search
_CUT = 0.5  # of a part's length, where it is cut in two
_FEWEST = 20  # points of either end
_NOTHING = 1e-9  # metres
_SLIGHT = 0.005  # metres: what stands out by no more is not worth a capsule more


class Tips(NamedTuple):
    """The surface of one part of the body, and how it may be held."""

    joint: int  # that carries the part
    vertices: PosedPoints
    samples: PosedPoints  # spread over its area, which may have others' vertices
    margin: float  # metres that the vertices may be outside
    loose: float  # and those samples that were not farther outside
    thinnest: float  # metres: least radius of a capsule more
    leans: tuple[
        str, ...
    ] = ()  # on these parts: what they hold in the poses it need not, their joints are in no others


class Limits(NamedTuple):
    """What capsules there may be."""

    most: int  # in all
    worth_it: float  # a capsule more has at most this part of the volume that it spares, two have of that of one


class _Seen(NamedTuple):
    """Points of a part that are to be held, as its joint sees them."""

    points: Floats  # (N, 3)
    slack: Floats  # (N,) metres that each may be outside

    def of(self, some: NDArray[np.bool_]) -> "_Seen":
        """Some of them."""
        return _Seen(self.points[some], self.slack[some])

    def lacking(self, slims: Sequence[Slim]) -> Floats:
        """How much farther outside of all capsules than it may be each point is (N,), metres."""
        lacking: Floats = np.min([slim.outside(self.points) for slim in slims], axis=0) - self.slack
        return lacking

    def beyond(self, slims: Sequence[Slim]) -> "_Seen":
        """Those that are too far outside."""
        return self.of(self.lacking(slims) > _NOTHING)


def with_tips(
    slims: Mapping[str, tuple[Slim, ...]],
    joints: Mapping[str, int],
    tips: Mapping[str, Tips],
    poses: FlexedPoses,
    limits: Limits,
) -> HeldCapsules:
    """The capsules of each part, so that those of any part hold all vertices of the parts in `tips` in all poses.

    Each part rides on one of the `joints`. They are looked at in the order of `tips`, and again while a capsule that is
    another now has let go of what another part left to it; in the end capsules only grow.
    """
    search = _Search(dict(slims), joints, tips, poses)
    for turn in range(_TURNS):
        for name, own in tips.items():
            far = search.far(name)
            if len(far.points) or (own.leans and not turn):
                full = sum(map(len, search.held.values())) >= limits.most
                every = search.left(name) if own.leans else search.wanted[name]
                search.held[name] = _holding(search.held[name], every, far, own, 0.0 if full else limits.worth_it)
    for name in tips:
        search.held[name] = _grown(search.held[name], search.far(name))
    return search.held


class _Search:
    """The capsules of all parts, and what is to be held of each: vertices, and samples that were held at first."""

    def __init__(
        self, held: HeldCapsules, joints: Mapping[str, int], tips: Mapping[str, Tips], poses: FlexedPoses
    ) -> None:
        self.held, self._joints, self._tips, self._poses = held, joints, tips, poses
        self._points, self.wanted = dict[str, PosedPoints](), dict[str, _Seen]()
        for name, own in tips.items():
            points, slack = _to_hold(own, held[name], poses)
            self._points[name], self.wanted[name] = points, _Seen(poses.seen(own.joint, points), slack)

    def left(self, name: str) -> _Seen:
        """What no other part holds of one, or none of those on which it leans."""
        return self._beyond_others(name, np.ones(len(self.wanted[name].slack), bool))

    def far(self, name: str) -> _Seen:
        """What of that is too far outside of its own capsules too."""
        return self._beyond_others(name, self.wanted[name].lacking(self.held[name]) > _NOTHING)

    def _beyond_others(self, name: str, some: NDArray[np.bool_]) -> _Seen:
        """Those of some points of a part that no other part holds."""
        rows, (places, pose), slack = np.flatnonzero(some), self._points[name], self.wanted[name].slack
        for other in self._tips[name].leans or self.held:
            for slim in self.held[other] if other != name else ():
                points = PosedPoints(places[rows], pose[rows])
                rows = rows[self._poses.outside(slim, self._joints[other], points) > slack[rows]]
        return _Seen(self.wanted[name].points[rows], slack[rows])


def _to_hold(own: Tips, slims: Sequence[Slim], poses: FlexedPoses) -> tuple[PosedPoints, Floats]:
    """All that is to be held of a part, and how far each may be outside: vertices, and samples that are held now."""
    kept = np.min([poses.outside(slim, own.joint, own.samples) for slim in slims], axis=0) <= own.loose
    places = np.concatenate([own.vertices.places, own.samples.places[kept]])
    pose = np.concatenate([own.vertices.pose, own.samples.pose[kept]])
    slack = np.full(len(pose), own.loose)
    slack[: len(own.vertices.pose)] = own.margin
    return PosedPoints(places, pose), slack


def _holding(slims: tuple[Slim, ...], every: _Seen, far: _Seen, own: Tips, worth_it: float) -> tuple[Slim, ...]:
    """The capsules of a part so that those points are held that are too far outside."""
    best = min(_grown(slims, far), _anew(slims, every, own), key=_volume)
    if len(slims) == 1 and own.leans:
        two = min((_in_two(slim, every, own) for slim in (best[0], best[0].turned)), key=_volume)
        best = two if _volume(two) < worth_it * _volume(best) else best
    if far.lacking(slims).max(initial=0.0) <= _SLIGHT:
        return best
    more = _round(far.points, (far.points.min(axis=0), far.points.max(axis=0)), own.margin)
    added = (*slims, more._replace(radius=max(more.radius, own.thinnest)))
    return added if _volume(added) - _volume(slims) < worth_it * (_volume(best) - _volume(slims)) else best


def _grown(slims: tuple[Slim, ...], far: _Seen) -> tuple[Slim, ...]:
    """The capsules, of which the nearest to each of the points is as thick as to hold it."""
    nearest = np.arange(len(slims))[:, None] == _nearest(slims, far.points)
    lacking = np.where(nearest, [far.lacking([slim]) for slim in slims], 0.0).max(axis=1, initial=0.0)
    return tuple(
        slim._replace(radius=slim.radius + float(more)) if more > 0.0 else slim
        for slim, more in zip(slims, lacking, strict=True)
    )


def _anew(slims: tuple[Slim, ...], every: _Seen, own: Tips) -> tuple[Slim, ...]:
    """The slimmest capsules that hold the points nearest to each, where one holds too little or a part leans."""
    nearest, lacking = _nearest(slims, every.points), every.lacking(slims) > _NOTHING
    wanted = lacking | (len(own.leans) > 0)
    return tuple(
        _closest(every.of(nearest == n), slim, own) if np.any(wanted[nearest == n]) else slim
        for n, slim in enumerate(slims)
    )


def _in_two(slim: Slim, every: _Seen, own: Tips) -> tuple[Slim, ...]:
    """Capsules of one end of a part, and of what that one leaves out: slimmer where the part tapers."""
    if len(every.points) < 2 * _FEWEST:
        return (slim,)
    along = every.points @ (slim.end - slim.start)
    end = along > along.min() + _CUT * np.ptp(along)
    if min(np.count_nonzero(end), np.count_nonzero(~end)) < _FEWEST:
        return (slim,)
    first = _closest(every.of(end), slim, own)
    rest = every.beyond([first])
    return (first, _closest(rest, slim, own)) if len(rest.points) else (first,)


def _closest(mine: _Seen, slim: Slim, own: Tips) -> Slim:
    """The slimmest capsule round points, sought from another."""
    axis = slim.start, slim.end
    strict = mine.of(mine.slack <= own.margin) if np.any(mine.slack <= own.margin) else mine
    found = _round(strict.points, axis, own.margin)
    lost = mine.beyond([found]).points
    if len(lost):
        found = _round(np.concatenate([strict.points, lost]), axis, own.margin)
    return found._replace(radius=found.radius + max(float(mine.lacking([found]).max()), 0.0))


def _round(points: Floats, axis: tuple[Floats, Floats], margin: float) -> Slim:
    """The slimmest capsule round some points (N, 3), sought from an axis."""
    some = points[np.unique(np.argmax(_DIRECTIONS @ points.T, axis=1))]
    for _ in range(_SEARCHES):
        found = slimmest(some, *axis, SlimSettings(1.0, margin, _EVALUATIONS))
        outside = found.outside(points)
        axis, some = (found.start, found.end), np.concatenate([some, points[np.argsort(-outside)[:_FARTHEST]]])
    return found._replace(radius=found.radius + max(float(outside.max()) - margin, 0.0))


def _nearest(slims: Sequence[Slim], points: Floats) -> Ints:
    """Which of the capsules is nearest to each of the points (N,)."""
    nearest: Ints = np.argmin([slim.outside(points) for slim in slims], axis=0)
    return nearest


def _volume(slims: tuple[Slim, ...]) -> float:
    return sum(slim.volume for slim in slims)
