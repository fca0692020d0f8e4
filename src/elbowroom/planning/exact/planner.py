"""The exact planner: upper body and root together, farther ahead than the queue holds, with a safe end.

In this order: who stands as before gets the same answer; who walks as planned goes on, and gets a new end when the plan
gets short; for everybody else a new plan is made (`plan/new_plan.py`): along the commanded root path, group by group
(`plan/upper_body_search.py`: decoupled, then under the previous waist, then all together), with more postures where it
is blocked; along other root paths; and if nothing helps the root walks on as far as it can, and comes to a stand. Who
has stood until all was tried steps to where the command leads on, if there is such a place near by.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.planning.command import changed, trembles
from elbowroom.planning.exact.memory.previous_plan import StartState
from elbowroom.planning.exact.plan.extension import prolonged
from elbowroom.planning.exact.plan.full_plan import FullPlan, StandingPlan, first_part, kept_after, stands
from elbowroom.planning.exact.plan.new_plan import NewPlan
from elbowroom.planning.exact.plan.ongoing import OngoingPlan
from elbowroom.planning.exact.plan.plan_memory import PlanMemory
from elbowroom.planning.exact.plan.task import PlanTask
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.plan.upper_body_search import Effort
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.motion import Motion, MotionQuery
from elbowroom.planning.result import LocalPlan
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan, RootPlanKind
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.query import Asked
from elbowroom.planning.stillness import SAME_TIME, is_still
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]


class ExactPlanner:
    """Plans motion for one humanoid in one scene; it remembers the last plan and keeps to it while it is good."""

    def __init__(
        self, humanoid: Humanoid, scene: Scene, settings: ExactSettings | None = None, motions: MotionSet = STOCK
    ) -> None:
        self.settings = settings or ExactSettings()
        self._body = UpperBodyPlanner(humanoid, scene, self.settings, motions)

    def reset(self) -> None:
        """Forget all plans made."""
        self._body.reset()

    @property
    def memory(self) -> PlanMemory:
        """What is kept from plan to plan."""
        return self._body.memory

    def _use(self, interval: float) -> None:
        """Begin anew where key frames are to be so many seconds apart that the memory is of another model."""
        if abs(interval - self.memory.model.interval) > SAME_TIME:
            self._body.reset(interval)

    def plan(self, path: RootPath, start: Floats, rng: np.random.Generator) -> LocalPlan:
        """Motion along `path` that begins at rest at `start` (LOCAL,); nothing is left to chance."""
        del rng
        self._use(path.interval)
        return self._body.plan(path, StartState(start, np.zeros_like(start))).plan

    def plan_motion(self, root_planner: RootPlanner, query: MotionQuery) -> Motion:
        """Motion for the next `query.horizon` key frames, the first part of a plan over the whole look-ahead.

        Who stands as before gets the same answer, who walks as planned goes on; for everybody else all is planned anew.
        """
        self._use(query.interval)
        query = self._begun(query)
        alone = not len(root_planner.moving) and not query.hurry
        whole = self._as_before(query) if alone else None
        if whole is None:
            left = self.memory.ongoing.left(query) if alone and self.memory.ongoing is not None else None
            whole = None if left is None else self._gone_on(left, root_planner, query)
            whole = whole or self._anew(left, root_planner, query, alone=alone)
        self.memory.recent.take(whole)
        return first_part(whole, query.horizon)

    def _begun(self, query: MotionQuery) -> MotionQuery:
        """The query with the command of the one before, where the two are much alike.

        Whoever steers with a mouse or a stick asks for something a little different every time, and means the same. Of
        who stands, and has paths being thought through, much more is taken for that: else nothing would have its turn.
        """
        stand, before = self.memory.standing, self.memory.command
        if stand is not None and not stand.final and not changed(stand.query.command, query.command):
            return query._replace(command=stand.query.command)
        return query if before is None or not trembles(before, query.command) else query._replace(command=before)

    def _as_before(self, query: MotionQuery) -> FullPlan | None:
        """The answer to the same query, where the avatar has stood since and nothing is left to be tried."""
        stand = self.memory.standing
        known = self.settings.remember and stand is not None and stand.final and stand.answers(query)
        return stand.at(query.time) if known and stand is not None else None

    def _anew(self, left: FullPlan | None, root_planner: RootPlanner, query: MotionQuery, *, alone: bool) -> FullPlan:
        """A new plan, and what may be known of it later: an answer to who stands, a walk to go on with.

        `left` is what is left of a walk that has no new end at first sight: it is given up only for what leads on, even
        where a hand that steers wants something a little different. `alone`: nothing moves or is in a hurry.
        """
        memory = self.memory
        hurry = query.hurry or (not is_still(query.root.as_array()[3:6]) and memory.command != query.command)
        memory.command = query.command
        before = root_planner.memory
        task = PlanTask(self._body, root_planner, query, self._horizon(root_planner, query, hurry=hurry), hurry)
        whole = NewPlan(task).made(left)
        if left is None and memory.ongoing is not None and not len(root_planner.moving):
            left = memory.ongoing.left_for_another(query)
        if left is not None and not whole.leads_on and self._is_worth_keeping(left, query):
            root_planner.memory, memory.standing = before, None
            return kept_after(left, whole)
        known = alone and not hurry and stands(whole, query)
        memory.standing = StandingPlan(query, whole, memory.attempts.thorough) if known else None
        lasts = _is_commanded(whole, root_planner) or whole.leads_on
        memory.ongoing = OngoingPlan(query, whole) if alone and lasts else None
        return whole

    def _horizon(self, root_planner: RootPlanner, query: MotionQuery, *, hurry: bool = False) -> int:
        """The key intervals to plan: on uneven ground, where a plan costs most, no more than in a hurry."""
        near = hurry or root_planner.uneven
        ahead = self.settings.hurried_ahead if near else self.settings.look_ahead
        return max(query.horizon, round(ahead / query.interval))

    def _gone_on(self, left: FullPlan, root_planner: RootPlanner, query: MotionQuery) -> FullPlan | None:
        """What is left of a walk that goes on as planned, prolonged if it gets short; None if it has no new end.

        One that evades something is kept for a while, and then planned anew. So is one that is slower along a way, if
        it has no new end; where a hand steers it is planned anew at once.
        """
        horizon, known = self._horizon(root_planner, query), left.root.path.horizon
        commanded, slower = _is_commanded(left, root_planner), bool(query.command.way) and left.root.pace > 0.0
        if known >= horizon and (commanded or slower):
            return left
        whole = self._with_new_end(left, root_planner, query) if commanded or slower else None
        if whole is not None:
            self.memory.ongoing = OngoingPlan(query, whole)
            return whole
        if commanded:
            self.memory.ongoing = None
            return None
        kept = (slower or left.root.kind is RootPlanKind.EVASION) and known >= horizon - self._spare(query)
        return left if kept else None

    def _is_worth_keeping(self, left: FullPlan, query: MotionQuery) -> bool:
        """Whether what is left of a walk leads on, and as far as a plan in a hurry would."""
        return left.leads_on and left.root.path.horizon >= round(self.settings.hurried_ahead / query.interval)

    def _with_new_end(self, left: FullPlan, root_planner: RootPlanner, query: MotionQuery) -> FullPlan | None:
        """What is left of a walk that has become too short, and beyond that a new end, at full speed or else as slow as
        it is; None if there is none, or it ends.
        """
        before, pace = root_planner.memory, left.root.pace
        for share in (1.0, pace) if 0.0 < pace < 1.0 else (pace,) if pace > 0.0 else ():
            root_planner.memory = before
            plan = self._with_new_end_at(share, left, root_planner, query)
            if plan is not None:
                return plan
        return None

    def _with_new_end_at(
        self, pace: float, left: FullPlan, root_planner: RootPlanner, query: MotionQuery
    ) -> FullPlan | None:
        """The same at a share of the speed."""
        near = self._horizon(root_planner, query)
        far = near + self._spare(query)
        asked = Asked(query.root, query.command, far, query.interval, left.root.path.start_time)
        root = root_planner.prolonged(left.root.path, asked, pace)
        if not _goes_on(left.root, root, pace, root_planner.settings.untroubled):
            return None
        plan, reached = prolonged(self._body, left, root, query, Effort.QUICK)
        if plan is None and near <= reached:
            plan, _ = prolonged(self._body, left, root.along(root.path.until(near)), query, Effort.QUICK)
        return plan

    def _spare(self, query: MotionQuery) -> int:
        return round(self.settings.spare / query.interval)


def _is_commanded(whole: FullPlan, root_planner: RootPlanner) -> bool:
    """Whether a motion follows the path as commanded, and the upper body has a way along it."""
    return whole.margins is not None and whole.root.lost < root_planner.settings.untroubled


def _goes_on(left: RootPlan, root: RootPlan, pace: float, untroubled: float) -> bool:
    """Whether what is `left` of a path, made longer at a share of the speed, is walked on as it was to its new end."""
    slower = (1.0 - pace) * root.path.horizon * root.path.interval
    alike = root.kind is RootPlanKind.STRAIGHT or root.kind is left.kind is RootPlanKind.DETOUR
    return alike and root.pace >= pace and root.lost - slower < untroubled
