"""From a command to a short, collision-free root path for what cannot bend: the legs and the pelvis.

Straight where that is free, round the obstacle where it is not, a stop before it where there is no route. The upper
body is not checked: what only it would touch diverts nobody, unless the planner is told to mind something of it.

A path is accepted if the posed legs and the pelvis are free at dense samples of exactly the motion that playback will
show, and if from each of its key frames a stop would be free too. So the next plan always has a way out: to brake.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial

from elbowroom.body.humanoid import Humanoid
from elbowroom.planning.root.cost import SLOW
from elbowroom.planning.root.line.ahead import Above
from elbowroom.planning.root.line.line import wanted_speed
from elbowroom.planning.root.memory import RootMemory
from elbowroom.planning.root.motion import MotionBounds
from elbowroom.planning.root.offer_maker import OfferMaker
from elbowroom.planning.root.offers import Offer, OffersFromHere
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.paths import RootPaths
from elbowroom.planning.root.plan import Patience, Pause, RootPlan, RootPlannerSettings
from elbowroom.planning.root.query import Asked
from elbowroom.planning.stillness import is_still
from elbowroom.world.obstacles.tracks.moving import Moving
from elbowroom.world.scene import Scene

PATIENT = Patience()


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
        self._maker = OfferMaker(self.settings, self._paths)
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
