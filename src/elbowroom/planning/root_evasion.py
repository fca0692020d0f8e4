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
from elbowroom.jit import exact_kernel
from elbowroom.planning.root_line import TravelLine
from elbowroom.planning.root_profile import Profile, turned_speed
from elbowroom.world.boxes import BOX_ROW
from elbowroom.world.clearance import clearance_into
from elbowroom.world.moving import MovingBoxes

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

_TALL = 2.0  # metres: height of the axis round which a body is looked for
_SWEEPS = 12  # of evening out
_LEAVING = 3  # rows near the start that need no more room than the start has
_PHASES = 6  # moments of the stride in which the legs are looked at


@dataclass(frozen=True)
class EvasionSettings:
    """The grid and what things cost. Metres, radians, seconds."""

    step: float = 0.1  # between rows
    aside: float = 0.04  # between columns
    sideways: float = 0.45  # m/s: with long steps to the side the knees come forward
    punctual: float = 0.2  # seconds before and after that a row may be reached in
    cares: tuple[float, ...] = (0.0, 0.015)  # clearance beyond the margin, tried in turn
    shares: tuple[float, ...] = (1.0, 0.75, 0.5)  # of both speeds, tried in turn
    widest: float = 0.48  # from the line of travel, to either side
    turns: int = 4  # turned postures to either side
    most: float = 0.5 * math.pi  # the body is turned by at most this
    margin: float = 0.012  # clearance that legs and pelvis must have
    swerving: float = 0.02  # more of it where the body turns on the way
    comfort: float = 0.06  # clearance below which it costs
    beside: float = 2.0  # of each metre walked, for the squared distance from the line
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


class Evasion(NamedTuple):
    """A way through the grid."""

    profile: Profile
    whole: bool  # whether it leads to the last row
    cost: float  # seconds


class _Prices(NamedTuple):
    """What the search needs of the settings, in grid units."""

    margin: float
    swerving: float
    comfort: float
    beside: float  # for the squared number of columns
    shifting: float
    turning: float
    spot: float
    bodies: tuple[float, float, float]  # for a row, for each metre that legs, trunk, arms lack
    keeping: float
    ends: tuple[float, float]


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

        What moves is where it will be about when a row is reached at full speed.
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
        passing = np.zeros((shape[0], len(moving), BOX_ROW))
        for i in range(shape[0] if len(moving) else 0):
            then = time + i * s.step / speeds[0]
            passing[i] = moving.swept([max(then - s.punctual, time), then + s.punctual])[0]
        passing[:, :, 0] -= origin[0]
        passing[:, :, 2] -= origin[1]
        rows = np.ascontiguousarray(table[near], np.float32)
        room = _room(bodies, self._groups, self._radii, rows, passing.astype(np.float32), place, shape)
        return EvasionGrid(s, line, start, speeds, first, room)

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


class EvasionGrid(NamedTuple):
    """The clearance of the body along a line of travel."""

    settings: EvasionSettings
    line: TravelLine
    start: RootState
    speeds: tuple[float, float]
    first: float  # metres: the first row's place on the line
    room: "Room"

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
        prices = _Prices(
            s.margin + care, s.swerving, s.comfort, s.step * s.beside * s.aside**2, s.shifting, s.turning, s.spot,
            (s.step * s.legs, s.step * bodies[0], s.step * bodies[1]), s.keeping, ends,
        )  # fmt: skip
        favoured = np.full((rows, 2), -9) if kept is None else self._cells(*_rows_at(kept, self.first, s.step, rows))
        left = self.line.coordinates(self.start.x, self.start.z)[1]
        turned = math.remainder(self.start.heading - self.line.facing, math.tau)
        begin = self._cells(np.array([left]), np.array([turned]))[0]
        cells, cost = _cheapest(self.room.clear, standing, prices, begin, favoured)
        places = _pulled_taut(self.room, cells, left, s.aside, s.slack)
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


class Room(NamedTuple):
    """The room on a grid, with each cell's best place: not more than half a column from its middle."""

    clear: Floats32  # (3, rows, columns, turns) of legs, trunk, hanging arms; no more than the comfort
    shift: Floats32  # (rows, columns, turns) metres from the middle to the best place, to the left


@exact_kernel
def _extents(body: Floats32, radii: Floats32) -> tuple[float, float, float]:
    """How far capsules (C, 6) reach from the origin, seen from above; their lowest and highest point."""
    most, low, high = 0.0, np.inf, -np.inf
    for c in range(body.shape[0]):
        for e in (0, 3):
            most = max(most, np.sqrt(body[c, e] ** 2 + body[c, e + 2] ** 2) + radii[c])
            low, high = min(low, body[c, e + 1] - radii[c]), max(high, body[c, e + 1] + radii[c])
    return most, low, high


