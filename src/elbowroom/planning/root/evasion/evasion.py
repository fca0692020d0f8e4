"""Past what the straight route leaves no room for: aside, turned sideways, or both, as cheaply as possible.

Along the line of travel lies a grid of places, and at each of them the body may face along the line or be turned away
from it. The cheapest path through that grid, by dynamic programming over its rows, is an *evasion*: how far to the side
to walk, and how far to turn the body, at each step ahead. Costs are seconds: sideways one walks slower, and every metre
aside, every turn and every lack of room costs some.

Legs and pelvis must be free, as they are posed in a stride of that direction. For the trunk and the hanging arms a lack
of room is only dear, because they can bend: how dear is what tells one evasion from another.
"""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.planning.root.evasion.grid_search import GridPrices, cheapest, pulled_taut
from elbowroom.planning.root.evasion.profile import Profile
from elbowroom.planning.root.evasion.room import GridFloor, LineGrid, Room, places_on
from elbowroom.planning.root.evasion.turned_body import TurnedBody
from elbowroom.planning.root.line.line import TravelLine
from elbowroom.planning.stillness import STILL
from elbowroom.world.ground.ground import heights_beside
from elbowroom.world.obstacles.layout import Spans
from elbowroom.world.obstacles.rows import grown_aside
from elbowroom.world.obstacles.tracks.moving import Moving
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Indices = NDArray[np.int64]

_SLOW = 0.1  # m/s along the line
_GAIN = 2.0  # m/s^2, of speeding up
_LEVEL = 0.02  # metres by which level ground may rise
_ROUNDS = 8  # paths through narrow cells that may turn out to be closed


@dataclass(frozen=True)
class EvasionSettings:
    """The grid and what things cost. Metres, radians, seconds."""

    step: float = 0.1  # between rows
    aside: float = 0.04  # between columns
    sideways: float = 0.45  # m/s: with long steps to the side the knees come forward
    short: float = 0.33  # of that, in gaps: with short steps the knees stay where they are
    punctual: float = 0.2  # seconds before and after that a row may be reached in
    polite: float = 0.05  # metres by which all that could move is taken to be larger, where any of it does
    cares: tuple[float, ...] = (0.0, 0.015)  # clearance beyond the margin, tried in turn
    shares: tuple[float, ...] = (1.0, 0.75, 0.5)  # of both speeds, tried in turn
    widest: float = 0.48  # from the line of travel, to either side
    turns: int = 4  # turned postures to either side
    most: float = 0.5 * math.pi  # the body is turned by at most this
    margin: float = 0.003  # clearance that legs and pelvis must have
    swerving: float = 0.02  # more of it where the body turns on the way
    comfort: float = 0.06  # clearance below which it costs
    beside: float = 2.0  # of each metre walked, for the squared distance from the line
    leftward: float = 0.5  # of each metre walked, for each metre to the left, where something moves: keep right
    turned: float = 0.15  # of each metre walked, for the squared angle
    shifting: float = 0.005  # of moving to the next column within a row
    turning: float = 0.05  # of going to the next turn within a row
    spot: float = 0.3  # of going to the next turn on the spot, before setting out
    legs: float = 30.0  # of each metre walked, for each metre of room that the legs lack
    # The same for the trunk and for hanging arms: an evasion for each pair.
    bodies: tuple[tuple[float, float], ...] = ((60.0, 30.0), (60.0, 2.0))
    keeping: float = 0.004  # of each row: what another path must be better than the one being followed
    ends: tuple[float, float] = (3.0, 0.2)  # for the squared distance and the squared angle at the end
    slack: float = 0.03  # clearance beyond which a path is free to be pulled taut

    @property
    def columns(self) -> int:
        """Columns of the grid; the middle one is the line."""
        return 2 * round(self.widest / self.aside) + 1

    @cached_property
    def angles(self) -> Floats:
        """The turns (T,) of the body from the line's facing."""
        return np.linspace(-self.most, self.most, 2 * self.turns + 1)


