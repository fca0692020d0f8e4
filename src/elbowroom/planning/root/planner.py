"""From a command to a short, collision-free root path for what cannot bend: the legs and the pelvis.

Straight where that is free, round the obstacle where it is not, a stop before it where there is no route. The upper
body is not checked: what only it would touch diverts nobody.

A path is accepted if the posed legs and the pelvis are free at dense samples of exactly the motion that playback will
show, and if from each of its key frames a stop would be free too. So the next plan always has a way out: to brake.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.root.cost import SLOW
from elbowroom.planning.root.evasion import EvasionFinder
from elbowroom.planning.root.line import TravelLine, wanted_speed
from elbowroom.planning.root.memory import Evading, RootMemory
from elbowroom.planning.root.motion import MotionBounds
from elbowroom.planning.root.paths import RootPaths
from elbowroom.planning.root.plan import RootPlan, RootPlanKind, RootPlannerSettings
from elbowroom.planning.root.query import Asked
from elbowroom.world.obstacles.moving import Moving
from elbowroom.world.scene import Scene

_Candidate = tuple[RootPlan, Evading]


class _Offer(NamedTuple):
    """A candidate, or the pace at which one would be walked."""

    lost: float  # seconds
    what: _Candidate | float


class RootPlanner:
    """Plans root paths for one humanoid in one scene.

    It remembers between plans: the line of travel of the command that is being held, where the last path led, and how
    that left the line. `reset` forgets it; a start that does not continue the last path does so too.
    """

    def __init__(self, humanoid: Humanoid, scene: Scene, settings: RootPlannerSettings | None = None) -> None:
        self.settings = settings or RootPlannerSettings()
        self._paths = RootPaths(humanoid, scene, self.settings)
        self.reset()

    def reset(self) -> None:
        """Forget the line of travel."""
        self.memory = RootMemory()  # set to what it was, it goes on as it was then
        self._offered: list[_Candidate] = []

    @property
    def bounds(self) -> MotionBounds:
        """How the root can move."""
        return self._paths.bounds

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
        return self._commanded(Asked(start, command, horizon, interval, start_time), pace)

    def _commanded(self, asked: Asked, pace: float) -> RootPlan:
        command, memory, evading = asked.command, self.memory, self.memory.evading
        line: TravelLine | None = None
        if command.idle:
            plan = self._paths.stopped(asked)
        elif _turns(command):
            plan, evading = self._paths.steered(asked, pace), None
        else:
            line = memory.travel_line(asked.start, command, self.settings.motion, self.settings.widest_detour)
            plan = self._paths.travelled(asked, line, pace)
        self.memory = RootMemory(line, plan.path.states, evading)
        return plan

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
        for plan in self._candidates(Asked(start, command, horizon, interval, start_time), paces):
            self._offered.append((plan, self.memory.evading))
            yield plan

    def follow(self, plan: RootPlan) -> None:
        """Take one of the paths that `candidates` gave last."""
        for offered, evading in self._offered:
            if offered is plan:
                self._taken(offered, evading)

    def _candidates(self, asked: Asked, paces: Sequence[float]) -> Iterator[RootPlan]:
        commanded = self._commanded(asked, 1.0)
        known, line = self.memory.evading, self.memory.line
        direct = known if self.memory.still_turned(asked.start, self.settings.widest_detour) else None
        offers: list[_Offer] = []
        if commanded.lost < self.settings.untroubled:
            yield self._taken(commanded, direct)
        else:
            offers.append(_Offer(commanded.lost, (commanded, direct)))
        duration = asked.horizon * asked.interval
        offers += [_Offer(commanded.lost + duration * (1.0 - pace), pace) for pace in paces if pace < 1.0]
        if wanted_speed(asked.command, self.settings.motion) < SLOW:
            line = None  # who is in no hurry leaves no line
        grids = [] if line is None else list(self._paths.evasions)
        if commanded.kind is RootPlanKind.STOPPED and line is not None and self._paths.is_faced(asked):
            yield from self._steps_aside(asked, direct)
        while offers or grids:
            offers.sort(key=lambda offer: offer.lost)
            if line is not None and grids and _dearer(offers, self.settings.wide_from if len(grids) == 1 else 0.0):
                offers += self._evaded(asked, line, known, grids.pop(0))
                continue
            what = offers.pop(0).what
            if isinstance(what, float):
                self.memory = self.memory._replace(evading=direct)
                yield self._commanded(asked, what)
            else:
                yield self._taken(*what)
        if len(self.moving):
            yield from self._steps_aside(asked, direct)

    def _steps_aside(self, asked: Asked, evading: Evading) -> Iterator[RootPlan]:
        """Short steps out of the way of what moves."""
        for plan in self._paths.steps_aside(asked):
            yield self._taken(plan, evading)

    def _taken(self, plan: RootPlan, evading: Evading) -> RootPlan:
        self.memory = RootMemory(self.memory.line, plan.path.states, evading)
        return plan

    def _evaded(self, asked: Asked, line: TravelLine, known: Evading, finder: EvasionFinder) -> list[_Offer]:
        """Evasions from the line of travel."""
        kept = known[0] if known is not None and known[1] == line else None
        found = self._paths.evaded(asked, line, finder, kept)
        return [_Offer(plan.lost, (plan, (profile, line))) for plan, profile in found]


def _dearer(offers: list[_Offer], lost: float) -> bool:
    """Whether all offers, in order, cost at least so many seconds."""
    return not offers or offers[0].lost >= lost


def _turns(command: Command) -> bool:
    """Whether the user turns the body by hand."""
    return command.turn != 0.0 and command.direction is None
