"""The route that a walk along the line of travel takes: straight on, round what stands in it, or up to there.

People walk round a gap in which their shoulders would have to turn, if that is not much farther: between two posts in
the open from 1.4 shoulder widths down (A. L. Hackney, L. A. Vallis & M. E. Cinelli, Q. J. Exp. Psychol. 66, 2013).
"""

import math
from dataclasses import replace
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import RootState
from elbowroom.planning.root.legs.hull import route_is_open
from elbowroom.planning.root.legs.lower_body import LowerBody, WindowGrid
from elbowroom.planning.root.legs.neighbours import Neighbours
from elbowroom.planning.root.line.line import TravelLine, straight_route
from elbowroom.planning.root.line.route import find_route, route_points, shortened_route
from elbowroom.planning.root.plan import RootPlannerSettings
from elbowroom.world.walkable import WalkableMap

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

_BEHIND = 0.64  # metres behind the start that a detour may use
_MORE = 1e-3  # metres
_SPACING = 0.04  # metres between samples along a route
_THROUGH = 0.3  # metres: a route that comes so near to the middle of a gap leads through it
_BACK = 0.3  # metres that the way back to the line is longer than that along it, for each metre beside it
NONE_TIGHT = np.empty((0, 3))  # gaps where none is


class Route(NamedTuple):
    """Where to walk."""

    corners: Floats  # (m, 2) x and z
    detour: bool  # whether it leads round something
    ends: bool  # whether it ends before an obstacle
    checks: int  # places whose clearance was computed
    beside: bool = False  # whether it leads round a gap that one could go through


class Above(Protocol):
    """What is carried above legs and pelvis, for whoever does not leave all of it to the upper body's planner."""

    def clearance(self, places: Floats, facing: float) -> Floats32:
        """Metres that it can keep at places (N, 2) on the ground if the body faces so, (N,)."""


