"""From a command to a short, collision-free root path for what cannot bend: the legs and the pelvis.

Straight where that is free, round the obstacle where it is not, a stop before it where there is no route. The upper
body is not checked: what only it would touch diverts nobody, unless the planner is told to mind something of it.

A path is accepted if the posed legs and the pelvis are free at dense samples of exactly the motion that playback will
show, and if from each of its key frames a stop would be free too. So the next plan always has a way out: to brake.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.root.cost import SLOW
from elbowroom.planning.root.evasion.evasion import EvasionFinder
from elbowroom.planning.root.line.ahead import Above
from elbowroom.planning.root.line.line import TravelLine, wanted_speed
from elbowroom.planning.root.line.way_ahead import line_of
from elbowroom.planning.root.memory import Evading, RootMemory
from elbowroom.planning.root.motion import MotionBounds
from elbowroom.planning.root.offers import Offer, OffersFromHere
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.paths import RootPaths
from elbowroom.planning.root.plan import Patience, Pause, RootPlan, RootPlanKind, RootPlannerSettings
from elbowroom.planning.root.query import Asked
from elbowroom.planning.root.way_out import WayOut, WayOutFinder, WayOutSettings
from elbowroom.planning.stillness import is_still
from elbowroom.world.obstacles.tracks.moving import Moving
from elbowroom.world.scene import Scene

_SLOW = 0.1  # m/s: who walks faster has somewhere to go
_TRIES = 2  # ways out that are taken one after the other, without getting farther
_FARTHER = 0.15  # metres along a line that are worth another
_BACK = 0.05  # metres along a line: less is no way back
PATIENT = Patience()


class _Idea(NamedTuple):
    """An offer, or the pace at which one would be walked."""

    lost: float  # seconds
    what: Offer | float


class RootPlanner:
    """Plans root paths for one humanoid in one scene.

    It remembers between plans: the line of travel of the command that is being held, where the last path led, and how
    that left the line. `reset` forgets it; a start that does not continue the last path does so too.
    """

    def __init__(
        self,
        humanoid: Humanoid,
        scene: Scene,
        settings: RootPlannerSettings | None = None,
        above: Above | None = None,
    ) -> None:
        """Routes lead round what is in the way of what is carried `above` legs and pelvis, if anything is given."""
        self.settings = settings or RootPlannerSettings()
        self._paths = RootPaths(humanoid, scene, self.settings, above)
        self._maker = _OfferMaker(self.settings, self._paths)
        self.reset()

    def reset(self) -> None:
        """Forget the line of travel, and what was found out: what is counted again then is what it was at first."""
        self.memory = RootMemory()
        self._paths.reset()
        self._offered: list[Offer] = []
        self._from_here = OffersFromHere()

    @property
    def memory(self) -> RootMemory:
        """What it remembers; set to what it was, it goes on as it was then."""
        return self._maker.memory

    @memory.setter
    def memory(self, memory: RootMemory) -> None:
        self._maker.memory = memory

    @property
    def bounds(self) -> MotionBounds:
        """How the root can move."""
        return self._paths.bounds

    @property
    def uneven(self) -> bool:
        """Whether the ground is no plane."""
        return not self.bounds.ground.plain

    @property
    def moving(self) -> Moving:
        """All that moves."""
        return self._paths.moving

    @property
    def others(self) -> Moving:
        """What moves besides the scene's own."""
        return self._paths.others

    @others.setter
    def others(self, others: Moving) -> None:
        self._paths.others = others

    def plan(self, asked: Asked, pace: float = 1.0) -> RootPlan:
        """The path as it is asked for, walked at the share `pace`, above 0 and up to 1, of the wanted speed."""
        return self._maker.commanded(asked, pace)

    def stopped(self, asked: Asked) -> RootPlan:
        """To a stand, whatever is commanded. What it remembers stays as it is."""
        plan = self._paths.stopped(asked)
        return plan.ended(plan.path)

    def prolonged(self, left: RootPath, asked: Asked, pace: float = 1.0) -> RootPlan:
        """What is `left` of a path from the start on, made longer to the horizon that is asked for, beyond its own.

        So who goes on does as was planned. The new end is what `plan` has, walked at the share `pace` of the wanted
        speed.
        """
        return self._maker.prolonged(asked, left, pace)

    def candidates(self, asked: Asked, paces: Sequence[float] = (), patience: Patience = PATIENT) -> Iterator[RootPlan]:
        """Paths for an upper body to choose from, the one that costs least first.

        The path as commanded, evasions from it, and slower ones at the shares `paces` of the wanted speed. Evasions
        along the axis of a gap and those that lead far aside are thought of when the others have become dear, as far
        as the `patience` reaches; where it ends for who stands, the next who asks from there gets those that are left.
        Those that are not free of what moves come last (`RootPlan.free`). The last one that was given is the one that
        is being followed; whoever takes an earlier one says so (`follow`).
        """
        grids = patience.grids
        make = partial(self._maker.candidates, asked, paces, grids)
        return (offer.plan for offer in self._offers(f"{grids} grids", asked, make, patience))

    def steps_aside(self, asked: Asked) -> Iterator[RootPlan]:
        """Short steps out of the way of what moves, free ones; duties as for `candidates`."""
        return (offer.plan for offer in self._offers("steps aside", asked, lambda: self._maker.steps_aside(asked)))

    def kept(self, path: RootPath, asked: Asked) -> int:
        """The leading key intervals of a path from the start in which legs and pelvis are free of all, also of what
        moves.
        """
        return self._paths.kept(asked, path.states)

    def ways_out(self, asked: Asked, patience: Patience = PATIENT) -> Iterator[tuple[RootPlan, int]]:
        """Paths that step to where the command leads on, the cheapest first; duties as for `candidates`.

        With each, how many key intervals the steps take. They are for who has asked for those, and can follow none.
        """
        line, before = self.memory.line, self.memory.way_out
        if line is None or wanted_speed(asked.command, self.settings.motion) < SLOW:
            return  # who is in no hurry stays
        for offer in self._offers("ways out", asked, lambda: self._maker.out(asked, line, None, before), patience):
            yield offer.plan, 0 if offer.memory.way_out is None else offer.memory.way_out.length

    def _offers(
        self,
        kind: str,
        asked: Asked,
        make: Callable[[], Iterator[Offer | Pause]],
        patience: Patience = PATIENT,
    ) -> Iterator[Offer]:
        """What is made, or, for who stands among what stands, what was offered before; each is taken in turn."""
        self._offered.clear()
        alone = not len(self.moving)
        rests = alone and is_still(asked.start.as_array()[3:6])
        for offer in self._from_here.again(kind, asked, make) if rests else make():
            if isinstance(offer, Pause):
                if patience.enough(offer.checks) and alone:
                    return  # whoever comes to rest will have what is left
                continue
            self._offered.append(offer)
            self.memory = offer.memory
            yield offer

    def follow(self, plan: RootPlan) -> None:
        """Take one of the paths that `candidates` gave last."""
        for offered in self._offered:
            if offered.plan is plan:
                self.memory = offered.memory


