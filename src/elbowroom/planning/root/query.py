"""One root plan in the making: candidates in the order in which they are liked, and the first that is free."""

import math
from collections.abc import Callable, Iterable, Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.root import HEIGHT, ROOT_STATE, RootState
from elbowroom.planning.command import Command
from elbowroom.planning.root.evasion.evasion import Evasion
from elbowroom.planning.root.evasion.profile import PacedLine, follow_profile
from elbowroom.planning.root.legs.leg_check import FreeLegs, LegCheck
from elbowroom.planning.root.legs.moving_legs import MovingAround
from elbowroom.planning.root.legs.neighbours import Neighbours
from elbowroom.planning.root.line.ahead import NONE_TIGHT, Route, RouteFinder
from elbowroom.planning.root.line.line import TravelLine
from elbowroom.planning.root.line.way_ahead import WayAhead
from elbowroom.planning.root.motion import NONE_SLOW, Travel, brake, follow, gets_nowhere, go_as, steer
from elbowroom.planning.root.plan import RootPlanKind, RootPlannerSettings
from elbowroom.planning.stillness import is_still

Floats = NDArray[np.float64]

_SLOW = 0.1  # m/s: who walks faster has room for a stride
_WITH_CORNERS = 3  # points of a route that is not straight, at least
_CLOSER = 0.35  # of how far ahead one aims on a way, to cut its corners by less
_ASIDE = 0.45, 0.9  # seconds of a step out of the way of what moves, where one cannot go on so
_TURN_WORTH = 0.2  # metres that a radian of turning counts for when paths are compared


class Asked(NamedTuple):
    """What a path is asked for."""

    start: RootState  # in which it begins exactly
    command: Command
    horizon: int  # key intervals
    interval: float  # seconds
    start_time: float = 0.0  # seconds


class PathDraft(NamedTuple):
    """What a path is going to be made of."""

    states: Floats  # (n+1, 7)
    kind: RootPlanKind
    goal: tuple[float, float]  # x, z
    ends: bool  # whether the route that was checked ends before something
    whole: bool = True  # whether it is walked as planned, to the end
    brisk: Floats | None = None  # the same were nothing narrow: who is slower there loses nothing
    beside: bool = False  # whether it leads round a gap, as people like to: they lose nothing by that
    likewise: Floats | None = None  # the same were nothing in the way, of who walks along a way
    free: bool = True  # whether nothing that moves comes into it
    share: float = 0.0  # of the speed that was asked for, at which it is walked on to its end; 0 where it is not

    def at(self, pace: float) -> "PathDraft":
        """The same of who asked for this share of the wanted speed."""
        return self._replace(share=pace * self.share)


class _Best(NamedTuple):
    """What was chosen of some paths."""

    states: Floats  # (n+1, 7)
    number: int = -1  # which of them it is as a whole; -1: none
    free: bool = True  # whether nothing that moves comes into it


