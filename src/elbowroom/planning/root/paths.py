"""Root paths, each by itself: as commanded at some pace, past what is narrow, out of the way of what moves.

Which of them are wanted, and in which order, is the root planner's business.
"""

import math
from collections.abc import Iterator
from time import perf_counter_ns

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF
from elbowroom.body.gait.stride import quickness
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import BodyModel, posture_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.planning.narrow.build import build_of
from elbowroom.planning.narrow.gap import gap_ahead
from elbowroom.planning.narrow.pace import hanging, slow_places, slow_under
from elbowroom.planning.narrow.places import NarrowPlaces
from elbowroom.planning.root.cost import SLOW, BodySize, crowded, prices_of, seconds_lost
from elbowroom.planning.root.evasion.evasion import Evasion, EvasionFinder
from elbowroom.planning.root.evasion.profile import Profile
from elbowroom.planning.root.legs.hull import route_is_open
from elbowroom.planning.root.legs.leg_check import LegCheck
from elbowroom.planning.root.legs.lower_body import LowerBody
from elbowroom.planning.root.legs.moving_legs import MovingAround
from elbowroom.planning.root.line.ahead import NONE_TIGHT, Above, RouteFinder
from elbowroom.planning.root.line.climbing import places_along, places_on, steep_places
from elbowroom.planning.root.line.line import TravelLine, straight_route, wanted_speed, wanted_velocities
from elbowroom.planning.root.line.straight_walk import Outlook, Walker, straight_walk
from elbowroom.planning.root.line.way_ahead import Corners, line_of, way_ahead
from elbowroom.planning.root.motion import NONE_SLOW, SLOWED_FROM, MotionBounds
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan, RootPlanKind, RootPlannerSettings
from elbowroom.planning.root.query import Asked, PathDraft, RootQuery
from elbowroom.planning.stillness import STILL
from elbowroom.world.obstacles.tracks.moving import Moving
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

_NEAR = 1.0  # metres
_AIMED = 0.5  # metres beyond what is checked to which a way is known: the last steps are aimed there