# Farther to the side, with more room, on a coarser grid that is no larger; as steep as the fine one.
WIDE = EvasionSettings(
    step=0.2, aside=0.08, widest=1.2, comfort=0.15, slack=0.12, shifting=0.01, turning=0.5, keeping=0.008,
    cares=(0.0,), bodies=((40.0, 40.0),),
)  # fmt: skip


class Evasion(NamedTuple):
    """A path through the grid."""

    profile: Profile
    whole: bool  # whether it leads to the last row
    cost: float  # seconds


class EvasionFinder:
    """Finds evasions for one humanoid among what stands. What it remembers is what it would find again."""

    def __init__(self, humanoid: Humanoid, scene: Scene, settings: EvasionSettings | None = None) -> None:
        self.settings = s = settings or EvasionSettings()
        self._scene, self._body = scene, TurnedBody(humanoid, s.angles)

    def ahead_of(
        self,
        line: TravelLine,
        start: RootState,
        sight: float,
        speeds: tuple[float, float],
        moving: Moving,
        time: float,
    ) -> "EvasionGrid | None":
        """The grid from a start on at a time, for `speeds` forward and sideways, m/s.

        The first row is that next to the start, of rows at whole steps from the line's first point: so cells stay where
        they are from plan to plan. Where something moves it is at the start itself. What moves is where it will be
        about when a row is reached, by who speeds up at once. None where the ground is not level.
        """
        s, ahead = self.settings, line.coordinates(start.x, start.z)[0]
        first, rows = ahead if len(moving) else s.step * round(ahead / s.step), math.ceil(sight / s.step) + 1
        passing = self._passing(moving, time, s.step * np.arange(float(rows)), start, speeds[0])
        turned = self._body.going(line.heading - line.facing, speeds)
        grid = LineGrid(
            first, s.step, s.aside, rows, s.columns, s.comfort, s.margin, s.margin + s.swerving + max(s.cares)
        )
        floor = self._floor(line, grid, start.height)
        if floor is None:
            return None
        low, high = _corners(line, grid, turned.discs.reach)
        scene, here = self._scene, (start.x, start.height, start.z)
        window, near = scene.free_map.window(low, high, here), scene.obstacles.near(low, high)
        room = Room(self._body, turned, line, grid, (window, floor), near, passing)
        return EvasionGrid(s, line, start, turned.slowness, grid, room, len(moving) > 0)

    def _floor(self, line: TravelLine, grid: LineGrid, height: float) -> GridFloor | None:
        """What one walks on over a grid, who comes from a height; None where that is not level."""
        ground = self._scene.ground
        if ground.plain:
            return GridFloor(np.zeros((grid.rows, grid.columns)), -np.inf)
        heights = heights_beside(ground, height, 0, places_on(line, grid))
        there = np.where(np.isfinite(heights), heights, height)
        if np.ptp(there) > _LEVEL:
            return None
        return GridFloor(there, ground.step)

    def _passing(self, moving: Moving, time: float, ahead: Floats, start: RootState, speed: float) -> Spans:
        """What moves about when places `ahead` (n,) metres are reached, a little larger, unless all of it stands."""
        s, then = self.settings, time + _arrival(ahead, math.hypot(start.forward, start.lateral), speed)
        swept = moving.swept_between(np.maximum(then - s.punctual, time), then + s.punctual)
        return grown_aside(swept, s.polite if moving.fastest > STILL else 0.0)