class _OfferMaker:
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
        if (left := self._left_of(self.memory.way_out, asked)) is not None:
            yield self._offer(left, direct, before)
        offers: list[_Idea] = []
        if commanded.lost < self.settings.untroubled:
            yield self._offer(commanded, direct, before)
        else:
            offers.append(_Idea(commanded.lost, self._offer(commanded, direct, before)))
        if commanded.beside and line is not None:
            squeezed = self._paths.travelled(asked, line, 1.0, through=True)
            offers.append(_Idea(squeezed.lost, self._offer(squeezed, direct, before)))
        duration = asked.horizon * asked.interval
        offers += [_Idea(commanded.lost + duration * (1.0 - pace), pace) for pace in paces if pace < 1.0]
        if wanted_speed(asked.command, self.settings.motion) < SLOW:
            line = None  # who is in no hurry leaves no line
        (fine, wide), dear = self._paths.evasions, self.settings.wide_from
        grids = [(0.0, fine, None), (dear, fine, 1.0), (dear, fine, fine.settings.short), (dear, wide, None)]
        grids = [] if line is None else grids
        kept = self._kept(asked, line, known)
        offers += [] if kept is None else [kept]
        if commanded.kind is RootPlanKind.STOPPED and line is not None and self._paths.is_faced(asked):
            yield from (step for step in self.steps_aside(asked, direct) if not _leads_back(step.plan, line))
        while offers or (grids and most > 0 and line is not None):
            offers.sort(key=lambda offer: offer.lost)
            if kept is None and line is not None and most > 0 and grids and _dearer(offers, grids[0][0]):
                _, finder, through = grids.pop(0)
                evaded = self._evaded(asked, line, known, finder, through)
                offers, most = offers + evaded, most - bool(evaded)
                continue
            idea = offers.pop(0)
            what, kept = idea.what, None if idea is kept else kept
            if isinstance(what, float):
                self.memory = self.memory._replace(evading=direct, way_out=before)
                yield self._offer(self.commanded(asked, what), direct, before)
                continue
            if line is not None and what.plan.kind is RootPlanKind.STOPPED:
                yield from self.out(asked, line, direct, before)
                line = None
            yield what
        if len(self._paths.moving):
            yield from self.steps_aside(asked, direct)

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

    def _evaded(
        self, asked: Asked, line: TravelLine, known: Evading | None, finder: EvasionFinder, through: float | None
    ) -> list[_Idea]:
        """Evasions from the line of travel; if they are to lead `through` a gap, in a grid that lies along its axis.

        Sideways they are walked at that share of the usual speed.
        """
        before, share = self.memory.way_out, through or 1.0
        along = line if through is None else self._through(asked, line, known, share)
        if along is None:
            return []
        kept = known.profile if known is not None and known.along == along else None
        found = self._paths.evaded(asked, line, along, finder, kept, share)
        return [
            _Idea(plan.lost, self._offer(plan, Evading(one.profile, line, along, share, one.whole), before))
            for plan, one in found
        ]


def _gets_past(plan: RootPlan, evading: Evading | None = None) -> bool:
    """Whether a path leaves the line of travel and gets past what stands on it."""
    whole = evading is not None and evading.whole
    return plan.kind is RootPlanKind.DETOUR or (plan.kind is RootPlanKind.EVASION and whole)


def _dearer(offers: list[_Idea], lost: float) -> bool:
    """Whether all offers, in order, cost at least so many seconds."""
    return not offers or offers[0].lost >= lost


def _leads_back(plan: RootPlan, line: TravelLine) -> bool:
    """Whether a path ends behind its start, along a line: nobody goes back for what only stands there."""
    (first, _), (last, _) = (line.coordinates(x, z) for x, z in plan.path.states[[0, -1], :2].tolist())
    return bool(last < first - _BACK)
