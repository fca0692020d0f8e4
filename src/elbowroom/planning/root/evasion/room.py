"""The room that a body has on a grid of places along a line, at each of them in several turns.

It is read from the map of free distances, for discs that stand for the body, and is a guess, good to some 2 cm. Where
that decides, in narrow cells that a path leads through, the capsules themselves are held against what stands, and the
best place of the cell is found.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, inner_exact_kernel
from elbowroom.planning.root.evasion.turned_body import Discs, Turned, TurnedBody
from elbowroom.planning.root.line.line import TravelLine
from elbowroom.world.obstacles.clearance import lower_clearance
from elbowroom.world.obstacles.free_map import CELL, LEVELS, Window
from elbowroom.world.obstacles.from_above import away_of, ball_radius, heights_of, place_of
from elbowroom.world.obstacles.layout import Nearby, Spans
from elbowroom.world.obstacles.rows import any_in, at_span, first_of, how_many, room_for, shifted_into

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]
Bools = NDArray[np.bool_]

_NARROW = 0.06  # metres of clearance of legs or trunk below which a cell is checked
_PLACES = 9  # within such a cell, from one side to the other
_DOUBT = 0.005  # metres by which the map may say too little
_MOST = 240  # cells of a grid that are checked: beyond them the map is believed


class LineGrid(NamedTuple):
    """Places along a line. Metres."""

    first: float  # place of the first row on the line
    step: float  # between rows
    aside: float  # between columns
    rows: int
    columns: int  # odd: the middle one is the line
    comfort: float  # more clearance than this counts as this
    margin: float  # clearance that legs must have
    ample: float  # clearance of legs that is enough for everything: cells that may be free are taken to have it


class GridFloor(NamedTuple):
    """What feet stand on over a grid. Metres."""

    heights: Floats  # (rows, columns)
    step: float  # what rises no higher above it is stepped onto; minus infinity on the plane


def places_on(line: TravelLine, grid: LineGrid) -> Floats:
    """The places (rows, columns, 2), x and z, of a grid along a line."""
    left: Floats = grid.aside * (np.arange(float(grid.columns)) - grid.columns // 2)
    ahead: Floats = grid.first + grid.step * np.arange(float(grid.rows))[:, None]
    return np.stack(np.broadcast_arrays(*line.point(ahead, left)), axis=-1)


class Room:
    """The room of a body on a grid, among what stands and what passes each row when it is reached."""

    def __init__(
        self,
        body: TurnedBody,
        turned: Turned,
        line: TravelLine,
        grid: LineGrid,
        where: tuple[Window, GridFloor],
        near: Nearby,
        passing: Spans,
    ) -> None:
        """What is `near` stands, as on the map's window over a floor; what is `passing` moves, a span for each row."""
        shape = grid.rows, grid.columns, len(turned.slowness)
        self.clear: Floats32 = np.empty((3, *shape), np.float32)  # of legs, trunk, hanging arms
        self.shift: Floats32 = np.zeros(shape, np.float32)  # metres to the left, from a cell's middle to its best place
        places, (window, floor) = places_on(line, grid), where
        aside = math.cos(line.heading), -math.sin(line.heading)
        known, capsules = np.zeros(shape, np.bool_), _turned_to(line.facing, turned.capsules)
        self._near, self._passing = near, passing
        self._checked = 0
        self._cells = _Cells(
            self.clear, self.shift, known, places, floor, aside, grid, capsules, body.groups, body.radii,
            turned.discs.reach, float((turned.capsules[:, :, [1, 4]].max(axis=2) + body.radii).max()),
        )  # fmt: skip
        discs = _shape(turned.discs, line.facing)
        _read(self.clear, window, discs, places, grid)
        if any_in(passing):
            _pass(self.clear, discs, places, (passing, floor.heights), LEVELS, grid)

    def check_narrow(self, cells: Indices) -> bool:
        """Check those narrow cells of a path, column and turn (m, 2) in each row; whether any was not known."""
        count = _check_narrow(self._cells, cells, self._near, self._passing, _MOST - self._checked)
        self._checked += count
        return count > 0


class _Cells(NamedTuple):
    """What is known of the cells, and what it takes to know more."""

    clear: Floats32  # as in `Room`
    shift: Floats32
    known: Bools  # (rows, columns, T) cells that were checked
    places: Floats  # (rows, columns, 2) of their middles
    floor: GridFloor
    left: tuple[float, float]  # a metre to the left of the line, x and z
    grid: LineGrid
    capsules: Floats32  # (T, C, 6) facing along the line
    groups: Indices  # (4,) where legs, trunk and arms begin among them; the end
    radii: Floats32  # (C,)
    reach: float  # of them
    tall: float  # how high they reach, metres


