"""Who keeps to which side where two walk towards each other: both to the right, each to its half of the room.

What another has in mind tells nothing here: both mean to go straight on, and each waits for the other's plan to leave
it room. So each takes it that the other keeps to its half of the way, as it does itself. The halves follow from both
places, both directions and the walls alone, and both avatars find the same ones. Whether a pose touches is asked of the
bodies, as ever: a half is what to plan with, not what to believe in.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.control.others.neighbour import Neighbour, Walker
from elbowroom.planning.command import Command
from elbowroom.world.obstacles.free_map import FreeMap
from elbowroom.world.obstacles.shapes import Box
from elbowroom.world.obstacles.tracks.moving import Moving, Repeat, Track

Floats = NDArray[np.float64]

_OPPOSED = -0.5  # the greatest cosine between two directions that are opposite
_SIGHT, _PAST = 8.0, -0.6  # metres ahead from which another is reckoned with, and behind until which
_BESIDE = 2.0  # metres to the side beyond which nobody is in the way
_CROSSED = 0.1  # metres to the right from which on another is passed on that side: it takes less
_NARROWEST, _WIDEST = 0.44, 0.7  # metres that a half must have, and needs
_ZONE = 0.9  # metres before and behind the middle between both, in which halves are kept to
_BODY = 0.45  # metres from the middle of a body to the end of its stride
_APART = 0.01  # metres by which a half reaches beyond the line that both keep from
_TOUCH = 0.01  # metres ahead of who stands in the other's half, at which it begins at the earliest, and
_ROUND = 0.15  # at which it should, besides the way aside to its own: so that there is a way round the corner.
# But no farther than half way to the other: where it receded for as long as somebody walks, nobody would go aside.
_SLANT = 0.4  # metres to the side for each metre ahead, of who steps aside as it walks
_COMING, _IN_THE_WAY = 4.0, 0.6  # metres ahead and to the side within which who stands minds who comes
_PASSAGE = 0.65  # metres beside who stands that are enough to pass
_TIGHT = 0.48  # metres beside who stands that are not enough: it turns its shoulder
_TURNED = 0.2  # cosine between a body's front and the way: less is turned enough
_CLOSE_BY = 0.05  # metres from a wall: nearer one does not step
_EASE = 0.8  # of full speed: how fast one steps aside
_HEIGHT = 2.0  # metres
_STEP = 0.04  # metres between places that are looked at for walls
_FREE = 0.04  # metres: nearer is a wall


class _Halves(NamedTuple):
    """The way of two, shared: in a frame whose origin is one's own place."""

    axis: Floats  # (2,) of length 1, ahead
    outward: Floats  # (2,) of length 1, to one's own side
    gap: float  # metres ahead to the other
    line: float  # metres to one's own side, where one's own half begins
    breadth: float  # metres, of the other's


def expected(own: Walker, body: Floats, others: Sequence[Neighbour], free_map: FreeMap) -> Moving:
    """What to keep clear of: the halves of those who come towards `own`, and all that others have told.

    Who stands leaves it to those who walk to go round.

    `body` (C, 7) are the ends of one's own capsules as seen from one's place, and their radii; metres.
    """
    tracks: list[Track] = []
    for other in others:
        if not own.walks and other.walker.walks:
            continue  # it goes round
        halves = _halves(own, other.walker, free_map)
        tracks += other.boxes.tracks if halves is None else [_kept_by(own, halves, body)]
    return Moving(tuple(tracks))


def _halves(own: Walker, other: Walker, free_map: FreeMap) -> _Halves | None:
    """How two share the way; None if they do not come towards each other, or if there is no room for two."""
    if own.wanted @ other.wanted > _OPPOSED:
        return None
    axis, apart = own.wanted - other.wanted, other.place - own.place
    axis = axis / np.hypot(*axis)
    right, gap = np.array([-axis[1], axis[0]]), float(apart @ axis)
    aside = float(apart @ right)
    if not _PAST < gap < _SIGHT or abs(aside) > _BESIDE:
        return None
    outward = right if aside < _CROSSED else -right
    between = 0.5 * float(apart @ outward)
    low, high = _walls(own.place + 0.5 * gap * axis, outward, between, axis, free_map)
    if high - low < 2.0 * _NARROWEST:
        return None
    breadth = min(0.5 * (high - low), _WIDEST)
    return _Halves(axis, outward, gap, min(max(between, low + breadth), high - breadth), breadth)


