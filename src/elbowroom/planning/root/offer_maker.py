"""Thinks of root paths for a planner to offer: as commanded, slower, in evasions, by steps aside and ways out."""

import math
from collections.abc import Iterator, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.root.cost import SLOW
from elbowroom.planning.root.evasion.evasion import EvasionFinder
from elbowroom.planning.root.line.line import TravelLine, wanted_speed
from elbowroom.planning.root.line.way_ahead import line_of
from elbowroom.planning.root.memory import Evading, RootMemory
from elbowroom.planning.root.offers import Offer
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.paths import RootPaths
from elbowroom.planning.root.plan import Pause, RootPlan, RootPlanKind, RootPlannerSettings
from elbowroom.planning.root.query import Asked
from elbowroom.planning.root.way_out import WayOut, WayOutFinder, WayOutSettings

_SLOW = 0.1  # m/s: who walks faster has somewhere to go
_TRIES = 2  # ways out that are taken one after the other, without getting farther
_FARTHER = 0.15  # metres along a line that are worth another
_BACK = 0.05  # metres along a line: less is no way back


class _Idea(NamedTuple):
    """An offer, or the pace at which one would be walked."""

    lost: float  # seconds
    what: Offer | float


class _Grid(NamedTuple):
    """A grid in which evasions may be looked for."""

    dear: float  # seconds that all else must have come to cost
    finder: EvasionFinder
    through: float | None = None  # along a gap, walked sideways at this share of the usual speed; else along the line


class _Matter(NamedTuple):
    """What candidates are thought of for, and what was known before."""

    asked: Asked
    line: TravelLine | None  # of travel; None for who leaves none
    known: Evading | None  # the evasion that was being followed
    direct: Evading | None  # the same, if one is turned as in it even where nothing is evaded
    before: WayOut | None  # the way out that was being taken