def _corners(line: TravelLine, grid: LineGrid, reach: float) -> tuple[Floats, Floats]:
    """The corners (2,) on the ground, x and z, of what holds a grid and `reach` metres around it."""
    wide = grid.aside * (grid.columns // 2)
    ends = (line.point(grid.first + i * grid.step * (grid.rows - 1), j * wide) for i in (0, 1) for j in (-1, 1))
    places = np.array(list(ends))
    return places.min(axis=0) - reach, places.max(axis=0) + reach


def _arrival(ahead: Floats, now: float, speed: float) -> Floats:
    """Seconds (n,) until one is `ahead` (n,) metres on, who walks `now` m/s and speeds up to `speed`."""
    gaining = max(speed - now, 0.0) / _GAIN
    gained = 0.5 * (now + speed) * gaining
    early = (np.sqrt(now * now + 2.0 * _GAIN * np.minimum(ahead, gained)) - now) / _GAIN
    seconds: Floats = np.where(ahead < gained, early, gaining + (ahead - gained) / speed)
    return seconds


class EvasionGrid(NamedTuple):
    """The clearance of the body along a line of travel."""

    settings: EvasionSettings
    line: TravelLine
    start: RootState
    slowness: Floats  # (T,) seconds for each metre, in each turn
    grid: LineGrid
    room: Room
    passing: bool  # whether something moves

    @property
    def cells(self) -> int:
        """The number of cells whose clearance was computed."""
        return int(self.room.shift.size)

    def cheapest(self, bodies: tuple[float, float], kept: Profile | None, care: float = 0.0) -> Evasion:
        """The cheapest path, with `bodies` as in the settings; `kept` is the one being followed.

        Legs keep `care` metres more than the settings ask for.
        """
        s, rows = self.settings, self.room.clear.shape[1]
        standing = s.step * (self.slowness - self.slowness.min() + s.turned * s.angles**2)
        ends = s.ends[0] * s.aside**2, s.ends[1] * (s.most / s.turns) ** 2
        leftward = s.step * s.aside * s.leftward if self.passing else 0.0
        prices = GridPrices(
            s.margin + care, s.swerving, s.comfort, s.step * s.beside * s.aside**2, leftward, s.shifting, s.turning,
            s.spot, (s.step * s.legs, s.step * bodies[0], s.step * bodies[1]), s.keeping, ends,
        )  # fmt: skip
        favoured = (
            np.full((rows, 2), -9) if kept is None else self._cells(*_rows_at(kept, self.grid.first, s.step, rows))
        )
        left, turned = self._at_first_row()
        begin = self._cells(np.array([left]), np.array([turned]))[0]
        self.room.check_narrow(begin[None])
        for _ in range(_ROUNDS):
            cells, cost = cheapest(self.room.clear, standing, prices, begin, favoured)
            if not self.room.check_narrow(cells):
                break
        places = pulled_taut(self.room.clear, self.room.shift, cells, left, s.aside, s.slack)
        path = np.stack([places, s.angles[cells[:, 1]]], axis=1)
        if cells[0, 1] == begin[1]:
            path[0, 1] = turned
        return Evasion(Profile(self.grid.first, s.step, path), len(path) == rows, cost)

    def _at_first_row(self) -> tuple[float, float]:
        """Distance from the line and turn at the first row's place, of who moves on as the start does.

        No steeper than the grid leads.
        """
        s, start, line = self.settings, self.start, self.line
        ahead, left = line.coordinates(start.x, start.z)
        turned = math.remainder(start.heading - line.facing, math.tau)
        sine, cosine = math.sin(start.heading - line.heading), math.cos(start.heading - line.heading)
        along, across = start.forward * cosine - start.lateral * sine, start.forward * sine + start.lateral * cosine
        if along < _SLOW:
            return left, turned
        steps, swing = (self.grid.first - ahead) / s.step, s.most / s.turns
        aside = min(max(across / along * s.step, -s.aside), s.aside)
        swung = min(max(start.turn / along * s.step, -swing), swing)
        return left + steps * aside, turned + steps * swung

    def _cells(self, left: Floats, turned: Floats) -> Indices:
        """The columns and turns (N, 2) nearest to distances from the line and to turns (N,)."""
        s, (columns, turns) = self.settings, self.room.clear.shape[2:]
        column = np.clip(np.rint(left / s.aside) + columns // 2, 0, columns - 1)
        turn = np.clip(np.rint(turned / s.most * s.turns) + s.turns, 0, turns - 1)
        return np.stack([column, turn], axis=1).astype(np.int64)


def _rows_at(profile: Profile, first: float, step: float, count: int) -> tuple[Floats, Floats]:
    """Distance from the line and turn of a profile at rows of a grid, (count,) each."""
    at = (first + step * np.arange(count) - profile.first) / profile.step
    known = np.arange(len(profile.rows))
    return np.interp(at, known, profile.rows[:, 0]), np.interp(at, known, profile.rows[:, 1])
