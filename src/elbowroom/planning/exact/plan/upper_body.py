"""What is tried for a root path: each group by itself, then under the previous plan's waist, then all together.

If there is no motion then, postures are added where it was blocked, and it is tried again.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import SEARCH_ORDER, DofGroup, columns_of
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.planning.exact.group.path_problem import PathProblem
from elbowroom.planning.exact.group.problem import Weights
from elbowroom.planning.exact.group.upper_body_model import UpperBodyModel, upper_body_model
from elbowroom.planning.exact.memory.previous_plan import PreviousPlan, RequiredMargins, StartState, required_margins
from elbowroom.planning.exact.plan.plan_memory import PlanMemory
from elbowroom.planning.exact.plan.upper_body_search import Effort, UpperBodySearch, UpperPlan
from elbowroom.planning.exact.refine.blocked_slice import Known, children_for, waists_for
from elbowroom.planning.exact.refine.sampling import RefinementSettings
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.exact.sweep.motion_bounds import root_sweeps
from elbowroom.planning.model.footing import Footing
from elbowroom.planning.model.lowered_legs import LoweredLegs
from elbowroom.planning.motion import GoOn, keep_going
from elbowroom.planning.narrow.build import build_of
from elbowroom.planning.narrow.goals import goals_where_narrow
from elbowroom.planning.narrow.places import NarrowPlaces
from elbowroom.planning.on_stairs import goals_on_stairs
from elbowroom.planning.result import LocalPlan, PlanStatus
from elbowroom.planning.root.path import RootPath, ground_covered
from elbowroom.world.obstacles.rows import any_in
from elbowroom.world.obstacles.tracks.along import Along
from elbowroom.world.obstacles.tracks.moving import Moving
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_NEARLY = 0.5  # metres: more than any margin
_SPARE = 0.05  # metres


class UpperBodyPlanner:
    """A walker's upper body in a scene: the model that it shares, and what it remembers."""

    def __init__(self, humanoid: Humanoid, scene: Scene, settings: ExactSettings, motions: MotionSet = STOCK) -> None:
        self.settings = settings
        self._made_of = humanoid, motions
        self._obstacles = scene.obstacles
        self._weights = Weights(
            settings.step_weight, settings.near_weight, settings.comfort, settings.keeping, settings.rounds
        )
        self._refinement = RefinementSettings()
        body = body_model(humanoid)
        self._gait = body.gait
        self._legs = LoweredLegs(body, scene.obstacles, scene.ground)
        self._underfoot = Footing(body, scene.ground).underfoot
        self._narrow = NarrowPlaces(build_of(humanoid, body), scene.free_map)
        self.reset()

    @property
    def model(self) -> UpperBodyModel:
        """What is known of the upper body."""
        return self.memory.model

    def reset(self, interval: float | None = None) -> None:
        """Forget everything; plan for key frames so many seconds apart from now on."""
        wanted = self.settings.interval if interval is None else interval
        self.memory = PlanMemory(upper_body_model(*self._made_of, self.settings, wanted), self._underfoot)
        self._margins = required_margins(self.settings, wanted, 0)

    def plan(
        self,
        path: RootPath,
        begins: StartState,
        previous: PreviousPlan | None = None,
        others: Moving | None = None,
        effort: Effort = Effort.REFINED,
        go_on: GoOn = keep_going,
        after: UpperBodySearch | None = None,
    ) -> UpperPlan:
        """Motion along `path` from where it `begins`, near the `previous` plan; `others` move besides the scene's.

        `go_on` is called before each search, and raises an exception to call the plan off. `after` is the search of
        these in vain with less effort, by an earlier plan: what it tried is not tried again.
        """
        path = self._legs.stood(path)
        near = self._near(path, others)
        legs = self._legs.among(others, path)
        quick, again = effort in (Effort.GLANCE, Effort.QUICK), effort is not Effort.GLANCE
        rounds = 0 if quick else self.settings.guided_rounds
        search = after or self._search_of(path, begins, previous, near, legs, go_on)
        if after is not None:
            ways, stamps = after.caches.roots, after.problem.near.stamps
            after.go_on_with(root_sweeps(ways, self.model.chain, after.path.states, path.interval, stamps))
        found = None if after is not None else search.motion(rounds, again=again)
        if found is None and effort is Effort.REFINED and not search.spent and self._refine(search):
            before, search = search, self._search_of(path, begins, previous, near, legs, go_on)
            if after is None:
                search.evidence_log.begin_after(before.evidence_log)
            found = search.motion(rounds)
        if found is not None:
            return UpperPlan(found, path.horizon, search, search.margins)
        evidence_log, goals = search.evidence_log, search.goals
        plan = LocalPlan(PlanStatus.EXHAUSTED, goals[:0], goals, evidence_log.evidence(), joint=evidence_log.joint)
        if search is after:
            plan = plan._replace(evidence=(), joint=None)
        return UpperPlan(plan, search.deepest, search)

    def _near(self, path: RootPath, others: Moving | None) -> Along:
        """What the upper body could reach on a path whose feet stand: not what lies under them."""
        reach = self.model.chain.span + _NEARLY
        low_x, high_x, low_z, high_z = ground_covered(path.states)
        ground = (low_x - reach, low_z - reach), (high_x + reach, high_z + reach)
        heights = self._legs.footing.over_soles(path.states)
        return self._obstacles.along(path.times, ground, others, heights)

    def _search_of(
        self,
        path: RootPath,
        begins: StartState,
        previous: PreviousPlan | None,
        near: Along,
        legs: LoweredLegs,
        go_on: GoOn,
    ) -> UpperBodySearch:
        caches = self.memory.begin(path.horizon)
        roots = root_sweeps(caches.roots, self.model.chain, path.states, path.interval, near.stamps)
        margins = self._required(path, begins.ahead)
        walk = goals_on_stairs(self.model.goals(path), path.states, self._gait.scale, self._gait.half_leg)
        goals = goals_where_narrow(self._narrow, path, walk) if any_in(near.spans) else walk
        problem = PathProblem.of(path, walk, goals, previous, begins, roots, near, margins)
        return UpperBodySearch(caches, self._weights, self.model, legs, problem, go_on)

    def _required(self, path: RootPath, ahead: int) -> RequiredMargins:
        """The margins of nodes and motion along a path that begins so many key intervals ahead."""
        until = ahead + path.horizon
        if self._margins.motion_margins.shape[1] < until:
            self._margins = required_margins(self.settings, path.interval, 2 * until)
        return self._margins.since(ahead, path.horizon)

    def _refine(self, search: UpperBodySearch) -> bool:
        """Take in postures that are free where a group was blocked; whether there are any that were not known."""
        changed = {group for group, found in self._reaching(search) if self.memory.add(group, found)}
        self.memory.take_in(changed)
        return bool(changed)

    def _reaching(self, search: UpperBodySearch) -> Iterator[tuple[DofGroup, Floats]]:
        """Postures for the slices from the blocked one on: of the waist, and of the child that was blocked.

        Of the waist those are taken under which what follows it is free too.
        """
        blocked, failed, model = search.blocked_slice(), search.blocked[0], self.model
        last = min(blocked.depth + self._refinement.slices, search.path.horizon + 1)
        for depth in range(blocked.depth, last):
            for number in sorted({0, failed}):
                group = SEARCH_ORDER[number]
                here = blocked._replace(depth=depth, goal=search.goals[depth, columns_of(group)])
                known = Known(group, model.limbs[group], model.reaches[group], self.memory.known(group))
                if number == 0:
                    trunk = known._replace(limb=model.trunk, reach=model.trunk_reach)
                    yield group, waists_for(model.own_body, trunk, here, self._refinement, search.too_deep)
                else:
                    yield group, children_for(model.own_body, known, here, self._refinement)