class OfferMaker:
    """Thinks of paths; `memory` is what it goes on from, and then what is remembered of the path thought of last.

    What is begun here and kept to be gone on with holds it, and must not be held by it: a circle stays in memory until
    garbage is looked for.
    """

    def __init__(self, settings: RootPlannerSettings, paths: RootPaths) -> None:
        self.settings, self._paths = settings, paths
        self._ways_out = WayOutFinder(WayOutSettings(), paths)
        self.memory = RootMemory()

    def commanded(self, asked: Asked, pace: float) -> RootPlan:
        """The path as it is asked for, at a share of the speed."""
        leg = self.memory.leg_of(asked.command.way, asked.start)
        line, plan = self._as_commanded(asked, leg, pace)
        self._remember(asked.command, line, leg, plan)
        return plan

    def prolonged(self, asked: Asked, left: RootPath, pace: float) -> RootPlan:
        """What is left of a path, and from its end on the path as it is asked for, at a share of the speed."""
        memory, command = self.memory, asked.command
        end, last = RootState(*left.states[-1].tolist()), left.horizon
        later = Asked(end, command, asked.horizon - last, asked.interval, left.time_of(last))
        line, rest = self._as_commanded(later, memory.leg_of(command.way, end), pace)
        leg = memory.leg_of(command.way, asked.start)
        states = np.concatenate([left.states, rest.path.states[1:]])
        lost = rest.lost + (1.0 - pace) * last * asked.interval
        plan = rest.along(RootPath(asked.start_time, asked.interval, states))._replace(lost=lost)
        self._remember(command, line_of(command.way, leg, command) if command.way else line, leg, plan)
        return plan

    def _as_commanded(self, asked: Asked, leg: int, pace: float) -> tuple[TravelLine | None, RootPlan]:
        """The line of travel, if there is one, and the path as it is asked for, along that or a `leg` of a way."""
        command, memory = asked.command, self.memory
        if command.idle:
            return None, self._paths.stopped(asked)
        if command.turns:
            return None, self._paths.steered(asked, pace)
        if command.way:
            return line_of(command.way, leg, command), self._paths.along(asked, leg, pace)
        line = memory.travel_line(asked.start, command, self.settings.motion, self.settings.widest_detour)
        return line, self._paths.travelled(asked, line, pace)

    def _remember(self, command: Command, line: TravelLine | None, leg: int, plan: RootPlan) -> None:
        """Remember the path as it is asked for."""
        memory, turned = self.memory, command.turns and not command.idle
        evading, out = None if turned else memory.evading, memory.way_out
        if out is not None and (line is None or not out.line.is_like(line)):
            out = None
        self.memory = RootMemory(line, plan.path.states, evading, out, _gets_past(plan), command.way, leg)

    def candidates(self, asked: Asked, paces: Sequence[float], most: int) -> Iterator[Offer | Pause]:
        """What `RootPlanner.candidates` offers."""
        touched: list[Offer] = []
        for offer in self._candidates(asked, paces, most):
            if isinstance(offer, Pause) or offer.plan.free:
                yield offer
            else:
                touched.append(offer)
        yield from touched

    def _candidates(self, asked: Asked, paces: Sequence[float], most: int) -> Iterator[Offer | Pause]:
        """The same, those that something comes into among the others."""
        before = self.memory.way_out
        commanded = self.commanded(asked, 1.0)
        known, line = self.memory.evading, self.memory.line
        direct = known if self.memory.still_turned(asked.start, self.settings.widest_detour) else None
        unevaded = partial(self._offer, evading=direct, way_out=before)
        if (left := self._left_of(self.memory.way_out, asked)) is not None:
            yield unevaded(left)
        ideas: list[_Idea] = []
        if commanded.lost < self.settings.untroubled:
            yield unevaded(commanded)
        else:
            ideas.append(_Idea(commanded.lost, unevaded(commanded)))
        if commanded.beside and line is not None:
            squeezed = self._paths.travelled(asked, line, 1.0, through=True)
            ideas.append(_Idea(squeezed.lost, unevaded(squeezed)))
        ideas += _slower(commanded, asked, paces)
        if wanted_speed(asked.command, self.settings.motion) < SLOW:
            line = None  # who is in no hurry leaves no line
        matter = _Matter(asked, line, known, direct, before)
        kept = self._kept(asked, line, known)
        if commanded.kind is RootPlanKind.STOPPED and line is not None and self._paths.is_faced(asked):
            yield from (step for step in self.steps_aside(asked, direct) if not _leads_back(step.plan, line))
        yield from self._cheapest_first(matter, ideas, kept, most)
        if len(self._paths.moving):
            yield from self.steps_aside(asked, direct)

    def _cheapest_first(
        self, matter: _Matter, ideas: list[_Idea], kept: _Idea | None, most: int
    ) -> Iterator[Offer | Pause]:
        """What the ideas come to, that which costs least first, with the evasion that is `kept` among them.

        Evasions are looked for in one grid after the other, each when all else has become as dear as it is itself,
        until `most` of them have held some. Nothing is evaded any more once ways out were offered, nor while there is
        one that is kept.
        """
        line, grids = matter.line, self._grids()
        ideas = ideas if kept is None else [*ideas, kept]
        while True:
            ideas.sort(key=lambda idea: idea.lost)
            looks = kept is None and line is not None and most > 0 and len(grids) > 0
            if looks and (not ideas or ideas[0].lost >= grids[0].dear):
                evaded = self._evaded(matter, grids.pop(0))
                ideas, most = ideas + evaded, most - bool(evaded)
                continue
            if not ideas:
                return
            idea = ideas.pop(0)
            kept = None if idea is kept else kept
            offer = idea.what if isinstance(idea.what, Offer) else self._at_pace(matter, idea.what)
            if line is not None and offer is idea.what and offer.plan.kind is RootPlanKind.STOPPED:
                yield from self.out(matter.asked, line, matter.direct, matter.before)
                line = None
            yield offer

    def _grids(self) -> list[_Grid]:
        """Where evasions are looked for, in this order: along the line, through gaps, and far aside."""
        (fine, wide), dear = self._paths.evasions, self.settings.wide_from
        return [
            _Grid(0.0, fine),
            _Grid(dear, fine, through=1.0),
            _Grid(dear, fine, through=fine.settings.short),
            _Grid(dear, wide),
        ]

    def _at_pace(self, matter: _Matter, pace: float) -> Offer:
        """The path as it is asked for, at a share of the speed."""
        self.memory = self.memory._replace(evading=matter.direct, way_out=matter.before)
        return self._offer(self.commanded(matter.asked, pace), matter.direct, matter.before)

    def steps_aside(self, asked: Asked, evading: Evading | None = None) -> Iterator[Offer]:
        """Short steps out of the way of what moves."""
        for plan in self._paths.steps_aside(asked):
            yield self._offer(plan, evading, None)

    def out(
        self, asked: Asked, line: TravelLine, evading: Evading | None, before: WayOut | None
    ) -> Iterator[Offer | Pause]:
        """Ways out for who stands, where all else stands; not again and again without getting farther."""
        if self._paths.restless or math.hypot(asked.start.forward, asked.start.lateral) > _SLOW:
            return
        tries, ahead = 1, line.coordinates(asked.start.x, asked.start.z)[0]
        if before is not None and before.line == line and ahead < before.ahead + _FARTHER:
            tries, ahead = before.tries + 1, before.ahead
        if tries <= _TRIES:
            for found in self._ways_out.ways(asked, line):
                if isinstance(found, Pause):
                    yield found
                    continue
                plan, path, length = found
                yield self._offer(plan, evading, WayOut(line, path, length, ahead, tries))

    def _left_of(self, way_out: WayOut | None, asked: Asked) -> RootPlan | None:
        """What is left of a way out that is being followed, if it is still free."""
        left = None if way_out is None or self._paths.restless else way_out.left(asked)
        states = None if left is None else self._paths.going_as(asked, left)
        if states is None or not self._paths.is_free(asked, states):
            return None
        path, (x, z) = RootPath(asked.start_time, asked.interval, states), states[-1, :2].tolist()
        return RootPlan(path, RootPlanKind.EVASION, (x, z), 0, 0, asked.horizon * asked.interval)

    def _offer(self, plan: RootPlan, evading: Evading | None, way_out: WayOut | None) -> Offer:
        """A path with what is remembered if it is taken."""
        aside, last = _gets_past(plan, evading), plan.path.states
        return Offer(plan, self.memory._replace(last=last, evading=evading, way_out=way_out, aside=aside))

    def _through(self, asked: Asked, line: TravelLine, known: Evading | None, share: float) -> TravelLine | None:
        """The axis of a gap ahead, as a line of travel; the same as long as it is followed.

        None if there is none, or one that the line itself leads through, for who is no slower than elsewhere.
        """
        axis = self._paths.axis_ahead(asked, line)
        if axis is None or (share >= 1.0 and axis.is_parallel(line)):
            return None
        if known is not None and known.is_meant(asked.start, line) and known.along.is_like(axis):
            return known.along
        return axis

    def _kept(self, asked: Asked, line: TravelLine | None, known: Evading | None) -> _Idea | None:
        """What is left of the evasion that is being followed, if it leads past all that is in sight and is free.

        As long as it is, no other is looked for: two ways that cost about the same would be taken in turn, and neither
        be walked. Sideways it is walked as fast as elsewhere, as soon as that is free.
        """
        if line is None or known is None or not known.whole or not known.is_meant(asked.start, line):
            return None
        for share in (1.0, known.share) if known.share < 1.0 else (1.0,):
            plan = self._paths.followed(asked, line, known.along, known.profile, share)
            if plan is not None:
                return _Idea(plan.lost, self._offer(plan, known._replace(share=share), self.memory.way_out))
        return None

    def _evaded(self, matter: _Matter, grid: _Grid) -> list[_Idea]:
        """Evasions from the line of travel in a grid along it, or along the axis of the gap that they lead through."""
        asked, line, known = matter.asked, matter.line, matter.known
        before, share = self.memory.way_out, grid.through or 1.0
        if line is None:
            return []
        along = line if grid.through is None else self._through(asked, line, known, share)
        if along is None:
            return []
        kept = known.profile if known is not None and known.along == along else None
        found = self._paths.evaded(asked, line, along, grid.finder, kept, share)
        return [
            _Idea(plan.lost, self._offer(plan, Evading(one.profile, line, along, share, one.whole), before))
            for plan, one in found
        ]


def _gets_past(plan: RootPlan, evading: Evading | None = None) -> bool:
    """Whether a path leaves the line of travel and gets past what stands on it."""
    whole = evading is not None and evading.whole
    return plan.kind is RootPlanKind.DETOUR or (plan.kind is RootPlanKind.EVASION and whole)


def _slower(commanded: RootPlan, asked: Asked, paces: Sequence[float]) -> list[_Idea]:
    """To walk as commanded, but slower: what that costs is known before it is tried."""
    duration = asked.horizon * asked.interval
    return [_Idea(commanded.lost + duration * (1.0 - pace), pace) for pace in paces if pace < 1.0]


def _leads_back(plan: RootPlan, line: TravelLine) -> bool:
    """Whether a path ends behind its start, along a line: nobody goes back for what only stands there."""
    (first, _), (last, _) = (line.coordinates(x, z) for x, z in plan.path.states[[0, -1], :2].tolist())
    return bool(last < first - _BACK)
