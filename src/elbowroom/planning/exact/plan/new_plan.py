"""A new plan from where the avatar is, where none goes on from an earlier one: what is tried, and in which order."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.exact.memory.previous_plan import StartState
from elbowroom.planning.exact.plan.attempts import same_place
from elbowroom.planning.exact.plan.extension import prolonged
from elbowroom.planning.exact.plan.full_plan import FullPlan
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.plan.upper_body_search import Effort, UpperPlan
from elbowroom.planning.motion import MotionQuery
from elbowroom.planning.result import Blockade, BlockadeKind
from elbowroom.planning.root.motion import brake
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan, RootPlanKind
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.stillness import STILL

_EARLIER = (1, 3, 8)  # key frames before the one that was not reached, at which braking is tried
_SAFELY = (3,)  # the same where the plan has cost as much as it may
_FARTHER = 0.05  # metres that a slower path must get beyond the place where a faster one failed
_FAR_OFF = 1.2  # seconds until a place that is not asked about yet
_WORTH = 0.3  # seconds that a path must cost less than one that was found, to be searched more closely before it
_STANDING = 0.02  # metres: a path that is shorter stands


class _Tried(NamedTuple):
    """A root path, and how far the upper body got on it."""

    root: RootPlan
    upper: UpperPlan


@dataclass(frozen=True, eq=False)
class NewPlan:
    """The making of one plan for one query."""

    body: UpperBodyPlanner
    root_planner: RootPlanner
    query: MotionQuery
    horizon: int  # key intervals that it leads over
    hurry: bool  # something else is wanted than before: what is found soon now, what is better in the next plan
    at_last: bool = False  # all else has been tried from here, in the plans before

    def made(self, left: FullPlan | None) -> FullPlan:
        """The first of these that there is: a root path on which each group finds a path, the commanded one first;
        one on which all groups together find one; to walk on as far as possible, and stand. At last, before these, a
        few steps to where the command leads on.

        `left` is what is left of a walk that has no new end at first sight: that is searched more closely too.
        """
        tried: list[_Tried] = []
        self.body.memory.attempts.begin(hurry=self.hurry, moves=self._moves)
        found = (self._way_out() if self.at_last else None) or self._group_by_group(left, tried)
        if found is None and not self.hurry:
            found = self._all_together(tried)
        return found or self._stop(tried)

    def _group_by_group(self, left: FullPlan | None, tried: list[_Tried]) -> FullPlan | None:
        """A plan on the first root path on which the groups find one; the commanded path is searched with all means.

        The paths that were of no use are added to `tried`.
        """
        query, attempts, blocked_at = self.query, self.body.memory.attempts, 0.0
        for root in self.root_planner.candidates(*self._asked, self.body.settings.paces):
            attempts.enter_root(root.checks)
            if tried and self.hurry and attempts.spent:
                break
            if tried and self._leads_nowhere_new(root, blocked_at + _FARTHER):
                continue
            upper = self._upper_body(root.path, Effort.QUICK)
            blocked = not tried and upper.reached < self.horizon
            until_then = (
                self._braked(root, upper.reached) if blocked and left is None and self._can_wait(upper) else None
            )
            if until_then is not None:
                return until_then
            if blocked and not self.hurry and attempts.is_new(_place(upper)):
                refined = None if left is None else prolonged(self.body, left, root, query, Effort.REFINED)
                if refined is not None:
                    attempts.found()
                    return refined
                upper = self._upper_body(root.path, Effort.REFINED)
            if upper.reached == self.horizon:
                if not tried:
                    attempts.found()
                cheaper = None if self.hurry else self._cheaper(tried, root)
                return cheaper or FullPlan(root, upper.plan, upper.margins)
            tried.append(_Tried(root, upper))
            blocked_at = max(blocked_at, _walked(root.path, min(upper.reached + 1, self.horizon)))
        return None

    @property
    def _asked(self) -> tuple[RootState, Command, int, float, float]:
        """What a root path is asked for."""
        query = self.query
        return query.root, query.command, self.horizon, query.interval, query.time

    def _way_out(self) -> FullPlan | None:
        """A plan over a few steps to where the command leads on, or else over those that lead farthest away from here.

        None if none of them can be taken. Away from what is in the way there is room to bend before it.
        """
        before, here = self.root_planner.memory, (self.query.root.x, self.query.root.z)
        away, farthest = 0.0, None
        for root, length in self.root_planner.ways_out(*self._asked):
            self.body.memory.attempts.enter_root(root.checks)
            if self.body.memory.attempts.spent:
                break
            upper = self._upper_body(root.path, Effort.QUICK)
            if upper.reached == self.horizon:
                return FullPlan(root, upper.plan, upper.margins)
            reached = min(upper.reached, length)
            so_far = math.dist(root.path.states[reached, :2], here)
            if so_far > away + _STANDING:
                away, farthest = so_far, (root, reached + 1)
        stepped = None if farthest is None else self._braked(*farthest)
        if farthest is None or stepped is None or stepped.root.kind is RootPlanKind.STOPPED:
            self.root_planner.memory = before
            return None
        self.root_planner.follow(farthest[0])
        return stepped

    def _can_wait(self, upper: UpperPlan) -> bool:
        """Whether it is early enough to think a path through in the next plan, if it is blocked then too."""
        if len(self.root_planner.moving) or not self._moves:
            return False
        ahead = self.query.interval * upper.search.blocked[1]
        return self.body.memory.attempts.can_wait(_place(upper), ahead)

    @property
    def _moves(self) -> bool:
        return math.hypot(self.query.root.forward, self.query.root.lateral) > STILL

    def _cheaper(self, tried: list[_Tried], than: RootPlan) -> FullPlan | None:
        """A plan on a root path that costs much less than the one that was found, if all groups together find one."""
        cheaper = sorted((one.root for one in tried if one.root.lost + _WORTH < than.lost), key=lambda one: one.lost)
        plans = (self._followed(root, Effort.GLANCE) for root in cheaper)
        return next((plan for plan in plans if plan is not None), None)

    def _all_together(self, tried: list[_Tried]) -> FullPlan | None:
        """A plan on a root path on which all groups together find one after all."""
        efforts = self.body.memory.attempts.efforts([one.upper.reached for one in tried])
        plans = (self._followed(tried[number].root, effort) for number, effort in efforts)
        return next((plan for plan in plans if plan is not None), None)

    def _followed(self, root: RootPlan, effort: Effort) -> FullPlan | None:
        """A plan on a root path, which is followed then; None if there is none, or if enough was done already."""
        if self.body.memory.attempts.spent:
            return None
        upper = self._upper_body(root.path, effort)
        if upper.reached < root.path.horizon:
            return None
        self.root_planner.follow(root)
        return FullPlan(root, upper.plan, upper.margins)

    def _stop(self, tried: list[_Tried]) -> FullPlan:
        """Walk on while possible, then brake, and say why; or do what the previous plan had in mind.

        Only if that is of no use either may the upper body begin as hard as it takes.
        """
        among_moving = len(self.root_planner.moving) > 0
        root, upper = max(tried, key=lambda one: one.upper.reached) if among_moving else tried[0]
        self.root_planner.follow(root)
        why = None if self.hurry else self._why(upper)
        plan, previous = self._braked(root, upper.reached), self.body.memory.recent.continued(self.query)
        if plan is None and (previous is None or among_moving):
            plan = self._braked(root, upper.reached, harsh=True)
        plan = plan or previous or FullPlan(root, upper.plan)
        return plan._replace(local=plan.local._replace(blockade=why))

    def _braked(self, root: RootPlan, reached: int, *, harsh: bool = False) -> FullPlan | None:
        """A plan on a root path that is braked as late as possible; the upper body came as far as `reached` on it."""
        spent = self.body.memory.attempts.spent
        brakings = [(moving, Effort.QUICK) for moving in _moving(reached, _SAFELY if spent else _EARLIER)]
        brakings += [] if self.hurry or spent else [(0, Effort.JOINT)]
        for moving, effort in brakings:
            states = root.path.states.copy()
            brake(states, moving, self.query.interval, self.root_planner.bounds)
            path = replace(root.path, states=states)
            stopping = self._upper_body(path, effort, harsh=harsh)
            if stopping.reached == path.horizon:
                stands = _walked(path, path.horizon) < _STANDING
                kind = RootPlanKind.STOPPED if stands else RootPlanKind.SHORTENED
                return FullPlan(root._replace(path=path, kind=kind), stopping.plan, stopping.margins)
        return None

    def _why(self, upper: UpperPlan) -> Blockade | None:
        """Why there is no path; None as long as that is far off: most of it is solved when it has come nearer.

        On the way to a place that was asked about before it is the answer of then, and none is sought in a plan that
        has cost enough; one who has come to a stand asks anew, once. Near the end of a path it is now and then only the
        motion between free postures that touches: the earlier answer, which names obstacles, says more.
        """
        path, depth, last = upper.search.path, upper.search.blocked[1], self.body.memory.blockade
        place, moves, here = _place(upper), self._moves, (self.query.root.x, self.query.root.z)
        near = last is not None and same_place(place, last.place)
        told = math.dist(self.body.memory.asked_at, here) < _STANDING  # that is: from here
        if last is not None and near and (moves or told):
            why = replace(last, time=path.start_time + path.interval * depth, ahead=_walked(path, depth))
        elif moves and (self.body.memory.attempts.spent or depth * path.interval > _FAR_OFF):
            return None
        else:
            why, self.body.memory.asked_at = upper.search.blockade(), here
            if last is not None and near and why.kind is BlockadeKind.MOTION:
                why = replace(last, time=why.time, ahead=why.ahead)
        self.body.memory.blockade = why
        return why

    def _upper_body(self, path: RootPath, effort: Effort, *, harsh: bool = False) -> UpperPlan:
        """What the upper body can do on a root path, from where the avatar is."""
        start, query = StartState(self.query.upper, self.query.velocity, harsh=harsh), self.query
        previous = self.body.memory.recent.previous(path)
        upper = self.body.plan(path, start, previous, query.others, effort, query.go_on)
        self.body.memory.attempts.enter(upper.plan)
        return upper

    def _leads_nowhere_new(self, root: RootPlan, least: float) -> bool:
        """Whether a path along the same line is shorter than `least` metres, among things that stand still."""
        aside = root.kind is RootPlanKind.EVASION or len(self.root_planner.moving) > 0
        return not aside and _walked(root.path, root.path.horizon) < least


def _place(upper: UpperPlan) -> tuple[float, float]:
    """Where the root is, x and z, at the key time that the upper body did not reach."""
    x, z = upper.search.path.states[upper.search.blocked[1], :2].tolist()
    return x, z


def _moving(reached: int, before: Sequence[int]) -> Iterator[int]:
    """Key frames at which to begin to brake, so many `before` the one that was reached; at last at once."""
    yield from (reached - earlier for earlier in before if reached - earlier > 0)
    yield 0


def _walked(path: RootPath, depth: int) -> float:
    """Metres walked until a key frame."""
    return float(np.linalg.norm(np.diff(path.states[: depth + 1, :2], axis=0), axis=1).sum())