@exact_kernel
def _check_narrow(room: _Cells, cells: Indices, near: Nearby, passing: Spans, most: int) -> int:
    """`Room.check_narrow` among what stands near and passes, until at least `most` cells were; how many were.

    Where legs turn out to lack room, the cells beside that one are checked too: paths would lead there next.
    """
    count, columns, turns = 0, room.clear.shape[2], room.clear.shape[3]
    first = at_span(passing, 0)
    standing, moving = room_for(near, how_many(near)), room_for(first, how_many(first))
    for i in range(cells.shape[0]):
        j, t = cells[i, 0], cells[i, 1]
        if count >= most or not _in_doubt(room, i, j, t):
            continue
        count += 1
        stand = first_of(standing, _copy_near(near, room, i, j, standing))
        move = first_of(moving, _copy_near(at_span(passing, i), room, i, j, moving))
        _measure(room, (i, j, t), 0.0, stand, move)
        if room.clear[0, i, j, t] < room.grid.margin:
            for m in range(max(j - 1, 0), min(j + 2, columns)):
                for n in range(max(t - 1, 0), min(t + 2, turns)):
                    if _in_doubt(room, i, m, n):
                        count += 1
                        _measure(room, (i, m, n), (m - j) * room.grid.aside, stand, move)
    return count


@inner_exact_kernel
def _copy_near(own: Nearby, room: _Cells, i: int, j: int, out: Nearby) -> int:
    """Copy the obstacles that may come near a body in row i and column j to `out`, as seen from there; their number."""
    reach, count = room.reach + room.grid.comfort + 2.0 * room.grid.aside, 0
    place, height = room.places[i, j], room.floor.heights[i, j]
    top = height + room.tall + room.grid.comfort
    for b in range(how_many(own)):
        x, z = place_of(own, b)
        bottom, high = heights_of(own, b)
        if (
            bottom < top
            and high > height + room.floor.step
            and np.hypot(x - place[0], z - place[1]) < ball_radius(own, b) + reach
        ):
            shifted_into(own, b, (place[0], height, place[1]), out, count)
            count += 1
    return count


@inner_exact_kernel
def _in_doubt(room: _Cells, i: int, j: int, t: int) -> bool:
    """Whether a cell is narrow, by the map alone."""
    return not room.known[i, j, t] and min(room.clear[0, i, j, t], room.clear[1, i, j, t]) < _NARROW


@helper
def _best_of(own: Floats32, comfort: float, fine: float) -> float:
    """At which of some places (n,), `fine` metres apart, there is most room, or between which."""
    middle = own.shape[0] // 2
    best = middle
    for n in range(own.shape[0]):
        if own[n] > own[best] or (own[n] == own[best] and abs(n - middle) < abs(best - middle)):
            best = n
    if own[best] >= comfort or best == 0 or best == own.shape[0] - 1:
        return float(best)
    return float(best + min(max(0.5 * (own[best + 1] - own[best - 1]) / fine, -0.5), 0.5))


@inner_exact_kernel
def _measure(room: _Cells, cell: tuple[int, int, int], beside: float, standing: Nearby, moving: Nearby) -> None:
    """The clearance of the capsules in a cell at its best place, and where that is; all is seen from `beside` it.

    Best is where legs, if they lack room, else the trunk, else the arms have most. Clearance changes by no more than
    one walks, so neighbours bound it, and between parallel walls it is the bound.
    """
    (i, j, t), middle = cell, _PLACES // 2
    fine, comfort = room.grid.aside / (_PLACES - 1), room.grid.comfort
    room.known[i, j, t] = True
    segments, capsules = np.empty((room.radii.shape[0], 6, _PLACES), np.float32), room.capsules[t]
    for c in range(segments.shape[0]):
        for k in range(6):
            along = room.left[0] if k % 3 == 0 else room.left[1] if k % 3 == 2 else 0.0
            for n in range(_PLACES):
                segments[c, k, n] = capsules[c, k] + (beside + fine * (n - middle)) * along
    found = np.full((3, _PLACES), np.float32(comfort))
    for g in range(3):
        part = slice(room.groups[g], room.groups[g + 1])
        for near in (standing, moving):
            if how_many(near) > 0:
                lower_clearance(segments[part], room.radii[part], near, found[g])
    at = float(middle)
    for g in range(3):
        if found[g, middle] < comfort:
            at = _best_of(found[g], comfort, fine)
            break
    room.shift[i, j, t] = fine * (at - middle)
    n = min(int(at), _PLACES - 2)
    for g in range(3):
        room.clear[g, i, j, t] = found[g, n] + (at - n) * (found[g, n + 1] - found[g, n])


class _Shape(NamedTuple):
    """Discs of a body that means to face along a line, in points of the map."""

    discs: Discs
    offsets: Floats  # (K, 2) from the root, along x and z
    reaches: Floats  # (K,) metres from the root