class RouteFinder:
    """Finds routes for the standing figure of one body."""

    def __init__(self, settings: RootPlannerSettings, body: LowerBody, above: Above | None = None) -> None:
        """Routes also lead round what is in the way of what is carried `above`, if anything is given."""
        self._settings, self._body, self.above = settings, body, above
        self.half = body.stance.radius + settings.margin + _MORE  # metres: half the breadth of the standing figure

    def ahead(
        self,
        start: RootState,
        line: TravelLine,
        obstacles: Neighbours,
        sight: float,
        way: Floats | None = None,
        tight: Floats = NONE_TIGHT,
    ) -> Route:
        """The route from a start along a line of travel among `obstacles`, `sight` metres of it.

        Or along a `way` (m, 2), corner points x and z, that leads along the line and then elsewhere. It leads round
        what stands in it, and round places (K, 2 or more), x and z, where it is `tight`, if there is room.
        """
        straight = straight_route(float(start.x), float(start.z), line, sight) if way is None else way
        checks, free, seen = 0, math.inf, (sight, start.height)
        if self.above is not None or not route_is_open(straight, start.height, self.half, obstacles.boxes):
            free, checks = self._free_length(straight, line, obstacles, start.height)
        if way is None and self.above is None and len(tight):
            looked, beside = self._beside(straight, line, obstacles, seen, tight)
            checks += looked
            if beside is not None:
                return Route(beside, detour=True, ends=False, checks=checks, beside=True)
        if free >= sight:
            return Route(straight, detour=False, ends=False, checks=checks)
        return self._round(straight, free, line, obstacles, seen, checks)

    def _beside(
        self, straight: Floats, line: TravelLine, obstacles: Neighbours, seen: tuple[float, float], tight: Floats
    ) -> tuple[int, Floats | None]:
        """A route round `tight` places, where the straight one leaves little room, if there is one that is not much
        longer; of both so much is `seen` from a height. And how many places were looked at."""
        s, (sight, height), (margin, cell) = self._settings, seen, self._settings.going_round
        if route_is_open(straight, height, self._body.stance.radius + margin, obstacles.boxes):
            return 0, None
        ahead = line.coordinates(*straight[0].tolist())[0]
        window = self._window(line, ahead, (cell, margin), obstacles, seen)
        route, gained = self._searched(window, straight[0], line, margin)
        more = _more_than_straight(route, line) - _more_than_straight(straight, line)
        whole = gained >= sight - 2.0 * cell and more < s.worth_going_round and _away(route, tight).min() > _THROUGH
        return window.clearance.size, route if whole else None

    def _searched(self, window: WalkableMap, start: Floats, line: TravelLine, margin: float) -> tuple[Floats, float]:
        """The route from a start (2,) over a window along a line, with a margin; metres that it gains along that."""
        s, (ahead, left) = self._settings, line.coordinates(*start.tolist())
        behind, middle = _cells(_BEHIND, window.cell), _cells(s.widest_detour, window.cell)
        route = find_route(window, (behind, left + middle), middle, margin, s.route)
        return route, line.coordinates(*route[-1].tolist())[0] - ahead

    def _free_length(self, route: Floats, line: TravelLine, obstacles: Neighbours, height: float) -> tuple[float, int]:
        """Metres along the route before the standing figure would touch, infinite if never; how many places it saw.

        The route begins at a `height`.
        """
        (points, along), margin = route_points(route, _SPACING), self._settings.margin
        clear = self._body.standing_clearance(obstacles, points, height, margin)
        if self.above is not None:
            clear = np.minimum(clear, self.above.clearance(points, line.facing))
        leaving = (along < 0.3) & (clear >= min(float(clear[0]), 0.0) - _MORE)
        blocked = np.flatnonzero((clear < margin) & ~leaving)
        return float(along[blocked[0]]) if len(blocked) else math.inf, len(points)

    def _round(
        self,
        straight: Floats,
        free: float,
        line: TravelLine,
        obstacles: Neighbours,
        seen: tuple[float, float],
        checks: int,
    ) -> Route:
        """The detour what stands `free` metres on in the straight route, of which so much is `seen` from a height."""
        s, ahead, sight = self._settings, line.coordinates(*straight[0].tolist())[0], seen[0]
        windows: dict[float, WalkableMap] = {}
        most = max(margin for margin, _ in s.searches)
        for margin, cell in s.searches:
            if cell not in windows:
                windows[cell] = self._window(line, ahead, (cell, most), obstacles, seen)
                checks += windows[cell].clearance.size
            route, gained = self._searched(windows[cell], straight[0], line, margin)
            if gained > free + s.worth_it:
                return Route(route, detour=True, ends=bool(gained < sight - 2.0 * cell), checks=checks)
        return Route(shortened_route(straight, max(0.0, free - 0.05)), detour=False, ends=True, checks=checks)

    def _window(
        self,
        line: TravelLine,
        ahead: float,
        searched: tuple[float, float],
        obstacles: Neighbours,
        seen: tuple[float, float],
    ) -> WalkableMap:
        """The walkable map from a little behind the start to the end of sight, on both sides of the line of travel.

        It is to be `searched` with cells of a size, and with a margin up to some.
        """
        s, (sight, height), (cell, margin) = self._settings, seen, searched
        behind, middle = _cells(_BEHIND, cell), _cells(s.widest_detour, cell)
        shape = (round((behind + _cells(sight, cell)) / cell) + 1, 2 * round(middle / cell) + 1)
        origin = line.point(ahead - behind, -middle)
        roomy = margin + s.route.roomy
        first = round(behind / cell)
        window = self._body.window(obstacles, WindowGrid(origin, line.heading, shape, cell, roomy, height, first))
        if self.above is None:
            return window
        cells: Floats = np.indices(shape, np.float64).reshape(2, -1) * cell
        rows: Floats = cells[0] + ahead - behind
        columns: Floats = cells[1] - middle
        places: Floats = np.stack(line.point(rows, columns), axis=1)
        above = self.above.clearance(places, line.facing).reshape(shape)
        return replace(window, clearance=np.minimum(window.clearance, above))


def _cells(length: float, cell: float) -> float:
    """`length` rounded up to whole cells, metres."""
    return math.ceil(length / cell - 1e-9) * cell


def _away(route: Floats, places: Floats) -> Floats:
    """Metres (K,) from places (K, 2 or more), x and z, to a route."""
    points, _ = route_points(route, _SPACING)
    away: Floats = np.hypot(points[:, 0] - places[:, :1], points[:, 1] - places[:, 1:2]).min(axis=1)
    return away


def _more_than_straight(route: Floats, line: TravelLine) -> float:
    """Metres that a route, and the way back to its line, are longer than the way along that."""
    ahead, left = line.coordinates(route[:, 0], route[:, 1])
    walked = float(np.hypot(*np.diff(route, axis=0).T).sum())
    return walked + _BACK * abs(float(left[-1])) - float(ahead[-1] - ahead[0])
