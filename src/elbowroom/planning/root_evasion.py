"""Past what the straight way leaves no room for: aside, turned sideways, or both, as cheaply as possible.

Along the line of travel lies a grid of places, and at each of them the body may face the line's way or be turned away
from it. The cheapest way through that grid, by dynamic programming over its rows, is an *evasion*: how far to the side
to walk, and how far to turn the body, at each step ahead. Costs are seconds: sideways one walks slower, and every metre
aside, every turn and every lack of room costs some.

Legs and pelvis must be free, as they are posed in a stride of that direction. For the trunk and the hanging arms a lack
of room is only dear, because they can bend: how dear is what tells one evasion from another.
"""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import body_model, posture_capsules
from elbowroom.body.root import ROOT_STATE, RootState
from elbowroom.planning.root_cells import Prices, cheapest, pulled_taut
from elbowroom.planning.root_line import TravelLine
from elbowroom.planning.root_profile import Profile, turned_speed
from elbowroom.planning.root_room import Room, room_of
from elbowroom.world.boxes import BOX_ROW
from elbowroom.world.moving import MovingBoxes

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

_GAIN = 2.0  # m/s^2, of speeding up
_PHASES = 6  # moments of the stride in which the legs are looked at


@dataclass(frozen=True)
class EvasionSettings:
    """The grid and what things cost. Metres, radians, seconds."""

    step: float = 0.1  # between rows
    aside: float = 0.04  # between columns
    sideways: float = 0.45  # m/s: with long steps to the side the knees come forward
    punctual: float = 0.2  # seconds before and after that a row may be reached in
    polite: float = 0.05  # metres by which what moves is taken to be larger
    cares: tuple[float, ...] = (0.0, 0.015)  # clearance beyond the margin, tried in turn
    shares: tuple[float, ...] = (1.0, 0.75, 0.5)  # of both speeds, tried in turn
    widest: float = 0.48  # from the line of travel, to either side
    turns: int = 4  # turned postures to either side
    most: float = 0.5 * math.pi  # the body is turned by at most this
    margin: float = 0.012  # clearance that legs and pelvis must have
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
    keeping: float = 0.004  # of each row: what another way must be better than the one being followed
    ends: tuple[float, float] = (3.0, 0.2)  # for the squared distance and the squared angle at the end
    slack: float = 0.03  # clearance beyond which a way is free to be pulled taut

    @property
    def angles(self) -> Floats:
        """The turns (T,) of the body from the line's facing."""
        return np.linspace(-self.most, self.most, 2 * self.turns + 1)


# Farther to the side, with more room, on a coarser grid that is no larger; as steep as the fine one.
WIDE = EvasionSettings(
    step=0.2, aside=0.08, widest=1.2, comfort=0.15, slack=0.12, shifting=0.01, turning=0.5, keeping=0.008,
    cares=(0.0,), bodies=((40.0, 40.0),),
)  # fmt: skip


class Evasion(NamedTuple):
    """A way through the grid."""

    profile: Profile
    whole: bool  # whether it leads to the last row
    cost: float  # seconds