def _turned_to(facing: float, capsules: Floats32) -> Floats32:
    """Capsules (T, C, 6) of a body that means to face ahead, when that is `facing`."""
    sine, cosine = np.sin(facing), np.cos(facing)
    ends = capsules.reshape(-1, 3).astype(np.float64)
    x, y, z = ends.T
    turned = np.stack([x * cosine + z * sine, y, z * cosine - x * sine], axis=1)
    return turned.reshape(capsules.shape).astype(np.float32)


@exact_kernel
def _shape(discs: Discs, facing: float) -> _Shape:
    offsets, reaches = np.empty(discs.places.shape), np.empty(discs.radii.shape[0])
    sine, cosine = np.sin(facing), np.cos(facing)
    for k in range(reaches.shape[0]):
        left, ahead = discs.places[k, 0], discs.places[k, 1]
        offsets[k, 0], offsets[k, 1] = (ahead * sine + left * cosine) / CELL, (ahead * cosine - left * sine) / CELL
        reaches[k] = np.hypot(left, ahead) + discs.radii[k]
    return _Shape(discs, offsets, reaches)


@helper
def free_distance(distances: Floats32, level: int, a: float, b: float) -> float:
    """What a window says at a level, at grid coordinates along x and z, bilinear; the nearest edge holds outside."""
    p, q = min(max(a, 0.0), distances.shape[1] - 1.0), min(max(b, 0.0), distances.shape[2] - 1.0)
    i, k = min(int(p), distances.shape[1] - 2), min(int(q), distances.shape[2] - 2)
    u, v = p - i, q - k
    low = distances[level, i, k] * (1.0 - v) + distances[level, i, k + 1] * v
    high = distances[level, i + 1, k] * (1.0 - v) + distances[level, i + 1, k + 1] * v
    return float(low * (1.0 - u) + high * u)


@helper
def _open_from(grid: LineGrid) -> float:
    """The clearance of legs in the middle of a cell from which on there may be a place in it where they are free."""
    return grid.margin - 0.5 * grid.aside - _DOUBT


@exact_kernel
def _read(clear: Floats32, window: Window, shape: _Shape, places: Floats, grid: LineGrid) -> None:
    """Fill `clear` (3, rows, columns, T) with what the map says at `places` (rows, columns, 2)."""
    distances, discs, comfort, open_from = window.distances, shape.discs, grid.comfort, _open_from(grid)
    roots, starts, all_levels, radii = np.empty(distances.shape[0]), discs.starts, discs.levels, discs.radii
    offsets, reaches = shape.offsets, shape.reaches
    for i in range(clear.shape[1]):
        for j in range(clear.shape[2]):
            a, b, around = (places[i, j, 0] - window.x) / CELL, (places[i, j, 1] - window.z) / CELL, np.inf
            for level in range(roots.shape[0]):
                roots[level] = free_distance(distances, level, a, b)
                around = min(around, roots[level])
            clear[:, i, j] = comfort
            for t in range(clear.shape[3] if around < discs.reach + comfort else 0):
                for g in range(3):
                    least, enough = comfort, open_from if g == 0 else -np.inf
                    for k in range(starts[t, g], starts[t, g + 1]):
                        level = all_levels[k]
                        if roots[level] - reaches[k] < least:  # else it is no nearer
                            away = free_distance(distances, level, a + offsets[k, 0], b + offsets[k, 1])
                            least = min(least, away - radii[k])
                            if least < enough:
                                break
                    clear[g, i, j, t] = max(least, grid.ample) if g == 0 and least >= enough else least
                    if least < enough:
                        break


@exact_kernel
def _pass(
    clear: Floats32, shape: _Shape, places: Floats, over: tuple[Spans, Floats], heights: Floats, grid: LineGrid
) -> None:
    """Lower `clear` to what upright boxes that pass leave, a span for each row, `over` floors (rows, columns)."""
    passing, floors = over
    discs, offsets, reaches = shape.discs, shape.offsets, shape.reaches
    starts, levels, radii = discs.starts, discs.levels, discs.radii
    for i in range(clear.shape[1]):
        own = at_span(passing, i)
        for m in range(how_many(own)):
            bottom, top = heights_of(own, m)
            for j in range(clear.shape[2]):
                x, z = places[i, j, 0], places[i, j, 1]
                away = away_of(own, m, x, z)
                for t in range(clear.shape[3] if away < discs.reach + grid.comfort else 0):
                    if clear[0, i, j, t] < _open_from(grid):
                        continue
                    for g in range(3):
                        least = clear[g, i, j, t]
                        for k in range(starts[t, g], starts[t, g + 1]):
                            height, radius = floors[i, j] + heights[levels[k]], radii[k]
                            if bottom - radius < height < top + radius and away - reaches[k] < least:
                                p, q = x + CELL * offsets[k, 0], z + CELL * offsets[k, 1]
                                least = min(least, away_of(own, m, p, q) - radius)
                        clear[g, i, j, t] = least
