"""Whether a pushed thing has room: it stops before what stands, other things, and the ways of what moves by itself.

That goes its way whatever lies there, so nothing is pushed to where it will ever be.
The outline of an upright thing is told as capsules just inside its surface, so that what lies flush, or on top of it,
is no contact. What overlaps already may be left but not entered farther.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.clearance import clearance_from_each
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import about
from elbowroom.world.obstacles.shapes import Capsule, Cylinder, Shape, Sphere, extents_of
from elbowroom.world.obstacles.tracks.moving import Moving, Track
from elbowroom.world.obstacles.tracks.ways import ways_near

Floats = NDArray[np.float64]

_ROUND = 0.025  # metres, radius of the capsules along an edge, at most
_SKIN = 0.2  # of that radius: so far inside the surface lie the capsules
_APART = 1.5  # radii between two of them, at most
_SLACK = 1e-5  # metres by which what is touched already may come nearer: single precision is no reason to stop


@dataclass(frozen=True, eq=False)
class Outline:
    """An upright shape's surface seen from the sides, about its origin."""

    segments: Floats  # (C, 6) metres
    radii: Floats  # (C,)

    def at(self, yaw: float, height: float) -> Floats:
        """The segments (C, 6) of a thing that is turned by `yaw`, with its origin so high above the world's."""
        turn = quaternion.about_axis(1, np.array([yaw]))[0]
        ends = quaternion.rotate(turn, self.segments.reshape(-1, 3)) + np.array([0.0, height, 0.0])
        return np.asarray(ends.reshape(-1, 6), np.float64)


@lru_cache(maxsize=64)
def outline_of(shape: Shape) -> Outline:
    """The outline of a box, sphere, capsule or cylinder."""
    if isinstance(shape, Sphere | Capsule):
        up, radius = np.array([0.0, shape.half[1], 0.0]), (1.0 - _SKIN * _ROUND / max(shape.radius, _ROUND))
        return Outline(np.concatenate([-up, up])[None], np.array([radius * shape.radius]))
    half = extents_of(shape)
    radius = min(_ROUND, *half.tolist())
    x, z = (_round if isinstance(shape, Cylinder) else _rectangle)(half - radius, _APART * (1.0 - _SKIN) * radius)
    up = np.full(len(x), half[1] - radius)
    return Outline(np.stack([x, -up, z, x, up, z], axis=1), np.full(len(x), (1.0 - _SKIN) * radius))


def _rectangle(half: Floats, apart: float) -> tuple[Floats, Floats]:
    """Places along the edge of a rectangle, x and z, not farther apart than `apart`."""
    count = [max(math.ceil(2.0 * half[axis] / apart), 1) for axis in (0, 2)]
    along = np.linspace(-half[0], half[0], count[0], endpoint=False)
    deep = np.linspace(-half[2], half[2], count[1], endpoint=False)
    x = np.concatenate([along, np.full(len(deep), half[0]), -along, np.full(len(deep), -half[0])])
    z = np.concatenate([np.full(len(along), -half[2]), deep, np.full(len(along), half[2]), -deep])
    return x, z


def _round(half: Floats, apart: float) -> tuple[Floats, Floats]:
    """The same along a circle."""
    count = max(math.ceil(2.0 * math.pi * half[0] / apart), 1)
    angles = np.linspace(0.0, 2.0 * math.pi, count, endpoint=False)
    return half[0] * np.cos(angles), half[0] * np.sin(angles)


@dataclass(frozen=True)
class ThingRoom:
    """What a thing must not enter."""

    standing: Obstacles  # all that is not loose, with what moves by itself
    others: Moving  # the other loose things, where they are
    time: float  # at which what moves is looked at, seconds

    def lets(self, track: Track) -> bool:
        """Whether a thing may go straight from the first pose of a track to the last, and enters nothing on the way."""
        outline, yaw = outline_of(track.shape), float(track.yaws[0])
        first, last = track.centers[0], track.centers[-1]
        segments = outline.at(yaw, float(first[1]))
        near = list(self._near(track))
        before = self._gaps(segments, outline.radii, near, first)
        steps = math.ceil(math.dist(first, last) / (2.0 * float(outline.radii.min())))
        for k in range(1, steps + 1):
            after = self._gaps(segments, outline.radii, near, first + (k / steps) * (last - first))
            if ((after < 0.0) & (after < before - _SLACK)).any():
                return False
            before = after
        return True

    def _near(self, track: Track) -> Iterable[Nearby]:
        """What is in reach of a thing on its way."""
        reach = np.linalg.norm(extents_of(track.shape)) + 2.0 * _ROUND
        least, most = track.centers.min(axis=0) - reach, track.centers.max(axis=0) + reach
        yield self.standing.near(least[[0, 2]], most[[0, 2]])
        if len(self.standing.moving):
            yield ways_near(self.standing.moving, self.time, least, most)
        if len(self.others):
            yield self.others.at(self.time)

    @staticmethod
    def _gaps(segments: Floats, radii: Floats, near: list[Nearby], place: Floats) -> Floats:
        """How far the outline of a thing at a place is from each of those that are near, metres."""
        x, z = float(place[0]), float(place[2])
        found = [clearance_from_each(segments, radii, about(each, x, z)) for each in near]
        return np.concatenate([np.empty(0), *found])