class RootPaths:
    """Makes root paths for one humanoid in one scene. Nothing that it keeps changes a path."""

    def __init__(
        self, humanoid: Humanoid, scene: Scene, settings: RootPlannerSettings, above: Above | None = None
    ) -> None:
        self.settings = settings
        body, motion = LowerBody(humanoid, scene.obstacles, scene.ground), settings.motion
        strides = quickness(body.model.gait.scale)
        self.bounds = MotionBounds(
            motion.turn_rate, motion.acceleration, motion.braking, motion.turn_acceleration, strides, scene.ground
        )
        self._check = LegCheck(body, self.bounds, settings.skin, settings.spacing)
        self._routes = RouteFinder(settings, body, above)
        self._walker = Walker(
            self.bounds, self._routes.half, settings.skin, body.hull, body.boxes, body.grids, prices_of(settings)
        )
        self.evasions = tuple(EvasionFinder(humanoid, scene, grid) for grid in (settings.evasion, settings.wide))
        self._size = _size(body.model)
        self._narrow = NarrowPlaces(build_of(humanoid, body.model), scene.free_map)
        self._obstacles, self._hanging = scene.obstacles, hanging(self._narrow.build, scene.ground)
        self._scenes = scene.obstacles.moving
        self.others = Moving()
        self._slow_legs: tuple[Corners, dict[int, Floats]] = (), {}
        self._last: tuple[tuple[object, ...], RootQuery] | None = None
        self._checks = 0  # of all queries before the last one

    def reset(self) -> None:
        """Forget what was found out about legs, and the last paths asked for."""
        self._check.reset()
        self._last, self._checks = None, 0

    @property
    def moving(self) -> Moving:
        """All that moves."""
        return self._moving

    @property
    def restless(self) -> bool:
        """Whether anything moves now or later: what could but stands for now is as a wall."""
        return self._moving.fastest > STILL

    @property
    def others(self) -> Moving:
        """What moves besides the scene's own."""
        return self._others

    @others.setter
    def others(self, others: Moving) -> None:
        self._others, self._moving = others, self._scenes + others

    @property
    def checks(self) -> int:
        """The number of postures and places whose clearance was computed since it was made."""
        return self._checks + (0 if self._last is None else self._last[1].checks)

    def _query(self, asked: Asked) -> RootQuery:
        """The paths from one start; the same while the same is asked for."""
        key = (asked.start, *asked[2:], self._others)
        if self._last is None or self._last[0] != key:
            self._checks = self.checks
            _, _, horizon, interval, start_time = asked
            around = MovingAround(self._check.body, self._moving, start_time, horizon, interval)
            reach = self._reach(horizon * interval)
            self._last = key, RootQuery(self.settings, self._check, self._routes, asked, reach, around)
        return self._last[1]

    def _sight(self, asked: Asked, speed: float) -> float:
        """How far ahead the route is checked, metres."""
        return max(self.settings.sight, speed * asked.horizon * asked.interval + self.settings.beyond)

    def _reach(self, duration: float) -> float:
        """Nothing farther from a start is met by a path of `duration` seconds, or by a detour; metres."""
        s = self.settings
        run = s.motion.run_speed * (duration + 1.0)
        return max(s.sight + s.widest_detour, run + s.beyond) + 1.0

    def stopped(self, asked: Asked) -> RootPlan:
        """To a stand, or out of the way of what comes."""
        began, query = perf_counter_ns(), self._query(asked)
        before, draft = query.checks, query.stopped()
        return _plan(asked, draft, query.checks - before, began)

    def steered(self, asked: Asked, pace: float) -> RootPlan:
        """As a user turns the body by hand."""
        began, query = perf_counter_ns(), self._query(asked)
        before = query.checks
        draft = query.steered(pace * wanted_velocities(asked.command, self.settings.motion))
        return _plan(asked, draft, query.checks - before, began)

    def travelled(self, asked: Asked, line: TravelLine, pace: float, *, through: bool = False) -> RootPlan:
        """Along a line of travel, round gaps in it where there is room for that, or `through` them."""
        began, speed = perf_counter_ns(), wanted_speed(asked.command, self.settings.motion)
        sight = self._sight(asked, speed)
        narrow = self._narrow_ahead(asked, line, sight)
        slow = np.concatenate([narrow, self._low_ahead(asked, line, sight)])
        ahead = float(line.coordinates(asked.start.x, asked.start.z)[0])
        slow = self._with_steep(slow, asked, places_on(line, ahead, sight), speed)
        tight = NONE_TIGHT if through or not line.turns else narrow
        if not self._moving.tracks and self._routes.above is None and not len(tight):
            outlook = Outlook(asked.horizon, asked.interval, sight, self._reach(asked.horizon * asked.interval))
            start = asked.start.as_array()
            free, states, stands, lost, x, z = straight_walk(self._walker, start, line, speed, pace, outlook, slow)
            if free:
                kind = RootPlanKind.STOPPED if stands else RootPlanKind.STRAIGHT
                draft = PathDraft(states, kind, (x, z), ends=False, share=0.0 if stands else 1.0)
                return _plan(asked, draft.at(pace), 0, began, lost)
        query = self._query(asked)
        before = query.checks
        draft = query.travelled(line, pace * speed, sight, slow, tight=tight).at(pace)
        return _plan(asked, draft, query.checks - before, began, self._lost(asked, line, speed, draft))

    def along(self, asked: Asked, leg: int, pace: float) -> RootPlan:
        """Along the way that the command names, from its leg of this number on."""
        began, way, speed = perf_counter_ns(), asked.command.way, wanted_speed(asked.command, self.settings.motion)
        line = line_of(way, leg, asked.command)
        ahead = way_ahead(way, leg, asked.start.x, asked.start.z, self._sight(asked, speed) + _AIMED)
        slow = np.concatenate([self._slow_on(way, number, asked.start.height) for number in ahead.legs])
        slow = self._with_steep(slow, asked, places_along(way, ahead.legs), speed)
        query = self._query(asked)
        before = query.checks
        draft = query.travelled(line, pace * speed, self._sight(asked, speed), slow, ahead).at(pace)
        lost = self._lost(asked, line, speed, draft)
        if draft.likewise is not None:
            lost = max(_walked(draft.likewise) - _walked(draft.states), 0.0) / max(speed, SLOW)
            lost += (1.0 - pace) * asked.horizon * asked.interval
            lost = crowded(self.settings, lost, line, draft.states, query.around, self._size)
        return _plan(asked, draft, query.checks - before, began, lost)

    def _with_steep(self, slow: Floats, asked: Asked, places: Floats, speed: float) -> Floats:
        """Slow places (K, 3), and those of some (N, 2) where it is steep at the wanted speed."""
        start = asked.start
        steep = steep_places(self.bounds.ground, places, (start.x, start.height, start.z), speed)
        return np.concatenate([slow, steep]) if len(steep) else slow

    def _slow_on(self, way: Corners, leg: int, height: float) -> Floats:
        """Where it is narrow or low on a leg of a way, and how slow one is there, (K, 3); looked up once for a way."""
        if self._slow_legs[0] != way:
            self._slow_legs = way, {}
        known = self._slow_legs[1]
        if leg not in known:
            leads = line_of(way, leg), 0.0, math.dist(way[leg], way[leg + 1]), height
            known[leg] = np.concatenate([find(self._narrow, *leads) for find in (slow_places, slow_under)])
        return known[leg]

    def _narrow_ahead(self, asked: Asked, line: TravelLine, sight: float) -> Floats:
        """Where it is narrow on a line of travel, and how slow one is there, (K, 3)."""
        start, reach = asked.start, self._reach(asked.horizon * asked.interval)
        near = self._check.body.near(start.x, start.z, reach, start.height)
        route = straight_route(float(start.x), float(start.z), line, sight)
        if near.empty or route_is_open(route, start.height, self._narrow.half, near.boxes):
            return NONE_SLOW
        return slow_places(self._narrow, line, line.coordinates(start.x, start.z)[0], sight, start.height)

    def _low_ahead(self, asked: Asked, line: TravelLine, sight: float) -> Floats:
        """Where one has to duck on a line of travel, and how slow one is there, (K, 3)."""
        start = asked.start
        route = straight_route(float(start.x), float(start.z), line, sight + SLOWED_FROM)
        low, high = route.min(axis=0) - SLOWED_FROM, route.max(axis=0) + SLOWED_FROM
        if not len(self._obstacles.numbers_near(low, high, self._hanging)):
            return NONE_SLOW
        return slow_under(self._narrow, line, line.coordinates(start.x, start.z)[0], sight, start.height)

    def axis_ahead(self, asked: Asked, line: TravelLine) -> TravelLine | None:
        """The axis of a gap near a line of travel; who faces aside goes on to do so."""
        start = asked.start
        gap = gap_ahead(self._narrow, line, start.x, start.z, start.height)
        if gap is None:
            return None
        return line._replace(x=gap.x, z=gap.z, heading=gap.heading, facing=line.facing + gap.heading - line.heading)

    def evaded(
        self,
        asked: Asked,
        line: TravelLine,
        along: TravelLine,
        finder: EvasionFinder,
        kept: Profile | None,
        share: float = 1.0,
    ) -> Iterator[tuple[RootPlan, Evasion]]:
        """Evasions from a line of travel in a grid `along` another or the same, each once; `kept` is followed.

        They are walked at the `share` of the speed sideways.
        """
        start, command, _, _, start_time = asked
        began, query, speed = perf_counter_ns(), self._query(asked), wanted_speed(command, self.settings.motion)
        evasion, before = finder.settings, query.checks
        sideways = share * min(speed, evasion.sideways)
        speeds = (speed, sideways)
        grid = finder.ahead_of(along, start, self._sight(asked, speed), speeds, self._moving, start_time)
        if grid is None:
            return
        profiles: list[Profile] = []
        for bodies in evasion.bodies:
            for care in evasion.cares:
                found = grid.cheapest(bodies, kept, care)
                if any(np.array_equal(found.profile.rows, other.rows) for other in profiles):
                    break
                profiles.append(found.profile)
                draft = query.evaded(along, found, speed, sideways)
                checks, lost = grid.cells + query.checks - before, self._lost(asked, line, speed, draft)
                yield _plan(asked, draft, checks, began, lost), found
                if draft.whole:
                    break

    def followed(
        self, asked: Asked, line: TravelLine, along: TravelLine, profile: Profile, share: float
    ) -> RootPlan | None:
        """What is left of an evasion that was found, as for `evaded`; None if it is not free, or ends too soon."""
        began, query, speed = perf_counter_ns(), self._query(asked), wanted_speed(asked.command, self.settings.motion)
        before, sideways = query.checks, share * min(speed, self.settings.evasion.sideways)
        draft = query.evaded(along, Evasion(profile, True, 0.0), speed, sideways)
        end = profile.first + profile.step * (len(profile.rows) - 1)
        beyond = along.coordinates(*draft.states[-1, :2].tolist())[0] > end
        if beyond or not draft.whole or draft.kind is RootPlanKind.STOPPED:
            return None
        return _plan(asked, draft, query.checks - before, began, self._lost(asked, line, speed, draft))

    def steps_aside(self, asked: Asked) -> Iterator[RootPlan]:
        """Short steps out of the way of what moves."""
        place = asked.start.x, asked.start.z
        for states in self._query(asked).steps_aside():
            yield _plan(asked, PathDraft(states, RootPlanKind.EVASION, place, False), 0, perf_counter_ns())

    def short_steps(self, asked: Asked, velocities: Floats, moving: int) -> Floats:
        """Steps (k, n+1, 7), free or not, that hold `velocities` (k, 3) for so many key intervals, and then brake."""
        query = self._query(asked)
        return np.stack([query.short_step(wanted, moving) for wanted in velocities])

    def going_as(self, asked: Asked, told: Floats) -> Floats:
        """States (n+1, 7) from the start on, free or not, that reach the velocities of those `told` (n+1, 7)."""
        return self._query(asked).going_as(told)

    def is_free(self, asked: Asked, states: Floats) -> bool:
        """Whether legs and pelvis are free along a path (n+1, 7) from the start, and could stop on the way."""
        return self.kept(asked, states) == len(states) - 1

    def kept(self, asked: Asked, states: Floats) -> int:
        """The number of leading key intervals of a path (n+1, 7) from the start of which `is_free` holds."""
        return self._query(asked).kept(states)

    def rooms(self, asked: Asked, states: Floats) -> NDArray[np.float32]:
        """The clearance (N,) of legs and pelvis from what stands, in states (N, 7) within reach of the start."""
        return self._query(asked).rooms(states)

    def is_faced(self, asked: Asked) -> bool:
        """Whether something that could move stands near: to wait for it would be to wait for ever."""
        around, place = self._query(asked).around, np.array([[asked.start.x, asked.start.z]])
        return bool(around) and not around.standing.around(place, _NEAR).empty

    def _lost(self, asked: Asked, line: TravelLine, speed: float, draft: PathDraft) -> float:
        duration, around = asked.horizon * asked.interval, self._query(asked).around
        if draft.beside:
            return crowded(self.settings, 0.0, line, draft.states, around, self._size)
        states, ends = draft.states if draft.brisk is None else draft.brisk, draft.ends
        return seconds_lost(self.settings, line, speed, states, duration, ends=ends, around=around, size=self._size)


def _plan(asked: Asked, draft: PathDraft, checks: int, began: int, lost: float = 0.0) -> RootPlan:
    path = RootPath(asked.start_time, asked.interval, draft.states)
    spent, beside, free, pace = perf_counter_ns() - began, draft.beside, draft.free, draft.share
    return RootPlan(path, draft.kind, draft.goal, checks, spent, lost, beside, free, pace)


def _walked(states: Floats) -> float:
    """Metres along a path (n+1, 7)."""
    return float(np.hypot(*np.diff(states[:, :2], axis=0).T).sum())


def _size(model: BodyModel) -> BodySize:
    """Half the breadth of a body that stands with hanging arms, and its height, metres."""
    ends = posture_capsules(model, np.zeros((1, DOF)), np.zeros((1, ROOT_STATE))).reshape(-1, 2, 3)
    reach = np.abs(ends).max(axis=1) + model.body.radii[:, None]
    return float(reach[:, 0].max()), float(reach[:, 1].max())
