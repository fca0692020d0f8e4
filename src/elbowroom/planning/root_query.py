"""One root plan in the making: candidates in the order in which they are liked, and the first that is free."""

import math
from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import ROOT_STATE, RootState
from elbowroom.planning.root_body import LowerBody
from elbowroom.planning.root_evasion import Evasion
from elbowroom.planning.root_hull import strip_is_free, to_look_at
from elbowroom.planning.root_line import TravelLine
from elbowroom.planning.root_motion import (
    MotionBounds,
    Travel,
    brake,
    dense_states,
    follow,
    steer,
    stopping_states,
)
from elbowroom.planning.root_moving import MovingAround
from elbowroom.planning.root_plan import RootPlanKind, RootPlannerSettings
from elbowroom.planning.root_profile import Course, follow_profile
from elbowroom.planning.root_route import find_route, route_points, shortened_route
from elbowroom.world.walkable import WalkableMap, walkable_window

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]

_TURN_WORTH = 0.2  # metres that a radian of turning counts for when paths are compared
_BEHIND = 0.64  # metres behind the start that a way round may use


class Answer(NamedTuple):
    """What a path is going to be made of."""

    states: Floats  # (n+1, 7)
    kind: RootPlanKind
    goal: tuple[float, float]  # x, z
    ends: bool  # whether the way that was looked at ends before something
    whole: bool = True  # whether it is walked as planned, to the end


