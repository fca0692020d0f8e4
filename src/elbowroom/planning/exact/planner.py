"""The exact planner: upper body and root together, farther ahead than the queue holds, with a safe end.

The root goes at the wanted pace if the upper body has a way along all that is looked at. If not, a slower pace is tried
and taken if it gets beyond the place where the faster one failed; else the root walks on as far as there is a way and
comes to a stand there: a posture that is free stays free when the root stands.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.clips.motion_set import STOCK, MotionSet
from elbowroom.planning.exact.memory.plan_memory import PlanMemory
from elbowroom.planning.exact.memory.previous_plan import Start
from elbowroom.planning.exact.plan.attempts import same_place
from elbowroom.planning.exact.plan.extension import OngoingPlan, extended, rest_of, settled
from elbowroom.planning.exact.plan.full_plan import FullPlan, StandingPlan, first_part, stands
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.plan.upper_body_search import Effort, UpperPlan
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.motion import Motion, MotionQuery
from elbowroom.planning.result import Blockade, BlockadeKind, LocalPlan
from elbowroom.planning.root.motion import brake
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan, RootPlanKind
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.stillness import SAME_TIME, STILL
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

_EARLIER = (1, 2, 3, 5, 8, 13)  # key frames before the one that has no way, at which braking is tried
_FARTHER = 0.05  # metres that a slower way must get beyond the place where a faster one failed
_FAR_OFF = 1.2  # seconds until a place that is not asked about yet
_WORTH = 0.3  # seconds that a path must cost less than one on which there is a way, to be thought of before it
_STANDING = 0.02  # metres: a path that is shorter stands


class _Tried(NamedTuple):
    """A root path and how far the upper body got on it."""

    root: RootPlan
    upper: UpperPlan


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
        """Motion along `path` that begins at rest at `start` (11,); nothing is left to chance."""
        del rng
        self._use(path.interval)
        return self._body.plan(path, Start(start, np.zeros_like(start))).plan

    def plan_motion(self, root_planner: RootPlanner, query: MotionQuery) -> Motion:
        """Motion for the next `query.horizon` key frames, the first part of a plan over the whole look-ahead.

        Who stands as before gets the same answer, who walks as planned goes on; for everybody else all is planned anew.
        """
        self._use(query.interval)
        alone = not len(root_planner.moving) and not query.hurry
        whole = self._as_before(query) if alone else None
        if whole is None:
            left = self.memory.ongoing.left(query) if alone and self.memory.ongoing is not None else None
            whole = None if left is None else self._gone_on(left, root_planner, query)
            whole = whole or self._anew(left, root_planner, query, alone=alone)
        self.memory.recent.take(whole)
        return first_part(whole, query.horizon)

    def _as_before(self, query: MotionQuery) -> FullPlan | None:
        """The answer to the same query, where the avatar has stood since and nothing is left to be tried."""
        stand = self.memory.standing
        known = self.settings.remember and stand is not None and stand.left == 0
        return (
            stand.at(query.time) if known and stand is not None and stand.answers(query, self.memory.version) else None
        )

    def _anew(self, left: FullPlan | None, root_planner: RootPlanner, query: MotionQuery, *, alone: bool) -> FullPlan:
        """A new plan, and what may be known of it later: an answer to who stands, a walk to go on with.

        `left` is what is left of a walk that has no new end at first sight; `alone`: nothing moves or is in a hurry.
        """
        memory, stand = self.memory, self.memory.standing
        before = memory.version
        again = alone and stand is not None and stand.answers(query, before)
        whole = self._whole(left, root_planner, query)
        turns = stand.left - 1 if again and stand is not None else memory.attempts.left
        known = alone and memory.version == before and stands(whole, query)
        memory.standing = StandingPlan(query, before, whole, max(turns, 0)) if known else None
        lasts = _is_commanded(whole, root_planner) or _is_evasion(whole)
        memory.ongoing = OngoingPlan(query, whole) if alone and lasts else None
        return whole

    def _horizon(self, query: MotionQuery) -> int:
        return max(query.horizon, round(self.settings.look_ahead / query.interval))

    def _gone_on(self, left: FullPlan, root_planner: RootPlanner, query: MotionQuery) -> FullPlan | None:
        """What is left of a walk that goes on as planned, prolonged if it gets short; None if it has no new end.

        One that evades something is kept for a while, and then planned anew.
        """
        horizon, known = self._horizon(query), left.root.path.horizon
        if not _is_commanded(left, root_planner):
            return left if known >= horizon - self._spare(query) else None
        if known >= horizon:
            return left
        whole = self._prolonged(left, root_planner, query)
        self.memory.ongoing = None if whole is None else OngoingPlan(query, whole)
        return whole

    def _prolonged(self, left: FullPlan, root_planner: RootPlanner, query: MotionQuery) -> FullPlan | None:
        """What is left of a walk that has become too short, and beyond that a new end; None if there is none."""
        near = self._horizon(query)
        far = near + self._spare(query)
        root = root_planner.plan(query.root, query.command, far, query.interval, query.time)
        if root.lost >= root_planner.settings.untroubled:
            return None
        shorter = root.along(root.path.until(near))
        return self._extended(left, root, query, Effort.QUICK) or self._extended(left, shorter, query, Effort.QUICK)

    def _spare(self, query: MotionQuery) -> int:
        return round(self.settings.spare / query.interval)

    def _extended(self, left: FullPlan, root: RootPlan, query: MotionQuery, effort: Effort) -> FullPlan | None:
        """What is left of a walk with a new end on a path that goes on from it; None if that has no way."""
        previous = settled(left, root.path, round(self.settings.revisited / root.path.interval))
        if previous is None:
            return None
        path = rest_of(root.path, previous.at)
        last = self.memory.recent.previous(path)
        rest = self._body.plan(path, previous.begins, last, query.others, effort, query.go_on)
        return extended(previous, rest, root) if rest.reached == path.horizon else None

    def _whole(self, left: FullPlan | None, root_planner: RootPlanner, query: MotionQuery) -> FullPlan:
        """A motion from where the avatar is; `left` is what is left of a walk that has no new end at first sight."""
        horizon = self._horizon(query)
        at = query.root, query.command, horizon, query.interval, query.time, self.settings.paces
        tried: list[_Tried] = []
        blocked_at = 0.0
        self.memory.attempts.begin()
        for root in root_planner.candidates(*at):
            if tried and _leads_nowhere_new(root, root_planner, blocked_at + _FARTHER):
                continue
            upper = self._dress(root.path, query, Effort.QUICK)
            if not tried and upper.reached < horizon and not query.hurry and self.memory.attempts.is_new(_place(upper)):
                refined = None
                if left is not None:
                    refined = self._extended(left, root, query, Effort.REFINED)
                if refined is not None:
                    self.memory.attempts.found()
                    return refined
                upper = self._dress(root.path, query, Effort.REFINED)
            if upper.reached == horizon:
                if not tried:
                    self.memory.attempts.found()
                cheaper = None if query.hurry else self._cheaper(root_planner, query, tried, root)
                return cheaper or FullPlan(root, upper.plan, upper.asked)
            tried.append(_Tried(root, upper))
            blocked_at = max(blocked_at, _way(root.path, min(upper.reached + 1, horizon)))
        found = None if query.hurry else self._thought_through(root_planner, query, tried)
        return found or self._stop(root_planner, query, tried)

    def _cheaper(
        self, root_planner: RootPlanner, query: MotionQuery, tried: "list[_Tried]", than: RootPlan
    ) -> FullPlan | None:
        """A path that costs much less than the one that was found, and on which all groups together have a way."""
        for root, _ in sorted(tried, key=lambda one: one.root.lost):
            if root.lost + _WORTH < than.lost:
                upper = self._dress(root.path, query, Effort.GLANCE)
                if upper.reached == root.path.horizon:
                    root_planner.follow(root)
                    return FullPlan(root, upper.plan, upper.asked)
        return None

    def _thought_through(self, root_planner: RootPlanner, query: MotionQuery, tried: "list[_Tried]") -> FullPlan | None:
        """A path on which all groups together have a way after all."""
        for number, effort in self.memory.attempts.efforts([one.upper.reached for one in tried]):
            root = tried[number].root
            upper = self._dress(root.path, query, effort)
            if upper.reached == root.path.horizon:
                root_planner.follow(root)
                return FullPlan(root, upper.plan, upper.asked)
        return None

    def _stop(self, root_planner: RootPlanner, query: MotionQuery, tried: "list[_Tried]") -> FullPlan:
        """Walk on while there is a way, then brake, and say why; or do what the last plan had in mind.

        Only if that is of no use either may the upper body begin as hard as it takes.
        """
        root, upper = max(tried, key=lambda one: one.upper.reached) if len(root_planner.moving) else tried[0]
        root_planner.follow(root)
        why = None if query.hurry else self._why(upper, query)
        whole, last = self._braked(root, upper.reached, root_planner, query), self.memory.recent.continued(query)
        if whole is None and (last is None or len(root_planner.moving)):
            whole = self._braked(root, upper.reached, root_planner, query, harsh=True)
        whole = whole or last or FullPlan(root, upper.plan)
        return whole._replace(local=whole.local._replace(blockade=why))

    def _braked(
        self, root: RootPlan, reached: int, root_planner: RootPlanner, query: MotionQuery, *, harsh: bool = False
    ) -> FullPlan | None:
        """The path of a root, braked as late as there is a way; the upper body came as far as `reached` on it."""
        brakings = [(moving, Effort.QUICK) for moving in _moving(reached)]
        brakings += [] if query.hurry else [(0, Effort.JOINT)]
        for moving, effort in brakings:
            states = root.path.states.copy()
            brake(states, moving, query.interval, root_planner.bounds)
            path = replace(root.path, states=states)
            stopping = self._dress(path, query, effort, harsh=harsh)
            if stopping.reached == path.horizon:
                kind = RootPlanKind.STOPPED if _way(path, path.horizon) < _STANDING else RootPlanKind.SHORTENED
                return FullPlan(root._replace(path=path, kind=kind), stopping.plan, stopping.asked)
        return None

    def _why(self, upper: UpperPlan, query: MotionQuery) -> Blockade | None:
        """Why there is no way; None as long as that is far off: most of it is solved when it has come nearer.

        On the way to a place that was asked about before it is the answer of then; one who has come to a stand asks
        anew. Near the end of a way it is now and then only the motion between free postures that touches: the earlier
        answer, which names obstacles, says more.
        """
        path, depth, last = upper.search.path, upper.search.blocked[1], self.memory.blockade
        place, moves = _place(upper), math.hypot(query.root.forward, query.root.lateral) > STILL
        near = last is not None and same_place(place, last.place)
        if moves and not near and depth * path.interval > _FAR_OFF:
            return None
        if last is not None and near and moves:
            why = replace(last, time=path.start_time + path.interval * depth, ahead=_way(path, depth))
        else:
            why = upper.search.blockade()
            if last is not None and near and why.kind is BlockadeKind.MOTION:
                why = replace(last, time=why.time, ahead=why.ahead)
        self.memory.blockade = why
        return why

    def _dress(self, path: RootPath, query: MotionQuery, effort: Effort, *, harsh: bool = False) -> UpperPlan:
        begins = Start(query.upper, query.velocity, harsh=harsh)
        return self._body.plan(path, begins, self.memory.recent.previous(path), query.others, effort, query.go_on)


def _is_commanded(whole: FullPlan, root_planner: RootPlanner) -> bool:
    """Whether a motion follows the path as commanded, and the upper body has a way along it."""
    return whole.asked is not None and whole.root.lost < root_planner.settings.untroubled


def _is_evasion(whole: FullPlan) -> bool:
    """Whether a motion leads aside of the path as commanded, or with the body turned, on a way that was found."""
    return whole.asked is not None and whole.root.kind is RootPlanKind.EVASION


def _place(upper: UpperPlan) -> tuple[float, float]:
    """Where the root is, x and z, at the key time that the upper body did not reach."""
    x, z = upper.search.path.states[upper.search.blocked[1], :2].tolist()
    return x, z


def _leads_nowhere_new(root: RootPlan, root_planner: RootPlanner, least: float) -> bool:
    """Whether a path along the same line is shorter than `least` metres, among things that stand still."""
    return (
        not len(root_planner.moving)
        and root.kind is not RootPlanKind.EVASION
        and _way(root.path, root.path.horizon) < least
    )


def _moving(reached: int) -> Iterator[int]:
    """Key frames at which to begin to brake, latest first; at last at once."""
    yield from (reached - earlier for earlier in _EARLIER if reached - earlier > 0)
    yield 0


def _way(path: RootPath, depth: int) -> float:
    """Metres walked until a key frame."""
    return float(np.linalg.norm(np.diff(path.states[: depth + 1, :2], axis=0), axis=1).sum())
