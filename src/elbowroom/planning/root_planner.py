"""From a command to a short, collision-free root path for what cannot bend: the legs and the pelvis.

Straight where the way is free, round the obstacle where it is not, a stop before it where there is no way. The upper
body is not looked at: what only it would touch diverts nobody.

A path is accepted if the posed legs and the pelvis are free at dense samples of exactly the motion that playback will
show, and if from each of its key frames a stop would be free too. So the next plan always has a way out: to brake.
"""

import math
from collections.abc import Iterator, Sequence
from time import perf_counter_ns
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import DOF
from elbowroom.body.gait import quickness
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import BodyModel, posture_capsules
from elbowroom.body.root import ROOT_STATE, RootState
from elbowroom.planning.command import Command
from elbowroom.planning.root_body import LowerBody
from elbowroom.planning.root_evasion import EvasionFinder
from elbowroom.planning.root_line import TravelLine, asked_direction, new_line, wanted_speed, wanted_velocities
from elbowroom.planning.root_motion import MotionBounds
from elbowroom.planning.root_moving import MovingAround
from elbowroom.planning.root_path import RootPath
from elbowroom.planning.root_plan import RootPlan, RootPlanKind, RootPlannerSettings
from elbowroom.planning.root_profile import Profile
from elbowroom.planning.root_query import Answer, RootQuery
from elbowroom.world.moving import MovingBoxes
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]


Evading = tuple[Profile, TravelLine] | None  # the evasion being followed, and the line that it leads from
Candidate = tuple[RootPlan, Evading]
Memory = tuple[TravelLine | None, Floats | None, Evading]


class _Asked(NamedTuple):
    """What a path is asked for."""

    start: RootState
    command: Command
    horizon: int
    interval: float
    start_time: float


class _Offer(NamedTuple):
    """A candidate, or the pace at which one would be walked."""

    lost: float  # seconds
    what: Candidate | float


