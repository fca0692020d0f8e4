"""What a new plan is made for and from: one query, one body among what stands and moves; and how a path is tried."""

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from elbowroom.planning.exact.memory.previous_plan import StartState
from elbowroom.planning.exact.plan.attempts import Attempts, same_place
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.plan.upper_body_search import Effort, UpperPlan
from elbowroom.planning.motion import MotionQuery
from elbowroom.planning.result import Blockade, BlockadeKind
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.query import Asked
from elbowroom.planning.stillness import STILL, is_still

STANDING = 0.02  # metres: a path that is shorter stands
_FAR_OFF = 1.2  # seconds until a place that is not asked about yet


class Tried(NamedTuple):
    """A root path, and how far the upper body got on it."""

    root: RootPlan
    upper: UpperPlan


@dataclass(frozen=True, eq=False)
class PlanTask:
    """One query, and who answers it."""

    body: UpperBodyPlanner
    root_planner: RootPlanner
    query: MotionQuery
    horizon: int  # key intervals that the plan leads over
    hurry: bool  # something else is wanted than before: what is found soon now, what is better in the next plan

    @property
    def attempts(self) -> Attempts:
        """What was tried so far, and what it has cost."""
        return self.body.memory.attempts

    @property
    def least(self) -> Effort:
        """What is tried on every root path."""
        return Effort.GLANCE if self.query.hurry else Effort.QUICK

    @property
    def asked(self) -> Asked:
        """What a root path is asked for."""
        query = self.query
        return Asked(query.root, query.command, self.horizon, query.interval, query.time)

    @property
    def here(self) -> tuple[float, float]:
        """Where the root is, x and z."""
        return self.query.root.x, self.query.root.z

    @property
    def moves(self) -> bool:
        """Whether the avatar walks."""
        return math.hypot(self.query.root.forward, self.query.root.lateral) > STILL

    @property
    def among_moving(self) -> bool:
        """Whether anything else moves, or could."""
        return len(self.root_planner.moving) > 0

    @property
    def stands(self) -> bool:
        """Whether nothing moves, the avatar neither."""
        still = is_still(self.query.root.as_array()[3:6]) and is_still(self.query.velocity)
        return still and not self.among_moving

    def kept(self, path: RootPath) -> int:
        """The leading key intervals of a path in which legs and pelvis are free of all, also of what moves."""
        return self.root_planner.kept(path, self.asked)

    def upper_body(self, path: RootPath, effort: Effort, *, harsh: bool = False) -> UpperPlan:
        """What the upper body can do on a root path, from where the avatar is; `harsh`: it may begin as hard as it
        takes.
        """
        if not harsh and (vain := self.attempts.failed(path, effort)) is not None:
            return vain
        upper = self._searched(path, effort, harsh=harsh)
        barred = upper.search.barred and effort is not Effort.REFINED
        self.attempts.enter(path, Effort.JOINT if barred else effort, upper)
        return upper

    def _searched(self, path: RootPath, effort: Effort, *, harsh: bool = False) -> UpperPlan:
        start, query = StartState(self.query.upper, self.query.velocity, harsh=harsh), self.query
        previous = self.body.memory.recent.previous(path)
        vain = self.attempts.failed(path, Effort.JOINT) if effort is Effort.REFINED and not harsh else None
        after = None if vain is None else vain.search
        return self.body.plan(path, start, previous, query.others, effort, query.go_on, after)

    def why(self, upper: UpperPlan) -> Blockade | None:
        """Why there is no path; None as long as that is far off: most of it is solved when it has come nearer.

        On the way to a place that was asked about before it is the answer of then, and none is sought in a plan that
        has cost enough; one who has come to a stand asks anew, once. Near the end of a path it is now and then only the
        motion between free postures that touches: the earlier answer, which names obstacles, says more.
        """
        depth, last = upper.search.blocked[1], self.body.memory.blockade
        path = replace(upper.search.path, start_time=self.query.time)  # it may have been searched by an earlier plan
        near = last is not None and same_place(place_of(upper), last.place)
        told = math.dist(self.body.memory.asked_at, self.here) < STANDING  # that is: from here
        if last is not None and near and (self.moves or told):
            why = replace(last, time=path.start_time + path.interval * depth, ahead=walked(path, depth))
        elif (self.moves and depth * path.interval > _FAR_OFF) or not self._may_ask_why:
            return None
        else:
            why, self.body.memory.asked_at = self._searched(path, Effort.QUICK).search.blockade(), self.here
            if last is not None and near and why.kind is BlockadeKind.MOTION:
                why = replace(last, time=why.time, ahead=why.ahead)
        self.body.memory.blockade = why
        return why

    @property
    def _may_ask_why(self) -> bool:
        """Whether so little was done in this plan that it may be asked why there is no path; if not, in the next."""
        return self.among_moving or self.attempts.may_ask_why()


def place_of(upper: UpperPlan) -> tuple[float, float]:
    """Where the root is, x and z, at the key time that the upper body did not reach."""
    x, z = upper.search.path.states[upper.search.blocked[1], :2].tolist()
    return x, z


def walked(path: RootPath, depth: int) -> float:
    """Metres walked until a key frame."""
    return float(np.linalg.norm(np.diff(path.states[: depth + 1, :2], axis=0), axis=1).sum())