class EvasionFinder:
    """Finds evasions for one humanoid among some boxes; frozen once made."""

    def __init__(self, humanoid: Humanoid, table: Floats, settings: EvasionSettings | None = None) -> None:
        self.settings = settings or EvasionSettings()
        self._table = table
        self._model, capsules = body_model(humanoid), humanoid.capsules
        legs = capsules.of(DofGroup.ROOT)
        arms = np.concatenate([capsules.of(DofGroup.LEFT_ARM), capsules.of(DofGroup.RIGHT_ARM)])
        self._members = (legs, capsules.of(DofGroup.WAIST), arms)
        counts = [_PHASES * len(legs), len(self._members[1]), len(arms)]
        self._groups = np.concatenate([[0], np.cumsum(counts)])
        radii = capsules.radii.astype(np.float32)
        self._radii = np.concatenate([np.tile(radii[legs], _PHASES), radii[self._members[1]], radii[arms]])

    def ahead_of(
        self,
        line: TravelLine,
        start: RootState,
        sight: float,
        speeds: tuple[float, float],
        moving: MovingBoxes,
        time: float,
    ) -> "EvasionGrid":
        """The grid from a start on at a time, for `speeds` forward and sideways, m/s.

        What moves is where it will be about when a row is reached, by who speeds up at once.
        """
        s = self.settings
        headings = line.facing + s.angles
        bodies = np.stack([self._body(line.heading - heading, heading, speeds) for heading in headings])
        first = line.coordinates(start.x, start.z)[0]
        origin = line.point(first)
        table = self._table.copy()
        table[:, 0] -= origin[0]
        table[:, 2] -= origin[1]
        reach = sight + s.widest + float(np.abs(bodies).max()) + np.linalg.norm(table[:, 12:], axis=1)
        near = np.hypot(table[:, 0], table[:, 2]) < reach
        place = np.array([math.sin(line.heading), math.cos(line.heading), s.step, s.aside, s.comfort])
        shape = (math.ceil(sight / s.step) + 1, 2 * round(s.widest / s.aside) + 1)
        passing = self._passing(moving, time, s.step * np.arange(float(shape[0])), start, speeds[0])
        passing[:, :, 0] -= origin[0]
        passing[:, :, 2] -= origin[1]
        rows = np.ascontiguousarray(table[near], np.float32)
        room = room_of(bodies, self._groups, self._radii, rows, passing.astype(np.float32), place, shape)
        return EvasionGrid(s, line, start, speeds, first, room, len(moving) > 0)

    def _passing(self, moving: MovingBoxes, time: float, ahead: Floats, start: RootState, speed: float) -> Floats:
        """Rows (n, M, 15) of what moves about when places `ahead` (n,) metres are reached, a little larger."""
        s, out = self.settings, np.zeros((len(ahead), len(moving), BOX_ROW))
        if not len(moving):
            return out
        for i, then in enumerate(time + _arrival(ahead, math.hypot(start.forward, start.lateral), speed)):
            out[i] = moving.swept([max(then - s.punctual, time), then + s.punctual])[0]
        out[..., [12, 14]] += s.polite
        return out

    def _body(self, way: float, heading: float, speeds: tuple[float, float]) -> Floats32:
        """Capsules (C, 6) of a body at the origin that walks `way` from where it faces; every phase's legs."""
        speed = turned_speed(*speeds, way)
        states = np.zeros((_PHASES, ROOT_STATE))
        states[:, 2], states[:, 3], states[:, 4] = heading, speed * math.cos(way), speed * math.sin(way)
        states[:, 6] = np.arange(_PHASES) / _PHASES
        segments = posture_capsules(self._model, np.zeros((_PHASES, DOF)), states)
        legs, trunk, arms = self._members
        posed = [segments[legs, :, phase] for phase in range(_PHASES)]
        return np.concatenate([*posed, segments[trunk, :, 0], segments[arms, :, 0]])


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
    speeds: tuple[float, float]
    first: float  # metres: the first row's place on the line
    room: Room
    passing: bool  # whether something moves

    @property
    def cells(self) -> int:
        """The number of cells whose clearance was computed."""
        return int(self.room.shift.size)

    def cheapest(self, bodies: tuple[float, float], kept: Profile | None, care: float = 0.0) -> Evasion:
        """The cheapest way, with `bodies` as in the settings; `kept` is the one being followed.

        Legs keep `care` metres more than the settings ask for.
        """
        s, rows = self.settings, self.room.clear.shape[1]
        ways = s.angles + self.line.facing - self.line.heading
        seconds = np.array([1.0 / turned_speed(*self.speeds, way) for way in ways])
        standing = s.step * (seconds - seconds.min() + s.turned * s.angles**2)
        ends = s.ends[0] * s.aside**2, s.ends[1] * (s.most / s.turns) ** 2
        leftward = s.step * s.aside * s.leftward if self.passing else 0.0
        prices = Prices(
            s.margin + care, s.swerving, s.comfort, s.step * s.beside * s.aside**2, leftward, s.shifting, s.turning,
            s.spot, (s.step * s.legs, s.step * bodies[0], s.step * bodies[1]), s.keeping, ends,
        )  # fmt: skip
        favoured = np.full((rows, 2), -9) if kept is None else self._cells(*_rows_at(kept, self.first, s.step, rows))
        left = self.line.coordinates(self.start.x, self.start.z)[1]
        turned = math.remainder(self.start.heading - self.line.facing, math.tau)
        begin = self._cells(np.array([left]), np.array([turned]))[0]
        cells, cost = cheapest(self.room.clear, standing, prices, begin, favoured)
        places = pulled_taut(self.room, cells, left, s.aside, s.slack)
        way = np.stack([places, s.angles[cells[:, 1]]], axis=1)
        if cells[0, 1] == begin[1]:
            way[0, 1] = turned
        return Evasion(Profile(self.first, s.step, way), len(way) == rows, cost)

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