class RootPlanner:
    """Plans root paths for one humanoid in one scene.

    It remembers between plans: the line of travel of the command that is being held, where the last path led, and how
    that left the line. `reset` forgets it; a start that does not continue the last path does so too.
    """

    def __init__(self, humanoid: Humanoid, scene: Scene, settings: RootPlannerSettings | None = None) -> None:
        self.settings = settings or RootPlannerSettings()
        self.body = LowerBody(humanoid, scene.boxes)
        motion = self.settings.motion
        strides = quickness(self.body.model.gait.scale)
        self.bounds = MotionBounds(
            motion.turn_rate, motion.acceleration, motion.braking, motion.turn_acceleration, strides
        )
        self._evasions = EvasionFinder(humanoid, scene.boxes.table, self.settings.evasion)
        self._wide = EvasionFinder(humanoid, scene.boxes.table, self.settings.wide)
        self._figure = _figure(self.body.model)
        self._moving = scene.moving
        self.others = MovingBoxes()  # that move besides the scene's own
        self.reset()

    def reset(self) -> None:
        """Forget the line of travel."""
        self._line: TravelLine | None = None
        self._last: Floats | None = None
        self._evading: Evading = None
        self._offered: list[Candidate] = []

    @property
    def memory(self) -> Memory:
        """What it remembers between plans; set, it goes on as it was then."""
        return self._line, self._last, self._evading

    @memory.setter
    def memory(self, memory: Memory) -> None:
        self._line, self._last, self._evading = memory

    @property
    def moving(self) -> MovingBoxes:
        """All that moves."""
        return self._moving + self.others if len(self.others) else self._moving

    def _query(self, start: RootState, horizon: int, interval: float, begin: float) -> RootQuery:
        around = MovingAround(self.body, self.moving, begin, horizon, interval)
        return RootQuery(self.settings, self.body, self.bounds, start, horizon, interval, around)

    def plan(
        self,
        start: RootState,
        command: Command,
        horizon: int,
        interval: float,
        start_time: float = 0.0,
        pace: float = 1.0,
    ) -> RootPlan:
        """A path of `horizon` key intervals of `interval` seconds that starts exactly in the state `start`.

        It is walked at the share `pace`, above 0 and up to 1, of the speed that the command asks for.
        """
        began = perf_counter_ns()
        query = self._query(start, horizon, interval, start_time)
        lost = 0.0
        if command.idle:
            self._line = None
            answer = Answer(query.stop(), RootPlanKind.STRAIGHT, (start.x, start.z), False)
        elif _turns(command):
            self._line = self._evading = None
            answer = query.steered(pace * wanted_velocities(command, self.settings.motion))
        else:
            self._line, speed = self._travel_line(start, command), wanted_speed(command, self.settings.motion)
            answer = query.travelled(self._line, pace * speed)
            lost = self._lost(self._line, speed, answer, query)
        self._last = answer.states
        path = RootPath(start_time, interval, answer.states)
        return RootPlan(path, answer.kind, answer.goal, query.checks, perf_counter_ns() - began, lost)

    def candidates(
        self,
        start: RootState,
        command: Command,
        horizon: int,
        interval: float,
        start_time: float = 0.0,
        paces: Sequence[float] = (),
    ) -> Iterator[RootPlan]:
        """Paths for an upper body to choose from, the one that costs least first; arguments as for `plan`.

        The path as commanded, evasions from it, and slower ones at the shares `paces` of the wanted speed. Evasions
        that lead far aside are thought of when the others have become dear. The last one that was given is the one that
        is being followed; whoever takes an earlier one says so (`follow`).
        """
        self._offered.clear()
        for plan in self._candidates(_Asked(start, command, horizon, interval, start_time), paces):
            self._offered.append((plan, self._evading))
            yield plan

    def follow(self, plan: RootPlan) -> None:
        """Take one of the paths that `candidates` gave last."""
        for offered, evading in self._offered:
            if offered is plan:
                self._taken(offered, evading)

    def _candidates(self, asked: _Asked, paces: Sequence[float]) -> Iterator[RootPlan]:
        start, command, horizon, interval, _ = asked
        commanded = self.plan(*asked)
        known = self._evading
        slow = wanted_speed(command, self.settings.motion) < _SLOW
        line = None if command.idle or _turns(command) or slow else self._line
        direct = known if self._still_turned(start) else None
        offers: list[_Offer] = []
        if commanded.lost < self.settings.untroubled:
            self._evading = direct
            yield commanded
        else:
            offers.append(_Offer(commanded.lost, (commanded, direct)))
        duration = horizon * interval
        offers += [_Offer(commanded.lost + duration * (1.0 - pace), pace) for pace in paces if pace < 1.0]
        grids = [] if line is None else [self._evasions, self._wide]
        if commanded.kind is RootPlanKind.STOPPED and line is not None and self._is_faced(asked):
            yield from self._steps_aside(asked, direct)
        while offers or grids:
            offers.sort(key=lambda offer: offer.lost)
            if line is not None and grids and _dearer(offers, self.settings.wide_from if len(grids) == 1 else 0.0):
                offers += self._evaded(asked, line, known, grids.pop(0))
                continue
            what = offers.pop(0).what
            if isinstance(what, float):
                self._evading = direct
                yield self.plan(*asked, what)
            else:
                yield self._taken(*what)
        if len(self.moving):
            yield from self._steps_aside(asked, direct)

    def _steps_aside(self, asked: _Asked, evading: Evading) -> Iterator[RootPlan]:
        """Short ways out of the way of what moves."""
        start, _, horizon, interval, start_time = asked
        for states in self._query(start, horizon, interval, start_time).steps_aside():
            path = RootPath(start_time, interval, states)
            yield self._taken(RootPlan(path, RootPlanKind.EVASION, (start.x, start.z), 0, 0), evading)

    def _is_faced(self, asked: _Asked) -> bool:
        """Whether something that could move stands near: to wait for it would be to wait for ever."""
        start, _, horizon, interval, start_time = asked
        around = MovingAround(self.body, self.moving, start_time, horizon, interval)
        return bool(around) and len(around.standing().around(np.array([[start.x, start.z]]), _NEAR).table) > 0

    def _taken(self, plan: RootPlan, evading: Evading) -> RootPlan:
        self._last, self._evading = plan.path.states, evading
        return plan

    def _evaded(self, asked: _Asked, line: TravelLine, known: Evading, finder: EvasionFinder) -> list[_Offer]:
        """Evasions from the line of travel, each once."""
        start, command, horizon, interval, start_time = asked
        began, speed = perf_counter_ns(), wanted_speed(command, self.settings.motion)
        evasion = finder.settings
        speeds = (speed, min(speed, evasion.sideways))
        grid = finder.ahead_of(line, start, self.settings.sight, speeds, self.moving, start_time)
        kept = known[0] if known is not None and known[1] == line else None
        found: list[_Offer] = []
        profiles: list[Profile] = []
        for bodies in evasion.bodies:
            for care in evasion.cares:
                way = grid.cheapest(bodies, kept, care)
                if any(np.array_equal(way.profile.rows, other.rows) for other in profiles):
                    break
                profiles.append(way.profile)
                query = self._query(start, horizon, interval, start_time)
                answer = query.evaded(line, way, speed)
                lost, path = self._lost(line, speed, answer, query), RootPath(start_time, interval, answer.states)
                checks, spent = grid.cells + query.checks, perf_counter_ns() - began
                plan = RootPlan(path, answer.kind, answer.goal, checks, spent, lost)
                found.append(_Offer(lost, (plan, (way.profile, line))))
                if answer.whole:
                    break
        return found

    def _lost(self, line: TravelLine, speed: float, answer: Answer, query: RootQuery) -> float:
        """Seconds that a path costs against a walk along the line of travel at the wanted speed, all by itself."""
        if speed < _SLOW:
            return 0.0
        states = answer.states
        s, turned = self.settings, np.abs(np.remainder(states[:, 2] - line.facing + np.pi, 2.0 * np.pi) - np.pi)
        sine, cosine = np.sin(line.heading), np.cos(line.heading)
        ahead = (states[:, 0] - line.x) * sine + (states[:, 1] - line.z) * cosine
        aside = np.abs((states[:, 0] - line.x) * cosine - (states[:, 1] - line.z) * sine)
        duration = query.interval * query.horizon
        slower = max(speed - float(np.hypot(*states[0, 3:5])), 0.0)
        behind = speed * duration - 0.5 * slower * slower / self.bounds.acceleration - float(ahead[-1] - ahead[0])
        behind += speed * s.dead_end * answer.ends
        if query.around:
            left = (states[:, 0] - line.x) * cosine - (states[:, 1] - line.z) * sine
            behind += speed * s.wrong_side * max(float(left.max() - max(left[0], 0.0)), 0.0)
        crowd = s.crowded * max(s.polite - query.around.gap(states, *self._figure), 0.0)
        return behind / speed + crowd + s.aside_cost * float(aside.mean()) + s.turned_cost * float(turned.mean())

    def _travel_line(self, start: RootState, command: Command) -> TravelLine:
        """The line that is being followed, or a new one from here if the command or the place has changed.

        Who was turned aside by an evasion still means the way that it led from.
        """
        line, asked = self._line, asked_direction(command)
        if line is not None and line.asked == asked and self._continues(start, line):
            return line
        if self._evading is not None and command.direction is None and self._still_turned(start):
            start = start._replace(heading=self._evading[1].facing, turn=0.0)
        return new_line(start, command, self.settings.motion)

    def _still_turned(self, start: RootState) -> bool:
        """Whether the body is turned away from where the user means it to face."""
        if self._evading is None or not self._continues(start, self._evading[1]):
            return False
        return abs(math.remainder(start.heading - self._evading[1].facing, math.tau)) > _TURNED

    def _continues(self, start: RootState, line: TravelLine) -> bool:
        """Whether a start goes on from the last path, within the breadth of a way round."""
        if self._last is None or abs(line.coordinates(start.x, start.z)[1]) >= self.settings.widest_detour:
            return False
        return bool(np.min(np.hypot(self._last[:, 0] - start.x, self._last[:, 1] - start.z)) < 0.5)


def _figure(model: BodyModel) -> tuple[float, float]:
    """Half the breadth of a body that stands with hanging arms, and its height, metres."""
    ends = posture_capsules(model, np.zeros((1, DOF)), np.zeros((1, ROOT_STATE))).reshape(-1, 2, 3)
    reach = np.abs(ends).max(axis=1) + model.body.radii[:, None]
    return float(reach[:, 0].max()), float(reach[:, 1].max())


_NEAR = 1.0  # metres
_TURNED = 0.05  # radians
_SLOW = 0.1  # m/s: who wants to go no faster is in no hurry


def _dearer(offers: list[_Offer], lost: float) -> bool:
    """Whether all offers, in order, cost at least so many seconds."""
    return not offers or offers[0].lost >= lost


def _turns(command: Command) -> bool:
    """Whether the user turns the body by hand."""
    return command.turn != 0.0 and command.direction is None
