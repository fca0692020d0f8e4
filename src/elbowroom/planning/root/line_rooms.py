"""The room along a line of travel: of what stands it is kept, row by row, as long as that line is walked.

Rows lie at whole steps from the line's first point, so they stay where they are while the avatar walks on.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.root.line import TravelLine
from elbowroom.planning.root.room import Room, lower_rows, room_at_best
from elbowroom.planning.root.turned_body import Turned, TurnedBody
from elbowroom.world.obstacles.layout import Spans
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import always, any_in

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_KEPT = 4  # times as many rows as are asked for


class Grid(NamedTuple):
    """Places beside a line. Metres."""

    step: float  # between rows
    aside: float  # between columns
    columns: int  # odd: the middle one is the line
    comfort: float  # more clearance than this counts as this


class LineRooms:
    """Finds the room of one body among what stands, and what is left of it by what passes."""

    def __init__(self, body: TurnedBody, obstacles: Obstacles, angles: Floats, grid: Grid) -> None:
        """Of `obstacles` those count that stand; the body is looked at in turns by `angles` (T,)."""
        self._body, self._obstacles, self._angles, self._grid = body, obstacles, angles, grid
        self._known: tuple[tuple[TravelLine, tuple[float, float]], Turned] | None = None
        self._rows: dict[float, Floats32] = {}  # (3, T, columns) each, by their place on the line in steps

    def ahead(
        self, line: TravelLine, speeds: tuple[float, float], first: float, count: int, passing: Spans
    ) -> tuple[Room, Floats]:
        """The room in `count` rows from row `first` on, and the seconds that a metre takes in each turn (T,).

        `speeds` forward and sideways are m/s; `passing` (count, M) is what moves, where it is for each row.
        """
        asked = line, speeds
        if self._known is None or self._known[0] != asked:
            self._known = asked, self._beside(line, self._body.along(line, self._angles, speeds))
            self._rows.clear()
        turned = self._known[1]
        wanted = [first + i for i in range(count)]
        self._look(line, turned, wanted)
        rows = np.stack([self._rows[row] for row in wanted])
        if any_in(passing):
            self._lower(rows, line, turned, passing, first)
        return room_at_best(rows, self._grid.comfort, self._grid.aside), turned.slowness

    def _beside(self, line: TravelLine, turned: Turned) -> Turned:
        """The capsules (T, C, 6, columns) at all places of a row, seen from its middle."""
        left = self._grid.aside * (np.arange(self._grid.columns) - self._grid.columns // 2)
        way = np.array([np.cos(line.heading), 0.0, -np.sin(line.heading)])
        off = (np.tile(way, 2)[:, None] * left).astype(np.float32)
        return turned._replace(capsules=turned.capsules[..., None] + off)

    def _look(self, line: TravelLine, turned: Turned, wanted: list[float]) -> None:
        """Find the rows that are not known yet."""
        if len(self._rows) > _KEPT * len(wanted):
            self._rows.clear()
        fresh = np.array([i for i, row in enumerate(wanted) if row not in self._rows], np.int64)
        for run in np.split(fresh, np.flatnonzero(np.diff(fresh) != 1) + 1):
            if len(run):
                shape = len(run), 3, len(self._angles), self._grid.columns
                rows = np.full(shape, self._grid.comfort, np.float32)
                self._lower(rows, line, turned, self._standing(line, turned, wanted[run[0]], len(run)), wanted[run[0]])
                self._rows.update(zip(wanted[run[0] : run[-1] + 1], rows, strict=True))

    def _standing(self, line: TravelLine, turned: Turned, first: float, count: int) -> Spans:
        """What stands by `count` rows from row `first` on, near enough to matter."""
        ahead = self._grid.step * np.array([first, first + count - 1.0])
        x, z = line.x + ahead * np.sin(line.heading), line.z + ahead * np.cos(line.heading)
        ends = np.abs(turned.capsules.reshape(*turned.capsules.shape[:2], 2, 3, -1))
        reach = ends.max(axis=(0, 1, 2, 4)) + float(self._body.radii.max()) + self._grid.comfort
        least, most = (x.min() - reach[0], z.min() - reach[2]), (x.max() + reach[0], z.max() + reach[2])
        return always(self._obstacles.near(least, most))

    def _lower(self, rows: Floats32, line: TravelLine, turned: Turned, obstacles: Spans, first: float) -> None:
        grid, body = self._grid, self._body
        place = np.array(
            [line.x, line.z, np.sin(line.heading), np.cos(line.heading), grid.step, grid.aside, grid.comfort]
        )
        lower_rows(rows, turned.capsules, body.groups, body.radii, obstacles, place, first)
