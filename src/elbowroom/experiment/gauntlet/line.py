"""The line on the ground along which a course runs, and the walk along it."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body.gait.stride import phase_rate

Floats = NDArray[np.float64]

_STEP = 0.005  # metres between the points of the integrated line
_BEFORE_AND_AFTER = 3.0  # metres, how far the line goes on straight


def smoothstep(x: ArrayLike) -> Floats:
    """0 below 0, 1 above 1, a cubic without slope at both ends in between."""
    inside = np.clip(np.asarray(x, np.float64), 0.0, 1.0)
    blend: Floats = inside * inside * (3.0 - 2.0 * inside)
    return blend


@dataclass(frozen=True)
class LineTurn:
    """Where the heading of a line changes."""

    begin: float  # metres along the line
    end: float
    angle: float  # radians, positive to the left


@dataclass(frozen=True)
class CourseLine:
    """A line without corners from the origin, first along +Z; its points are given by the way `s` in metres."""

    length: float
    turns: tuple[LineTurn, ...] = ()

    @property
    def straight(self) -> bool:
        """Whether the line never turns."""
        return not self.turns

    def heading(self, s: ArrayLike) -> Floats:
        """Heading (...) in radians."""
        way = np.asarray(s, np.float64)
        total = np.zeros(way.shape)
        for turn in self.turns:
            total = total + turn.angle * smoothstep((way - turn.begin) / (turn.end - turn.begin))
        return total

    def curvature(self, s: ArrayLike) -> Floats:
        """Change of heading per metre (...)."""
        way = np.asarray(s, np.float64)
        total = np.zeros(way.shape)
        for turn in self.turns:
            x = np.clip((way - turn.begin) / (turn.end - turn.begin), 0.0, 1.0)
            total = total + turn.angle * 6.0 * x * (1.0 - x) / (turn.end - turn.begin)
        return total

    @cached_property
    def table(self) -> tuple[Floats, Floats, Floats]:
        """The way and the points' x and z (M,) of the line, integrated with the midpoint rule."""
        first = -_BEFORE_AND_AFTER
        count = round((self.length + 2.0 * _BEFORE_AND_AFTER) / _STEP)
        middles = self.heading(first + _STEP * (np.arange(count) + 0.5))
        x, z = (np.concatenate([[0.0], np.cumsum(_STEP * along)]) for along in (np.sin(middles), np.cos(middles)))
        origin = round(_BEFORE_AND_AFTER / _STEP)
        way: Floats = first + _STEP * np.arange(count + 1, dtype=np.float64)
        return way, x - x[origin], z - z[origin]

    def points(self, s: ArrayLike) -> Floats:
        """Points (..., 2), x and z."""
        (way, x, z), place = self.table, np.asarray(s, np.float64)
        return np.stack([np.interp(place, way, x), np.interp(place, way, z)], axis=-1)

    def nearest(self, x: float, z: float, around: float, reach: float = 1.0) -> float:
        """The way `s` of the point of the line nearest to (x, z), looked for within `reach` of `around`."""
        return float(self.table[0][self.place_nearest(x, z, around, reach)])

    def place_nearest(self, x: float, z: float, around: float, reach: float = 1.0) -> int:
        """The place of that point in the table."""
        way, xs, zs = self.table
        first, last = way.searchsorted((around - reach, around + reach)).tolist()
        part = slice(first, max(last, first + 1))
        return int(first + np.hypot(xs[part] - x, zs[part] - z).argmin())

    def spot(self, s: float) -> "Spot":
        """The line's point at `s` as a frame."""
        heading, (x, z) = float(self.heading(s)), self.points(s).tolist()
        return Spot(x, z, heading, math.sin(heading), math.cos(heading))


class Spot(NamedTuple):
    """A frame on the ground, metres and radians."""

    x: float
    z: float
    heading: float
    sine: float  # of the heading
    cosine: float

    def world(self, left: float, up: float, ahead: float) -> tuple[float, float, float]:
        """The place in the world of an offset to the left, up and ahead."""
        return self.x + ahead * self.sine + left * self.cosine, up, self.z + ahead * self.cosine - left * self.sine


def walk_along(line: CourseLine, s: ArrayLike, speed: ArrayLike, phase: ArrayLike) -> Floats:
    """Root states (N, 7) of a body that walks exactly on the line: ways, speeds and stride phases (N,) or scalars."""
    way = np.asarray(s, np.float64)
    states = np.zeros((len(way), 7))
    states[:, :2] = line.points(way)
    states[:, 2] = line.heading(way)
    states[:, 3] = speed
    states[:, 5] = states[:, 3] * line.curvature(way)
    states[:, 6] = phase
    return states


@dataclass(frozen=True, eq=False)
class LineWalk:
    """A body that walks on a line: from a stand to a constant speed, and on to the line's end."""

    times: Floats  # (K,) seconds
    way: Floats  # (K,) metres along the line
    states: Floats  # (K, 7) root states


def steady_walk(line: CourseLine, speed: float, rate: float, acceleration: float = 2.0) -> LineWalk:
    """The walk along a line at `speed`, `rate` samples a second; m/s, m/s^2."""
    ramp = speed / acceleration
    duration = line.length / speed + 0.5 * ramp
    times = np.arange(int(np.ceil(duration * rate)) + 1) / rate
    rising = np.minimum(times, ramp)
    speeds = acceleration * rising
    way = 0.5 * acceleration * rising**2 + speed * (times - rising)
    cadence = np.full(len(times), phase_rate(speed, 0.0, 0.0))
    starting = int(np.searchsorted(times, ramp))
    cadence[:starting] = [phase_rate(v, 0.0, 0.0) for v in speeds[:starting]]
    phase = np.concatenate([[0.0], np.cumsum(0.5 * (cadence[:-1] + cadence[1:]) / rate)])
    return LineWalk(times, way, walk_along(line, way, speeds, phase))