@exact_kernel
def _lower_to_box(
    body: Floats32, radii: Floats32, x: Floats32, z: Floats32, box: Floats32, away: Floats32, most: float, out: Floats32
) -> None:
    """out[n] = min(out[n], clearance of the body at place n); `away` (N,) is the clearance of the place's own axis."""
    reach, low, high = _extents(body, radii)
    span = 0.0
    for k in range(3):
        span += abs(box[0, 4 + 3 * k]) * box[0, 12 + k]
    if box[0, 1] - span > high + most or box[0, 1] + span < low - most:
        return
    near, count = np.empty(x.shape[0], np.int64), 0
    for n in range(x.shape[0]):
        if away[n] < reach + most:
            near[count] = n
            count += 1
    if count == 0:
        return
    segments, found = np.empty((body.shape[0], 6, count), np.float32), np.empty(count, np.float32)
    for c in range(body.shape[0]):
        for e in (0, 3):
            row_x, row_y, row_z = segments[c, e], segments[c, e + 1], segments[c, e + 2]
            for i in range(count):
                row_x[i], row_y[i], row_z[i] = body[c, e] + x[near[i]], body[c, e + 1], body[c, e + 2] + z[near[i]]
    clearance_into(segments, radii, box, found)
    for i in range(count):
        out[near[i]] = min(out[near[i]], found[i])