class RootQuery:
    """The paths from one start over the same key times, whatever the command."""

    def __init__(
        self,
        settings: RootPlannerSettings,
        check: LegCheck,
        routes: RouteFinder,
        asked: Asked,
        reach: float,
        around: MovingAround,
    ) -> None:
        """`reach` is the metres from the start beyond which nothing is met; the command `asked` for does not count."""
        self.settings, self.bounds, self.around = settings, check.bounds, around
        self.start, _, self.horizon, self.interval, _ = asked
        self._near = check.body.near(self.start.x, self.start.z, reach, self.start.height)
        self._legs, self._routes = FreeLegs(check, self._near, around, self.start, self.interval), routes
        self._route: tuple[tuple[object, ...], Route] | None = None
        self._places = 0

    @property
    def checks(self) -> int:
        """The number of postures and places whose clearance was computed."""
        return self._places + self._legs.checks

    @cached_property
    def _mapped(self) -> Neighbours:
        """What routes lead round: what stands, and what could move but stays where it is."""
        return self._near + self.around.standing if self.around else self._near

    def _blank(self) -> Floats:
        states = np.empty((self.horizon + 1, ROOT_STATE))
        states[0] = self.start
        return states

    def _best(self, candidates: Iterable[Floats]) -> _Best:
        """The first candidate that is free, or most of it, or as much of one as leads farthest; else a stop."""
        best, farthest = None, 0.0
        for i, states in enumerate(candidates):
            kept = self._legs.kept(states)
            if kept == self.horizon:
                return _Best(states, i)
            if self.around:
                continue
            brake(states, kept, self.interval, self.bounds)
            if 2 * kept >= self.horizon:
                return _Best(states)
            progress = _length(states) + _TURN_WORTH * abs(float(states[-1, 2] - states[0, 2]))
            if kept > 0 and progress > farthest:
                best, farthest = states, progress
        if self.around:
            return self._given_way
        return _Best(self._stopped() if best is None else best)

    def _crept(self, states: Floats, candidate: Callable[[float], Floats]) -> Floats:
        """The path, or where it gets nowhere one of steps so short that they lead out of where a stride has no room.

        Hard by an obstacle a stride away from it brings a knee or a heel into it.
        """
        walks = math.hypot(self.start.forward, self.start.lateral) > _SLOW
        if self.around or walks or not gets_nowhere(states) or not self._legs.close:
            return states
        for path in map(candidate, self.settings.creeping):
            if self._legs.leaves(path) and self._legs.kept(path) == self.horizon:
                return path
        return states

    @cached_property
    def _given_way(self) -> _Best:
        """Wait, or step out of the way of what comes: the first of these that is free, or the longest free."""
        best, longest = self._stopped(), -1
        for states in (best, *self._steps_aside()):
            kept = self._legs.kept(states)
            if kept == self.horizon:
                return _Best(states)
            if kept > longest:
                best, longest = states, kept
        return _Best(best, free=False)

    def steps_aside(self) -> Iterator[Floats]:
        """Those short steps back, to both sides and on that are free, in the order in which they are liked."""
        return (states for states in self._steps_aside() if self._legs.kept(states) == self.horizon)

    def _steps_aside(self) -> Iterator[Floats]:
        """Steps that are gone on with, and then those that end."""
        for seconds in (math.inf, *_ASIDE):
            for forward, lateral in self.settings.steps_aside:
                moving = math.ceil(min(seconds / self.interval, self.horizon))
                yield self.short_step(np.array([forward, lateral, 0.0]), moving)

    def short_step(self, wanted: Floats, moving: int) -> Floats:
        """Hold the wanted velocities (3,), as for `steered`, for so many key intervals, and then brake."""
        states = self._blank()
        steer(states[: moving + 1], wanted, self.interval, self.bounds)
        if moving < self.horizon:
            brake(states, moving, self.interval, self.bounds)
        return states

    def going_as(self, told: Floats) -> Floats:
        """States (n+1, 7) from the start on that reach the velocities of those `told` (n+1, 7)."""
        states = self._blank()
        go_as(states, told, self.interval, self.bounds)
        return states

    def kept(self, states: Floats) -> int:
        """The number of leading key intervals of a path (n+1, 7) that are free, with a free stop from each end."""
        return self._legs.kept(states)

    def rooms(self, states: Floats) -> NDArray[np.float32]:
        """The clearance (N,) of legs and pelvis from what stands, in states (N, 7)."""
        return self._legs.rooms(states)

    def stopped(self) -> PathDraft:
        """Stand, or step out of the way of what comes."""
        found = self._given_way if self.around else _Best(self._stopped())
        return PathDraft(
            found.states, RootPlanKind.STRAIGHT, _place(found.states[0]), False, free=found.free, share=1.0
        )

    def _stopped(self) -> Floats:
        """Brake, harder if need be; at last stand still at once."""
        for hard in (1.0, 2.0, 4.0):
            states = self._blank()
            bounds = self.bounds._replace(
                braking=hard * self.bounds.braking, turn_acceleration=hard * self.bounds.turn_acceleration
            )
            brake(states, 0, self.interval, bounds)
            if not self._legs.touches(states):
                return states
        states = np.repeat(self._blank()[:1], self.horizon + 1, axis=0)
        states[:, 3:6] = states[:, HEIGHT + 1] = 0.0
        return states

    def steered(self, wanted: Floats) -> PathDraft:
        """Hold the wanted velocities in the body's own axes, in a tighter turn or slower if need be."""
        on_the_spot = is_still(wanted[:2])

        def candidate(share: float) -> Floats:
            states = self._blank()
            steer(states, wanted * np.array([share, share, share if on_the_spot else 1.0]), self.interval, self.bounds)
            return states

        states, number, free = self._best(candidate(share) for share in self.settings.slower)
        if not on_the_spot:
            states = self._crept(states, candidate)
        kind = self._kind(states, whole=number == 0, detour=False)
        return PathDraft(states, kind, _place(states[-1]), False, free=free, share=self._share_of(number, kind))

    def _share_of(self, number: int, kind: RootPlanKind) -> float:
        """The share of the speed at which a path is walked to its end that is one of those tried, as a whole."""
        return 0.0 if number < 0 or kind is RootPlanKind.STOPPED else self.settings.slower[number]

    def travelled(
        self,
        line: TravelLine,
        speed: float,
        sight: float,
        slow: Floats = NONE_SLOW,
        way: WayAhead | None = None,
        tight: Floats = NONE_TIGHT,
    ) -> PathDraft:
        """Walk along the line of travel, of which `sight` metres are checked, or round what stands in it.

        It is slower at `slow` places, as in `Travel`, and leads round `tight` ones where there is room. Or it is walked
        along a `way` whose first leg is the line, and the more closely where one who cuts its corners meets something.
        """
        route = self._route_along(line, sight, None if way is None else way.seen, tight)
        on_way = way is not None and not (route.ends or route.detour)
        corners, stops = (way.walked, way.ends) if way is not None and on_way else (route.corners, route.ends)
        facing = line.facing - line.heading if line.turns else line.facing
        asked = Travel(speed, facing, line.turns, stops, slow, 1.0)
        walked = self._cornering if way is not None and len(corners) >= _WITH_CORNERS else self._followed

        def at(share: float, slow: Floats = slow) -> Floats:
            return walked(corners, asked._replace(speed=share * speed, slow=slow))

        def creeping(share: float) -> Floats:
            return self._followed(corners, asked._replace(speed=share * speed, facing=self.start.heading, turns=False))

        states, number, free = self._best(map(at, self.settings.slower))
        crept = self._crept(states, creeping)
        kind = self._kind(crept, whole=number == 0, detour=route.detour)
        return PathDraft(
            crept,
            kind,
            _place(route.corners[-1]),
            route.ends,
            brisk=at(1.0, NONE_SLOW) if number == 0 and len(slow) else None,
            beside=route.beside and number == 0,
            likewise=at(1.0) if on_way else None,
            free=free,
            share=self._share_of(number, kind) if crept is states else 0.0,
        )

    def _followed(self, corners: Floats, travel: Travel) -> Floats:
        """States (n+1, 7) of who follows a route with corners (m, 2)."""
        states = self._blank()
        follow(states, corners, travel, self.interval, self.bounds)
        return states

    def _cornering(self, corners: Floats, travel: Travel) -> Floats:
        """The same, cutting the corners by less where that is longer free."""
        states = self._followed(corners, travel)
        if (kept := self._legs.kept(states)) == self.horizon:
            return states
        closer = self._followed(corners, travel._replace(near=_CLOSER))
        return closer if self._legs.kept(closer) > kept else states

    def _route_along(self, line: TravelLine, sight: float, way: Floats | None, tight: Floats) -> Route:
        """The route along a line of travel, or along a way, round `tight` places; the same at every pace."""
        asked = line, sight, None if way is None else way.tobytes(), tight.tobytes()
        if self._route is None or self._route[0] != asked:
            self._route = asked, self._routes.ahead(self.start, line, self._mapped, sight, way, tight)
            self._places += self._route[1].checks
        return self._route[1]

    def evaded(self, line: TravelLine, evasion: Evasion, speed: float, sideways: float) -> PathDraft:
        """Walk along an evasion from a line at speeds forward and sideways, or as much of it as is free."""
        profile, s = evasion.profile, self.settings.evasion

        def candidate(share: float) -> Floats:
            states, ahead = self._blank(), share * speed
            paced = PacedLine(line.x, line.z, line.heading, line.facing, ahead, share * sideways, not evasion.whole)
            follow_profile(states, profile.rows, profile.first, profile.step, paced, self.interval, self.bounds)
            return states

        states, number, free = self._best(candidate(share) for share in s.shares)
        ahead = profile.first + profile.step * (len(profile.rows) - 1)
        stands = self._kind(states, whole=True, detour=False) is RootPlanKind.STOPPED
        kind = RootPlanKind.STOPPED if stands else RootPlanKind.EVASION
        place, ends = line.point(ahead, float(profile.rows[-1, 0])), not evasion.whole
        return PathDraft(states, kind, place, ends, number >= 0, free=free)

    def _kind(self, states: Floats, *, whole: bool, detour: bool) -> RootPlanKind:
        if gets_nowhere(states):
            return RootPlanKind.STOPPED
        if not whole:
            return RootPlanKind.SHORTENED
        return RootPlanKind.DETOUR if detour else RootPlanKind.STRAIGHT


def _place(row: Floats) -> tuple[float, float]:
    """The first two components of a state or of a route's point: x and z."""
    return float(row[0]), float(row[1])


def _length(states: Floats) -> float:
    """Metres between the first place and the last."""
    return math.hypot(states[-1, 0] - states[0, 0], states[-1, 1] - states[0, 1])
