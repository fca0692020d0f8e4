"""Where no root path can be walked to its end: a safe end, to stand before what stands, to give way to what moves."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from elbowroom.planning.exact.plan.full_plan import FullPlan
from elbowroom.planning.exact.plan.task import STANDING, PlanTask, Tried, walked
from elbowroom.planning.exact.plan.upper_body_search import Effort
from elbowroom.planning.root.motion import brake
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan, RootPlanKind
from elbowroom.planning.stillness import is_still

_EARLIER = (1, 3, 8)  # key frames before the one that was not reached, at which braking is tried
_SAFELY = (3,)  # the same where the plan has cost as much as it may


@dataclass(frozen=True, eq=False)
class SafeEnd:
    """Ends of one plan."""

    task: PlanTask

    def found(self, tried: Sequence[Tried]) -> FullPlan:
        """One after root paths that were `tried` in vain, at least one, and why there is nothing better."""
        task, among_moving = self.task, self.task.among_moving
        last = max(tried, key=lambda one: one.upper.reached) if among_moving else tried[0]
        task.root_planner.follow(last.root)
        why, left = None if task.hurry else task.why(last.upper), task.body.memory.recent.continued(task.query)
        plan = self._given_way(last, left) if among_moving else self._halted(last, left)
        return plan._replace(local=plan.local._replace(blockade=why))

    def braked(self, root: RootPlan, reached: int, *, harsh: bool = False) -> FullPlan | None:
        """A plan on a root path that is braked as late as possible; the upper body came as far as `reached` on it."""
        task, spent = self.task, self.task.attempts.spent
        brakings = [(moving, task.least) for moving in _moving(reached, _SAFELY if spent else _EARLIER)]
        brakings += [] if task.hurry or spent else [(0, Effort.JOINT)]
        for moving, effort in brakings:
            path = self._braked_path(root.path, moving)
            if task.among_moving and task.kept(path) < path.horizon:
                continue
            stopping = task.upper_body(path, effort, harsh=harsh)
            if stopping.reached == path.horizon:
                stands = walked(path, path.horizon) < STANDING
                kind = RootPlanKind.STOPPED if stands else RootPlanKind.SHORTENED
                return FullPlan(root.ended(path, kind), stopping.plan, stopping.margins)
        return None

    def _braked_path(self, path: RootPath, moving: int) -> RootPath:
        """The path, braked after so many key intervals."""
        states = path.states.copy()
        brake(states, moving, self.task.query.interval, self.task.root_planner.bounds)
        return replace(path, states=states)

    def _halted(self, last: Tried, left: FullPlan | None) -> FullPlan:
        """A stop among what stands, on a root path that was tried; or what is `left` of the plan before.

        Only if that is of no use either may the upper body begin as hard as it takes.
        """
        plan = self.braked(last.root, last.upper.reached)
        if plan is None and left is not None:
            plan = self._ended(left)
        if plan is None and left is None:
            plan = self.braked(last.root, last.upper.reached, harsh=True)
        return plan or left or FullPlan(last.root, last.upper.plan)

    def _ended(self, left: FullPlan) -> FullPlan | None:
        """What is left of the last plan, braked on its own way as late as possible, if that ends in the walk."""
        path = left.root.path
        return None if is_still(path.states[-1, 3:6]) else self.braked(left.root, path.horizon)

    def _given_way(self, last: Tried, left: FullPlan | None) -> FullPlan:
        """Among what moves, the first of these that nothing comes into: the way that the plan before leads on, as long
        as it leads far; a stop; what is left of that way in any case; a step aside; a stop as hard as it takes.

        Else what is `left` of the plan before, or the path that was tried, whichever something comes into later.
        """
        root, reached = last.root, last.upper.reached
        ahead = self.task.body.memory.recent.ahead(self.task.query)
        far = ahead is not None and self._leads_far(ahead.path)
        plan = (self._held(ahead) if far else None) or self.braked(root, reached)
        plan = plan or (None if far else self._held(ahead)) or self._stepped_aside()
        plan = plan or self.braked(root, reached, harsh=True)
        if plan is not None:
            return plan
        rest = [FullPlan(root, last.upper.plan)] if left is None else [left, FullPlan(root, last.upper.plan)]
        return max(rest, key=lambda one: self.task.kept(one.root.path))

    def _leads_far(self, path: RootPath) -> bool:
        """Whether a way that is left leads on, as far as a plan in a hurry, and is what is wanted now."""
        far = round(self.task.body.settings.hurried_ahead / self.task.query.interval)
        return not self.task.hurry and path.horizon >= far and not is_still(path.states[-1, 3:6])

    def _held(self, ahead: RootPlan | None) -> FullPlan | None:
        """A motion along a way, held anew against all that moves; None if something comes into it."""
        if ahead is None or self.task.kept(ahead.path) < ahead.path.horizon:
            return None
        upper = self.task.upper_body(ahead.path, Effort.GLANCE)
        return FullPlan(ahead, upper.plan, upper.margins) if upper.reached == ahead.path.horizon else None

    def _stepped_aside(self) -> FullPlan | None:
        """A step out of the way of what moves."""
        root_planner = self.task.root_planner
        before = root_planner.memory
        for root in root_planner.steps_aside(self.task.asked):
            upper = self.task.upper_body(root.path, self.task.least)
            if upper.reached == root.path.horizon:
                return FullPlan(root, upper.plan, upper.margins)
        root_planner.memory = before
        return None


def _moving(reached: int, before: Sequence[int]) -> Iterator[int]:
    """Key frames at which to begin to brake, so many `before` the one that was reached; at last at once."""
    yield from (reached - earlier for earlier in before if reached - earlier > 0)
    yield 0