def way_made(own: Walker, heading: float, body: Floats, others: Sequence[Neighbour], free_map: FreeMap) -> Command:
    """What who stands does for those who come and find no room beside it: a turn of its shoulder, a step aside.

    It turns first where a step alone is not enough, its front to who passes; then it steps to the nearer wall, or to
    its own right as it faces who comes. `heading` and `body` are one's own, as for `expected`.
    """
    ends, radii = body[:, :6].reshape(-1, 2, 3)[:, :, ::2], body[:, 6:]
    front, left = np.array([math.sin(heading), math.cos(heading)]), np.array([math.cos(heading), -math.sin(heading)])
    breadth = float((ends @ left + radii).max() - (ends @ left - radii).min())
    reach = float((np.hypot(ends[:, :, 0], ends[:, :, 1]) + radii).max())

    def step(way: Floats) -> Command:
        return Command(forward=float(_EASE * way @ front), strafe=float(_EASE * way @ left))

    for other in others:
        axis, apart = -other.walker.wanted, other.walker.place - own.place
        right = np.array([-axis[1], axis[0]])
        if not 0.0 < apart @ axis < _COMING or abs(apart @ right) > _IN_THE_WAY:
            continue
        low, high = _walls(own.place, right, 0.0, axis, free_map)
        rooms = float((ends @ right - radii).min()) - low, high - float((ends @ right + radii).max())
        outward = -right if -low < high - _CROSSED else right  # whichever way it has turned
        if max(rooms) >= _PASSAGE:
            continue
        if high - low - breadth - _CLOSE_BY < _TIGHT and abs(front @ axis) > _TURNED:
            if min(-low, high) < reach + _TOUCH:
                return step(right if -low < high else -right)
            return Command(turn=math.copysign(_EASE, -float(outward @ left)))
        if min(rooms) > _CLOSE_BY:
            return step(outward)
    return Command()


def _walls(place: Floats, outward: Floats, between: float, axis: Floats, free_map: FreeMap) -> tuple[float, float]:
    """From where to where it is free across a way at a place, metres `outward`, on both sides of `between`."""
    reach = _STEP * np.arange(1.0, math.ceil(2.0 * _WIDEST / _STEP) + 1.0)
    found = []
    for side in (-1.0, 1.0):
        across = between + side * reach
        ahead = np.array([-0.5 * _ZONE, 0.0, 0.5 * _ZONE])
        places = place + ahead[:, None, None] * axis + across[:, None] * outward
        free = free_map.distances(places, _HEIGHT).min(axis=0)
        blocked = np.flatnonzero(free < _FREE)
        first = blocked[0] if len(blocked) else len(reach) - 1
        found.append(float(across[first] + side * free[first]))
    return found[0], found[1]


def _kept_by(own: Walker, halves: _Halves, body: Floats) -> Track:
    """The other's half about where both meet, as something that stands there; it begins ahead of one's own body."""
    axis, outward, gap, line, breadth = halves
    ends, radii = body[:, :6].reshape(-1, 2, 3)[:, :, ::2], body[:, 6:]
    edge = line + _APART
    near = min(0.5 * gap - _ZONE, gap - _BODY)
    over, front = edge - float((ends @ outward - radii).min()), float((ends @ axis + radii).max())
    if over > 0.0:
        near = max(near, front + _TOUCH, min(front + _ROUND + over / _SLANT, 0.5 * gap))
    far = max(near + _TOUCH, min(gap + _BODY, 0.5 * gap + 2.0 * _ZONE))
    middle = own.place + 0.5 * (near + far) * axis + (edge - 0.5 * breadth) * outward
    center = np.array([[middle[0], 0.5 * _HEIGHT, middle[1]]])
    yaw = np.array([math.atan2(axis[0], axis[1])])
    return Track("a half of the way", Box((breadth, _HEIGHT, far - near)), np.zeros(1), center, yaw, Repeat.ONCE)
