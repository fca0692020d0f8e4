"""A new plan from where the avatar is, where none goes on from an earlier one: what is tried, and in which order."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from elbowroom.body.root import RootState
from elbowroom.planning.command import Command
from elbowroom.planning.exact.memory.previous_plan import StartState
from elbowroom.planning.exact.plan.attempts import Attempts, LeftOff, same_place
from elbowroom.planning.exact.plan.full_plan import FullPlan
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.plan.upper_body_search import Effort, UpperPlan
from elbowroom.planning.motion import MotionQuery
from elbowroom.planning.result import Blockade, BlockadeKind
from elbowroom.planning.root.motion import brake
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan, RootPlanKind
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.stillness import STILL, is_still

_EARLIER = (1, 3, 8)  # key frames before the one that was not reached, at which braking is tried
_SAFELY = (3,)  # the same where the plan has cost as much as it may
_FARTHER = 0.05  # metres that a slower path must get beyond the place where a faster one failed
_FAR_OFF = 1.2  # seconds until a place that is not asked about yet
_THOUGHT_THROUGH = 4  # root paths on which all groups are searched together
_GRIDS, _GRIDS_STANDING = 2, 4  # in which evasions are looked for, by who walks and who stands
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

    def made(self, left: FullPlan | None) -> FullPlan:
        """The first of these that there is: a root path on which each group finds a path, the commanded one first;
        one on which all groups together find one; for who stands, and gets no nearer to what is in the way, a few steps
        to where the command leads on; to walk on as far as possible, and stand.

        `left` is what is left of a walk that has no new end.
        """
        tried: list[_Tried] = []
        uneven, moving = not self.root_planner.bounds.ground.plain, len(self.root_planner.moving) > 0
        self._attempts.begin(self.query, hurry=self.hurry, stands=self._stands, uneven=uneven, moving=moving)
        found = self._group_by_group(left, tried)
        if found is None and not self.hurry:
            found = self._all_together(tried)
        if found is None and self._stands and not self._attempts.spent:
            found = self._way_out()
        return found or self._stop(tried)

    def _group_by_group(self, left: FullPlan | None, tried: list[_Tried]) -> FullPlan | None:
        """A plan on the first root path on which the groups find one; for who stands the commanded one is searched with
        all means.

        The paths that were of no use are added to `tried`.
        """
        (before, blocked_at), self._attempts.left_off = self._left_off(), None
        grids = _GRIDS_STANDING if self._stands else _GRIDS
        candidates = self.root_planner.candidates(*self._asked, self.body.settings.paces, grids)
        for number, root in enumerate(candidates):
            self._attempts.enter_root(root.checks)
            if number < before or (number > 0 and self._leads_nowhere_new(root, blocked_at + _FARTHER)):
                continue
            upper = self._upper_body(root.path, self._least)
            if number == 0 and upper.reached < self.horizon:
                if left is None and self._can_wait(upper) and (plan := self._braked(root, upper.reached)) is not None:
                    return plan
                if self._stands and not self.hurry:
                    upper = self._thought_through(root.path, upper)
            if upper.reached == self.horizon:
                return FullPlan(root, upper.plan, upper.margins, leads_on=True)
            tried.append(_Tried(root, upper))
            blocked_at = max(blocked_at, _walked(root.path, min(upper.reached + 1, self.horizon)))
            if self._attempts.spent:
                self._attempts.left_off = None if self._stands else LeftOff(number + 1, _place(upper))
                return None
        return self._group_by_group(left, tried) if before and not tried else None

    def _left_off(self) -> tuple[int, float]:
        """How many root paths the plan before tried in vain, if this one goes on with the others.

        Also how many metres from here the last of these led.
        """
        left_off, here = self._attempts.left_off, (self.query.root.x, self.query.root.z)
        return (0, 0.0) if left_off is None else (left_off.tried, math.dist(left_off.place, here))

    def _thought_through(self, path: RootPath, upper: UpperPlan) -> UpperPlan:
        """What is found on a path with more and more effort, where `upper` has no way; what this plan may still do."""
        for effort in (Effort.JOINT, Effort.REFINED):
            if upper.reached == self.horizon or self._attempts.spent:
                break
            upper = self._upper_body(path, effort)
        return upper

    @property
    def _least(self) -> Effort:
        """What is tried on every root path."""
        return Effort.GLANCE if self.query.hurry else Effort.QUICK

    @property
    def _attempts(self) -> Attempts:
        return self.body.memory.attempts

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
            self._attempts.enter_root(root.checks)
            if self._attempts.spent:
                self.root_planner.memory = before
                return None
            upper = self._upper_body(root.path, Effort.QUICK)
            if upper.reached == self.horizon:
                return FullPlan(root, upper.plan, upper.margins, leads_on=True)
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
        return self._attempts.can_wait(_place(upper), ahead)

    @property
    def _moves(self) -> bool:
        return math.hypot(self.query.root.forward, self.query.root.lateral) > STILL

    @property
    def _stands(self) -> bool:
        """Whether nothing moves, the avatar neither."""
        still = is_still(self.query.root.as_array()[3:6]) and is_still(self.query.velocity)
        return still and not len(self.root_planner.moving)

    def _all_together(self, tried: list[_Tried]) -> FullPlan | None:
        """A plan on a root path on which all groups together find one after all; for who stands, where the waist had no
        way left, one with more postures. Those that led farthest come first.
        """
        farthest = sorted(tried, key=lambda one: -one.upper.reached)[:_THOUGHT_THROUGH]
        plans = (self._together(one) for one in farthest)
        return next((plan for plan in plans if plan is not None), None)

    def _together(self, one: _Tried) -> FullPlan | None:
        """A plan on a root path that was tried, which is followed then; None if there is none, or enough was done."""
        root, barred = one.root, one.upper.search.barred
        effort = Effort.REFINED if barred else Effort.JOINT
        vain = self._attempts.failed(root.path, effort) is not None or (barred and not self._stands)
        if vain or self._attempts.spent:
            return None
        upper = self._upper_body(root.path, effort)
        if upper.reached < root.path.horizon:
            return None
        self.root_planner.follow(root)
        return FullPlan(root, upper.plan, upper.margins, leads_on=True)

    def _stop(self, tried: list[_Tried]) -> FullPlan:
        """Walk on while possible, then brake, and say why; or do what the previous plan had in mind.

        Only if that is of no use either may the upper body begin as hard as it takes.
        """
        among_moving = len(self.root_planner.moving) > 0
        root, upper = max(tried, key=lambda one: one.upper.reached) if among_moving else tried[0]
        self.root_planner.follow(root)
        why = None if self.hurry else self._why(upper)
        plan, previous = self._braked(root, upper.reached), self.body.memory.recent.continued(self.query)
        if plan is None and previous is not None and not among_moving:
            plan = self._ended(previous)
        if plan is None and (previous is None or among_moving):
            plan = self._braked(root, upper.reached, harsh=True)
        plan = plan or previous or FullPlan(root, upper.plan)
        return plan._replace(local=plan.local._replace(blockade=why))

    def _ended(self, previous: FullPlan) -> FullPlan | None:
        """What is left of the last plan, braked on its own way as late as possible, if that ends in the walk."""
        path = previous.root.path
        ends = is_still(path.states[-1, 3:6])
        return None if ends else self._braked(previous.root, path.horizon)

    def _braked(self, root: RootPlan, reached: int, *, harsh: bool = False) -> FullPlan | None:
        """A plan on a root path that is braked as late as possible; the upper body came as far as `reached` on it."""
        spent = self._attempts.spent
        brakings = [(moving, self._least) for moving in _moving(reached, _SAFELY if spent else _EARLIER)]
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
        depth, last = upper.search.blocked[1], self.body.memory.blockade
        path = replace(upper.search.path, start_time=self.query.time)  # it may have been searched by an earlier plan
        place, moves, here = _place(upper), self._moves, (self.query.root.x, self.query.root.z)
        near = last is not None and same_place(place, last.place)
        told = math.dist(self.body.memory.asked_at, here) < _STANDING  # that is: from here
        if last is not None and near and (moves or told):
            why = replace(last, time=path.start_time + path.interval * depth, ahead=_walked(path, depth))
        elif (moves and depth * path.interval > _FAR_OFF) or not self._may_ask_why:
            return None
        else:
            why, self.body.memory.asked_at = self._searched(path, Effort.QUICK).search.blockade(), here
            if last is not None and near and why.kind is BlockadeKind.MOTION:
                why = replace(last, time=why.time, ahead=why.ahead)
        self.body.memory.blockade = why
        return why

    @property
    def _may_ask_why(self) -> bool:
        """Whether so little was done in this plan that it may be asked why there is no path; if not, in the next."""
        return len(self.root_planner.moving) > 0 or self._attempts.may_ask_why()

    def _upper_body(self, path: RootPath, effort: Effort, *, harsh: bool = False) -> UpperPlan:
        """What the upper body can do on a root path, from where the avatar is."""
        if not harsh and (vain := self._attempts.failed(path, effort)) is not None:
            return vain
        upper = self._searched(path, effort, harsh=harsh)
        barred = upper.search.barred and effort is not Effort.REFINED
        self._attempts.enter(path, Effort.JOINT if barred else effort, upper)
        return upper

    def _searched(self, path: RootPath, effort: Effort, *, harsh: bool = False) -> UpperPlan:
        start, query = StartState(self.query.upper, self.query.velocity, harsh=harsh), self.query
        previous = self.body.memory.recent.previous(path)
        vain = self._attempts.failed(path, Effort.JOINT) if effort is Effort.REFINED and not harsh else None
        after = None if vain is None else vain.search
        return self.body.plan(path, start, previous, query.others, effort, query.go_on, after)

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