@exact_kernel
def _room(
    bodies: Floats32,
    groups: Indices,
    radii: Floats32,
    table: Floats32,
    passing: Floats32,
    place: Floats,
    shape: tuple[int, int],
) -> Room:
    """The room of the body's parts `groups` on the grid, a batch for each box, turn and part.

    `table` (B, 15) stands still, `passing` (rows, M, 15) is where a row is when it matters.
    `place`: sine and cosine of the line's heading, the distance of rows and of columns, and the comfort.
    """
    sine, cosine, step, aside, comfort = place[0], place[1], place[2], place[3], place[4]
    rows, columns = shape
    total, turns = rows * columns, bodies.shape[0]
    x, z = np.empty(total, np.float32), np.empty(total, np.float32)
    for n in range(total):
        ahead, left = (n // columns) * step, (n % columns - columns // 2) * aside
        x[n], z[n] = ahead * sine + left * cosine, ahead * cosine - left * sine
    axis = np.zeros((1, 6, total), np.float32)
    axis[0, 0], axis[0, 2], axis[0, 3], axis[0, 4], axis[0, 5] = x, z, x, np.float32(_TALL), z
    out, away = np.full((3, turns, total), np.float32(comfort), np.float32), np.empty(total, np.float32)
    for b in range(table.shape[0]):
        box = table[b : b + 1]
        clearance_into(axis, np.zeros(1, np.float32), box, away)
        for t in range(turns):
            for g in range(3):
                part = slice(groups[g], groups[g + 1])
                _lower_to_box(bodies[t, part], radii[part], x, z, box, away, comfort, out[g, t])
    for i in range(rows):
        row = slice(i * columns, (i + 1) * columns)
        for b in range(passing.shape[1]):
            box = passing[i, b : b + 1]
            clearance_into(axis[:, :, row].copy(), np.zeros(1, np.float32), box, away[row])
            for t in range(turns):
                for g in range(3):
                    part = slice(groups[g], groups[g + 1])
                    _lower_to_box(bodies[t, part], radii[part], x[row], z[row], box, away[row], comfort, out[g, t, row])
    clear = np.ascontiguousarray(out.reshape(3, turns, rows, columns).transpose(0, 2, 3, 1))
    return _at_best(clear, comfort, aside)


@exact_kernel
def _at_best(clear: Floats32, comfort: float, aside: float) -> Room:
    """The room at every cell's best place.

    Clearance changes by no more than one walks: so neighbours bound it, and between parallel walls it is the bound.
    """
    best, shift = clear.copy(), np.zeros(clear.shape[1:], np.float32)
    for i in range(clear.shape[1]):
        for j in range(1, clear.shape[2] - 1):
            for t in range(clear.shape[3]):
                for g in range(2, -1, -1):
                    own, right, left = clear[g, i, j, t], clear[g, i, j - 1, t], clear[g, i, j + 1, t]
                    if own < comfort:
                        best[g, i, j, t] = min(own + 0.5 * aside, max(0.5 * (left + right) + aside, own), comfort)
                        shift[i, j, t] = min(max(0.5 * (left - right), -0.5 * aside), 0.5 * aside)
    return Room(best, shift)


@exact_kernel
def _pulled_taut(room: Room, way: Indices, begin: float, aside: float, slack: float) -> Floats:
    """The distances (m,) from the line of a way through cells, evened out as far as there is room beyond `slack`."""
    count = way.shape[0]
    middle, free, out = np.empty(count), np.empty(count), np.empty(count)
    for i in range(count):
        j, t = way[i, 0], way[i, 1]
        middle[i] = aside * (j - room.shift.shape[1] // 2) + room.shift[i, j, t]
        free[i] = max(min(room.clear[0, i, j, t], room.clear[1, i, j, t]) - slack, 0.0)
        out[i] = middle[i]
    out[0] = begin
    for _ in range(_SWEEPS):
        for i in range(1, count - 1):
            even = 0.5 * (out[i - 1] + out[i + 1])
            out[i] = min(max(even, middle[i] - free[i]), middle[i] + free[i])
    return out


@exact_kernel
def _cheapest(
    clear: Floats32, standing: Floats, prices: _Prices, begin: Indices, favoured: Indices
) -> tuple[Indices, float]:
    """Columns and turns (m, 2) of the cheapest way from the cell `begin` to the farthest row that can be reached.

    `standing` (turns,) is what a row costs in each turn; `favoured` (rows, 2) the cells that are liked.
    """
    rows, columns, turns = clear.shape[1], clear.shape[2], clear.shape[3]
    cost, parents = np.full((rows, columns, turns), np.inf), np.zeros((rows, columns, turns), np.int8)
    _turn_on_the_spot(clear[0, 0, begin[0]], prices, begin[1], cost[0, begin[0]])
    here, last = min(clear[0, 0, begin[0], begin[1]], prices.margin), 0
    while last + 1 < rows and _settle(clear, standing, prices, here, favoured, last + 1, cost, parents):
        last += 1
    least, end_j, end_t = np.inf, begin[0], begin[1]
    for j in range(columns):
        for t in range(turns):
            beside, turned = (j - columns // 2) ** 2, (t - turns // 2) ** 2
            total = cost[last, j, t] + prices.ends[0] * beside + prices.ends[1] * turned
            if total < least:
                least, end_j, end_t = total, j, t
    way = np.empty((last + 1, 2), np.int64)
    for i in range(last, -1, -1):
        way[i, 0], way[i, 1] = end_j, end_t
        move = parents[i, end_j, end_t]
        if i > 0:
            end_j, end_t = end_j - (move // 3 - 1), end_t - (move % 3 - 1)
    return way, least


@exact_kernel
def _turn_on_the_spot(clear: Floats32, prices: _Prices, begin: int, cost: Floats) -> None:
    """What it costs (turns,) to begin in another turn than `begin`, where there is room for it."""
    cost[begin] = 0.0
    for side in (-1, 1):
        t = begin + side
        while 0 <= t < cost.shape[0] and clear[t] >= prices.margin + prices.swerving:
            cost[t] = cost[t - side] + prices.spot
            t += side


@exact_kernel
def _settle(
    clear: Floats32,
    standing: Floats,
    prices: _Prices,
    here: float,
    favoured: Indices,
    i: int,
    cost: Floats,
    parents: NDArray[np.int8],
) -> bool:
    """Cost and parent of every cell of row `i`; whether any can be reached. `here` is asked for near the start."""
    reached, needed = False, here if i <= _LEAVING else prices.margin
    for j in range(clear.shape[2]):
        for t in range(clear.shape[3]):
            if clear[0, i, j, t] < needed:
                continue
            best, move = _best_move(clear, prices, i, j, t, cost)
            if best == np.inf:
                continue
            own = standing[t] + prices.beside * (j - clear.shape[2] // 2) ** 2
            for g in range(3):
                own += prices.bodies[g] * (prices.comfort - clear[g, i, j, t])
            if abs(favoured[i, 0] - j) <= 1 and abs(favoured[i, 1] - t) <= 1:
                own -= prices.keeping
            cost[i, j, t], parents[i, j, t] = best + own, move
            reached = True
    return reached


@exact_kernel
def _best_move(clear: Floats32, prices: _Prices, i: int, j: int, t: int, cost: Floats) -> tuple[float, int]:
    """The cheapest way to a cell from the row before it, and by which of nine moves."""
    best, move = np.inf, 0
    for m in range(9):
        dj, dt = m // 3 - 1, m % 3 - 1
        if not (0 <= j - dj < clear.shape[2] and 0 <= t - dt < clear.shape[3]):
            continue
        narrow = min(clear[0, i, j, t], clear[0, i - 1, j - dj, t - dt])
        if dt != 0 and narrow < prices.margin + prices.swerving:
            continue
        total = cost[i - 1, j - dj, t - dt] + prices.shifting * dj * dj + prices.turning * dt * dt
        if total < best:
            best, move = total, m
    return best, move