class RootQuery:
    """One plan in the making: the start, the boxes within reach, and the count of checks."""

    def __init__(
        self,
        settings: RootPlannerSettings,
        body: LowerBody,
        bounds: MotionBounds,
        start: RootState,
        horizon: int,
        interval: float,
        around: MovingAround,
    ) -> None:
        self.settings, self.body, self.bounds, self.around = settings, body, bounds, around
        self.start, self.horizon, self.interval = start, horizon, interval
        run = self.settings.motion.run_speed
        reach = max(self.settings.sight + self.settings.widest_detour, run * (horizon * interval + 1.0)) + 1.0
        self.boxes = self.body.boxes.around(np.array([[start.x, start.z]]), reach)
        self.mapped = self.boxes + around.standing() if around else self.boxes
        self.checks = 0
        self.skin = self._skin_at(np.array([start, start]))

    def _skin_at(self, standing: Floats) -> float:
        """The clearance to ask for: less where the start, twice in `standing` (2, 7), has little."""
        full, bounds = self.settings.skin, self.bounds
        if not len(self.boxes.table) or not to_look_at(
            standing, self.interval, bounds.braking, bounds.turn_acceleration, 2.0 * full, self.body.hull,
            self.boxes.ground,
        )[0].any():  # fmt: skip
            return full
        return min(full, max(0.5 * float(self._clearance(standing[:1])[0]), 0.0))

    def _clearance(self, states: Floats) -> Floats32:
        if not len(states) or not len(self.boxes.table):
            return np.full(len(states), np.inf, np.float32)
        self.checks += len(states)
        return self.body.clearance(self.boxes, states)

    def _blank(self) -> Floats:
        states = np.empty((self.horizon + 1, ROOT_STATE))
        states[0] = self.start
        return states

    def _kept(self, states: Floats) -> int:
        """The number of leading key intervals that are free, with a free stop from the end of each."""
        kept = self._kept_in_motion(states) if self.around else self.horizon
        return min(kept, self._kept_at_rest(states))

    def _kept_in_motion(self, states: Floats) -> int:
        """The number of leading key intervals that no moving box comes into."""
        every = np.ones(self.horizon, np.bool_)
        shown, owner = dense_states(states, self.interval, self.settings.spacing, every)
        after = self.interval * self.horizon / len(shown) * np.arange(1.0, len(shown) + 1.0)
        self.checks += len(shown)
        clear = self.around.clearance(shown, after)
        touching = owner[clear < min(self.skin, max(0.5 * float(clear[0]), 0.0))]
        return int(touching[0]) - 1 if len(touching) else self.horizon

    def _kept_at_rest(self, states: Floats) -> int:
        """The number of leading key intervals that no standing box is in, with a free stop from the end of each."""
        if not len(self.boxes.table):
            return self.horizon
        moving, stopping = to_look_at(
            states, self.interval, self.bounds.braking, self.bounds.turn_acceleration, self.skin, self.body.hull,
            self.boxes.ground,
        )  # fmt: skip
        kept = self.horizon
        if moving.any():
            shown, owner = dense_states(states, self.interval, self.settings.spacing, moving)
            kept = self._before_contact(shown, owner, kept + 1)
        if stopping[:kept].any():
            tails, owner = stopping_states(
                states[: kept + 1], self.interval, self.bounds, self.settings.spacing, stopping
            )
            kept = self._before_contact(tails, owner, kept + 1)
        return kept

    def _before_contact(self, shown: Floats, owner: Indices, never: int) -> int:
        """One less than the `owner` (M,) of the first of the states (M, 7) that touches; `never` less one if none."""
        touching = owner[self._clearance(shown) < self.skin]
        return int(touching[0] if len(touching) else never) - 1

    def _best(self, candidates: Iterable[Floats]) -> tuple[Floats, int]:
        """The first candidate that is free, or most of it, or as much of one as leads farthest; else a stop.

        Also its number where it is whole, else -1.
        """
        best, farthest = None, 0.0
        for i, states in enumerate(candidates):
            kept = self._kept(states)
            if kept == self.horizon:
                return states, i
            if self.around:
                continue
            brake(states, kept, self.interval, self.bounds)
            if 2 * kept >= self.horizon:
                return states, -1
            progress = _length(states) + _TURN_WORTH * abs(float(states[-1, 2] - states[0, 2]))
            if kept > 0 and progress > farthest:
                best, farthest = states, progress
        if self.around:
            return self._given_way(), -1
        return (best, -1) if best is not None else (self.stop(), -1)

    def _given_way(self) -> Floats:
        """Wait, or step out of the way of what comes: the first of these that is free, or the longest free."""
        best, longest = self._stopped(), -1
        for states in (best, *self._steps_aside()):
            kept = self._kept(states)
            if kept == self.horizon:
                return states
            if kept > longest:
                best, longest = states, kept
        return best

    def steps_aside(self) -> Iterator[Floats]:
        """Those short ways back, to both sides and on that are free, in the order in which they are liked."""
        return (states for states in self._steps_aside() if self._kept(states) == self.horizon)

    def _steps_aside(self) -> Iterator[Floats]:
        for forward, lateral in self.settings.steps_aside:
            states, wanted = self._blank(), np.array([forward, lateral, 0.0])
            steer(states, wanted, self.interval, self.bounds)
            yield states

    def stop(self) -> Floats:
        """Stand, or step out of the way of what comes."""
        return self._given_way() if self.around else self._stopped()

    def _stopped(self) -> Floats:
        """Brake, harder if need be; at last stand still at once."""
        for hard in (1.0, 2.0, 4.0):
            states = self._blank()
            bounds = self.bounds._replace(
                braking=hard * self.bounds.braking, turn_acceleration=hard * self.bounds.turn_acceleration
            )
            brake(states, 0, self.interval, bounds)
            shown, _ = dense_states(states, self.interval, self.settings.spacing, np.ones(self.horizon, np.bool_))
            if not np.any(self._clearance(shown) < 0.0):
                return states
        states = np.repeat(self._blank()[:1], self.horizon + 1, axis=0)
        states[:, 3:6] = 0.0
        return states

    def steered(self, wanted: Floats) -> Answer:
        """Hold the wanted velocities in the body's own axes, in a tighter turn or slower if need be."""
        on_the_spot = not wanted[:2].any()

        def candidate(share: float) -> Floats:
            states = self._blank()
            steer(states, wanted * np.array([share, share, share if on_the_spot else 1.0]), self.interval, self.bounds)
            return states

        states, number = self._best(candidate(share) for share in self.settings.slower)
        return Answer(states, self._kind(states, whole=number == 0, detour=False), _place(states[-1]), False)

    def travelled(self, line: TravelLine, speed: float) -> Answer:
        """Walk along the line of travel, or round what stands in it."""
        route, detour, stops = self._route(line)

        def candidate(share: float) -> Floats:
            states, wanted = self._blank(), share * speed
            travel = Travel(wanted, line.facing, line.turns, stops, 0.3 + 0.3 * wanted)
            follow(states, route, travel, self.interval, self.bounds)
            return states

        states, number = self._best(candidate(share) for share in self.settings.slower)
        return Answer(states, self._kind(states, whole=number == 0, detour=detour), _place(route[-1]), stops)

    def evaded(self, line: TravelLine, evasion: Evasion, speed: float) -> Answer:
        """Walk along an evasion from the line of travel, or as much of it as is free."""
        profile, s = evasion.profile, self.settings.evasion

        def candidate(share: float) -> Floats:
            states, ahead = self._blank(), share * speed
            course = Course(
                line.x, line.z, line.heading, line.facing, ahead, min(ahead, share * s.sideways), not evasion.whole
            )
            follow_profile(states, profile.rows, profile.first, profile.step, course, self.interval, self.bounds)
            return states

        states, number = self._best(candidate(share) for share in s.shares)
        ahead = profile.first + profile.step * (len(profile.rows) - 1)
        stands = self._kind(states, whole=True, detour=False) is RootPlanKind.STOPPED
        kind = RootPlanKind.STOPPED if stands else RootPlanKind.EVASION
        return Answer(states, kind, line.point(ahead, float(profile.rows[-1, 0])), not evasion.whole, number >= 0)

    def _kind(self, states: Floats, *, whole: bool, detour: bool) -> RootPlanKind:
        if _length(states) < 0.02 and np.ptp(states[:, 2]) < 0.05:
            return RootPlanKind.STOPPED
        if not whole:
            return RootPlanKind.SHORTENED
        return RootPlanKind.DETOUR if detour else RootPlanKind.STRAIGHT

    def _route(self, line: TravelLine) -> tuple[Floats, bool, bool]:
        """Corner points of the way to go; whether it is a way round; whether it ends before an obstacle."""
        ahead, left = line.coordinates(self.start.x, self.start.z)
        sight = self.settings.sight
        back = ahead + max(0.6, 1.5 * abs(left))
        straight = np.array(
            [[self.start.x, self.start.z], line.point(back), line.point(max(ahead + sight, back + 0.1))]
        )
        free = self._free_length(straight)
        if free >= sight:
            return straight, False, False
        windows: dict[float, WalkableMap] = {}
        for margin, cell in self.settings.searches:
            window = windows.get(cell) or windows.setdefault(cell, self._window(line, ahead, cell))
            behind, middle = _cells(_BEHIND, cell), _cells(self.settings.widest_detour, cell)
            route = find_route(window, (behind, left + middle), middle, margin, self.settings.route)
            gained = line.coordinates(*route[-1])[0] - ahead
            if gained > free + self.settings.worth_it:
                return route, True, gained < sight - 2.0 * cell
        return shortened_route(straight, max(0.0, free - 0.05)), False, True

    def _free_length(self, route: Floats) -> float:
        """Metres along the route before the standing figure would touch; infinite if it never does."""
        if not len(self.mapped.table):
            return math.inf
        legs = np.diff(route, axis=0)
        ways, lengths = np.arctan2(legs[:, 0], legs[:, 1]), np.hypot(legs[:, 0], legs[:, 1])
        half = self.body.stance.radius + self.settings.margin + 1e-3
        rows = zip(route[:-1, 0], route[:-1, 1], ways, lengths, strict=True)
        if all(strip_is_free(x, z, way, length, half, self.mapped.ground) for x, z, way, length in rows):
            return math.inf
        points, along = route_points(route, 0.04)
        clear = self.body.standing_clearance(self.mapped, points)
        self.checks += len(points)
        leaving = (along < 0.3) & (clear >= min(float(clear[0]), 0.0) - 1e-3)
        blocked = np.flatnonzero((clear < self.settings.margin) & ~leaving)
        return float(along[blocked[0]]) if len(blocked) else math.inf

    def _window(self, line: TravelLine, ahead: float, cell: float) -> WalkableMap:
        """The walkable map from a little behind the start to the end of sight, on both sides of the line of travel."""
        behind, middle = _cells(_BEHIND, cell), _cells(self.settings.widest_detour, cell)
        shape = (round((behind + _cells(self.settings.sight, cell)) / cell) + 1, 2 * round(middle / cell) + 1)
        origin = line.point(ahead - behind, -middle)
        roomy = max(margin for margin, _ in self.settings.searches) + self.settings.route.roomy
        window = walkable_window(self.mapped.table, self.body.stance, origin, line.heading, shape, cell, roomy)
        self.checks += window.clearance.size
        return window


def _cells(length: float, cell: float) -> float:
    """`length` rounded up to whole cells, metres."""
    return math.ceil(length / cell - 1e-9) * cell


def _place(row: Floats) -> tuple[float, float]:
    """The first two components of a state or of a route's point: x and z."""
    return float(row[0]), float(row[1])


def _length(states: Floats) -> float:
    """Metres between the first place and the last."""
    return math.hypot(states[-1, 0] - states[0, 0], states[-1, 1] - states[0, 1])
