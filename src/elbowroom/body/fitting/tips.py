"""What stands out of fitted capsules at single places: the tip of a nose, a lock of hair, the corner of a cube.

Capsules are fitted to points spread over the area, and may leave out a little of that, however far it stands out. But
what is seen to pass through something is just such a tip. So every vertex is held in the end, by the least that holds
it: a thicker capsule, another one for the whole part, or a small one more.
"""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.fitting.slim_capsule import Slim, Wanted, slimmest

Floats = NDArray[np.float64]

_LOOKED_AT = 600  # points that the search looks at
_SLIGHT = 0.005  # metres: what stands out by no more is not worth a capsule more


class Tips(NamedTuple):
    """The vertices of one part of the body, and how it may be held."""

    points: Floats  # (V, 3) metres
    samples: Floats  # (S, 3) of the part's surface, which may have others' vertices
    margin: float  # metres that the vertices may be outside
    thinnest: float  # metres: least radius of a capsule more


def with_tips(
    slims: Mapping[str, tuple[Slim, ...]], tips: Mapping[str, Tips], most: int, worth_it: float
) -> dict[str, tuple[Slim, ...]]:
    """The capsules of each part, so that all vertices of the parts in `tips` are held by those of any part.

    There are `most` in all at most. One more is taken where it has less than `worth_it` of the volume that it spares.
    """
    held = dict(slims)
    for name, own in tips.items():
        every = [slim for some in held.values() for slim in some]
        outside = _outside(every, own.points)
        far, slight = own.points[outside > own.margin], outside.max() <= own.margin + _SLIGHT
        if len(far):
            held[name] = _holding(held[name], far, own, 0.0 if slight or len(every) >= most else worth_it)
    return held


def _holding(slims: tuple[Slim, ...], far: Floats, own: Tips, worth_it: float) -> tuple[Slim, ...]:
    """The capsules of a part so that what is too far outside is held."""
    found = [_grown(slims, far, own.margin)]
    if len(slims) == 1:
        found.append((_anew(slims[0], far, own),))
    best = min(found, key=_volume)
    added = (*slims, _round(far, own))
    return added if _volume(added) - _volume(slims) < worth_it * (_volume(best) - _volume(slims)) else best


def _grown(slims: tuple[Slim, ...], far: Floats, margin: float) -> tuple[Slim, ...]:
    """The capsules, of which the nearest to each of the points (F, 3) is as thick as to hold it."""
    gaps = np.array([slim.outside(far) for slim in slims])
    nearest = np.arange(len(slims))[:, None] == gaps.argmin(axis=0)
    lacking = np.where(nearest, gaps - margin, 0.0).max(axis=1)
    return tuple(slim._replace(radius=slim.radius + float(more)) for slim, more in zip(slims, lacking, strict=True))


def _anew(slim: Slim, far: Floats, own: Tips) -> Slim:
    """The slimmest capsule that holds all vertices of a part, and what of its surface was held before."""
    kept = own.samples[slim.outside(own.samples) <= own.margin]
    points = np.concatenate([own.points, kept])
    some = np.concatenate([points[:: max(1, -(-len(points) // _LOOKED_AT))], far])
    found = slimmest(some, slim.start, slim.end, Wanted(1.0, own.margin))
    lacking = float((found.outside(points) - own.margin).max())
    return found._replace(radius=found.radius + max(lacking, 0.0))


def _round(far: Floats, own: Tips) -> Slim:
    """The slimmest capsule round some points."""
    found = slimmest(far, far.min(axis=0), far.max(axis=0), Wanted(1.0, own.margin))
    return found._replace(radius=max(found.radius, own.thinnest))


def _outside(slims: Sequence[Slim], points: Floats) -> Floats:
    """How far points (P, 3) are outside all capsules, metres."""
    gaps: Floats = np.min([slim.outside(points) for slim in slims], axis=0)
    return gaps


def _volume(slims: tuple[Slim, ...]) -> float:
    return sum(slim.volume for slim in slims)
