"""A new plan from where the avatar is, where none goes on from an earlier one: what is tried, and in which order."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

from elbowroom.planning.exact.plan.attempts import Attempts, LeftOff
from elbowroom.planning.exact.plan.full_plan import FullPlan
from elbowroom.planning.exact.plan.safe_end import SafeEnd
from elbowroom.planning.exact.plan.task import STANDING, PlanTask, Tried, place_of, walked
from elbowroom.planning.exact.plan.upper_body_search import Effort, UpperPlan
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import Patience, RootPlan, RootPlanKind

_FARTHER = 0.05  # metres that a slower path must get beyond the place where a faster one failed
_THOUGHT_THROUGH = 4  # root paths on which all groups are searched together
_GRIDS, _GRIDS_STANDING = 2, 4  # in which evasions are looked for, by who walks and who stands


@dataclass(frozen=True, eq=False)
class NewPlan:
    """The making of one plan for one query."""

    task: PlanTask

    def made(self, left: FullPlan | None) -> FullPlan:
        """The first of these that there is: a root path on which each group finds a path, the commanded one first;
        one on which all groups together find one; for who stands, and gets no nearer to what is in the way, a few steps
        to where the command leads on; a safe end.

        `left` is what is left of a walk that has no new end.
        """
        task, tried = self.task, list[Tried]()
        uneven, moving = task.root_planner.uneven, task.among_moving
        task.attempts.begin(task.query, hurry=task.hurry, stands=task.stands, uneven=uneven, moving=moving)
        found = self._group_by_group(left, tried)
        if found is None and not task.hurry:
            found = self._all_together(tried)
        if found is None and task.stands and not task.attempts.spent:
            found = self._way_out()
        found = found or (None if tried else self._waiting(tried))
        return found or SafeEnd(task).found(tried)

    def _waiting(self, tried: list[Tried]) -> FullPlan | None:
        """A stand, where the search for root paths was left before it had found one; the next plan goes on with it."""
        root = self.task.root_planner.stopped(self.task.asked)
        upper = self.task.upper_body(root.path, self.task.least)
        tried.append(Tried(root, upper))
        return FullPlan(root, upper.plan, upper.margins) if upper.reached == root.path.horizon else None

    @property
    def _attempts(self) -> Attempts:
        return self.task.attempts

    def _group_by_group(self, left: FullPlan | None, tried: list[Tried]) -> FullPlan | None:
        """A plan on the first root path on which the groups find one; for who stands the commanded one is searched with
        all means.

        The paths that were of no use are added to `tried`.
        """
        task, ((before, blocked_at), self._attempts.left_off) = self.task, (self._left_off(), None)
        patience = Patience(_GRIDS_STANDING if task.stands else _GRIDS, self._attempts.enough)
        for number, root in enumerate(task.root_planner.candidates(task.asked, task.body.settings.paces, patience)):
            self._attempts.enter_root(root.checks)
            if number < before or (number > 0 and self._leads_nowhere_new(root, blocked_at + _FARTHER)):
                continue
            if not root.free:  # nor are those that follow
                tried += [] if tried else [Tried(root, task.upper_body(root.path, task.least))]
                break
            upper = task.upper_body(root.path, task.least)
            if number == 0 and upper.reached < task.horizon:
                if left is None and self._can_wait(upper) and (plan := self._braked(root, upper.reached)) is not None:
                    return plan
                if task.stands and not task.hurry:
                    upper = self._thought_through(root.path, upper)
            if upper.reached == task.horizon:
                return FullPlan(root, upper.plan, upper.margins, leads_on=True)
            tried.append(Tried(root, upper))
            blocked_at = max(blocked_at, walked(root.path, min(upper.reached + 1, task.horizon)))
            if self._attempts.spent:
                self._attempts.left_off = None if task.stands else LeftOff(number + 1, place_of(upper))
                return None
        return self._group_by_group(left, tried) if before and not tried else None

    def _left_off(self) -> tuple[int, float]:
        """How many root paths the plan before tried in vain, if this one goes on with the others.

        Also how many metres from here the last of these led.
        """
        left_off = self._attempts.left_off
        return (0, 0.0) if left_off is None else (left_off.tried, math.dist(left_off.place, self.task.here))

    def _thought_through(self, path: RootPath, upper: UpperPlan) -> UpperPlan:
        """What is found on a path with more and more effort, where `upper` has no way; what this plan may still do."""
        for effort in (Effort.JOINT, Effort.REFINED):
            if upper.reached == self.task.horizon or self._attempts.spent:
                break
            upper = self.task.upper_body(path, effort)
        return upper

    def _braked(self, root: RootPlan, reached: int) -> FullPlan | None:
        """A plan on a root path that is braked as late as possible; the upper body came as far as `reached` on it."""
        return SafeEnd(self.task).braked(root, reached)

    def _way_out(self) -> FullPlan | None:
        """A plan over a few steps to where the command leads on, or else over those that lead farthest away from here.

        None if none of them can be taken. Away from what is in the way there is room to bend before it.
        """
        task, root_planner = self.task, self.task.root_planner
        before, away, farthest = root_planner.memory, 0.0, None
        for root, length in root_planner.ways_out(task.asked, Patience(enough=self._attempts.enough)):
            self._attempts.enter_root(root.checks)
            if self._attempts.spent:
                root_planner.memory = before
                return None
            upper = task.upper_body(root.path, Effort.QUICK)
            if upper.reached == task.horizon:
                return FullPlan(root, upper.plan, upper.margins, leads_on=True)
            reached = min(upper.reached, length)
            so_far = math.dist(root.path.states[reached, :2], task.here)
            if so_far > away + STANDING:
                away, farthest = so_far, (root, reached + 1)
        stepped = None if farthest is None else self._braked(*farthest)
        if farthest is None or stepped is None or stepped.root.kind is RootPlanKind.STOPPED:
            root_planner.memory = before
            return None
        root_planner.follow(farthest[0])
        return stepped

    def _can_wait(self, upper: UpperPlan) -> bool:
        """Whether it is early enough to think a path through in the next plan, if it is blocked then too."""
        if self.task.among_moving or not self.task.moves:
            return False
        ahead = self.task.query.interval * upper.search.blocked[1]
        return self._attempts.can_wait(place_of(upper), ahead)

    def _all_together(self, tried: Sequence[Tried]) -> FullPlan | None:
        """A plan on a root path on which all groups together find one after all; for who stands, where the waist had no
        way left, one with more postures. Those that led farthest come first.
        """
        free = [one for one in tried if one.root.free]
        farthest = sorted(free, key=lambda one: -one.upper.reached)[:_THOUGHT_THROUGH]
        plans = (self._together(one) for one in farthest)
        return next((plan for plan in plans if plan is not None), None)

    def _together(self, one: Tried) -> FullPlan | None:
        """A plan on a root path that was tried, which is followed then; None if there is none, or enough was done."""
        root, barred = one.root, one.upper.search.barred
        effort = Effort.REFINED if barred else Effort.JOINT
        vain = self._attempts.failed(root.path, effort) is not None or (barred and not self.task.stands)
        if vain or self._attempts.spent:
            return None
        upper = self.task.upper_body(root.path, effort)
        if upper.reached < root.path.horizon:
            return None
        self.task.root_planner.follow(root)
        return FullPlan(root, upper.plan, upper.margins, leads_on=True)

    def _leads_nowhere_new(self, root: RootPlan, least: float) -> bool:
        """Whether a path along the same line is shorter than `least` metres, among things that stand still."""
        aside = root.kind is RootPlanKind.EVASION or self.task.among_moving
        return not aside and walked(root.path, root.path.horizon) < least
