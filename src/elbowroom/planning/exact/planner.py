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
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.exact.upper_body import UpperBody, UpperPlan
from elbowroom.planning.motion import Motion, MotionQuery
from elbowroom.planning.result import Blockade, BlockadeKind, LocalPlan
from elbowroom.planning.root_motion import brake
from elbowroom.planning.root_path import RootPath
from elbowroom.planning.root_plan import RootPlan, RootPlanKind
from elbowroom.planning.root_planner import RootPlanner
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

_EARLIER = (1, 2, 3, 5, 8, 13)  # key frames before the one that has no way, at which braking is tried
_FARTHER = 0.05  # metres that a slower way must get beyond the place where a faster one failed
_SAME_PLACE = 0.3  # metres: blocked places that are taken for one
_STANDING = 0.02  # metres: a path that is shorter stands


class _Whole(NamedTuple):
    """A motion over the whole look-ahead."""

    root: RootPlan
    local: LocalPlan


class ExactPlanner:
    """Plans motion for one humanoid in one scene; it remembers the last plan and keeps to it while it is good."""

    def __init__(
        self, humanoid: Humanoid, scene: Scene, settings: ExactSettings | None = None, motions: MotionSet = STOCK
    ) -> None:
        self.settings = settings or ExactSettings()
        self._body = UpperBody(humanoid, scene, self.settings, motions)
        self._last: _Whole | None = None
        self._blockade: Blockade | None = None

    def reset(self) -> None:
        """Forget the last plan and the postures that were added."""
        self._last = self._blockade = None
        self._body.reset()

    def plan(self, path: RootPath, start: Floats, rng: np.random.Generator) -> LocalPlan:
        """Motion along `path` that begins at rest at `start` (11,); nothing is left to chance."""
        del rng
        return self._body.plan(path, start, np.zeros_like(start)).plan

    def plan_motion(self, root_planner: RootPlanner, query: MotionQuery) -> Motion:
        """Motion for the next `query.horizon` key frames, the first part of a plan over the whole look-ahead."""
        whole = self._whole(root_planner, query)
        self._last = whole
        return _first_part(whole, query.horizon)

    def _whole(self, root_planner: RootPlanner, query: MotionQuery) -> _Whole:
        horizon = max(query.horizon, round(self.settings.look_ahead / query.interval))
        first: tuple[RootPlan, UpperPlan] | None = None
        blocked_at = 0.0
        at = query.root, query.command, horizon, query.interval, query.time, self.settings.paces
        for root in root_planner.candidates(*at):
            if (
                first is not None
                and not len(root_planner.moving)
                and root.kind is not RootPlanKind.EVASION
                and _way(root.path, horizon) < blocked_at + _FARTHER
            ):
                continue
            upper = self._dress(root.path, query, refine=first is None)
            if upper.reached == horizon:
                return _Whole(root, upper.plan)
            if first is None or (len(root_planner.moving) and upper.reached > first[1].reached):
                first = root, upper
            blocked_at = max(blocked_at, _way(root.path, min(upper.reached + 1, horizon)))
        assert first is not None
        return self._stop(root_planner, query, *first)

    def _stop(self, root_planner: RootPlanner, query: MotionQuery, root: RootPlan, upper: UpperPlan) -> _Whole:
        """Walk on while there is a way, then brake, and say why; or do what the last plan had in mind."""
        why = self._why(upper)
        for moving in _moving(upper.reached):
            states = root.path.states.copy()
            brake(states, moving, query.interval, root_planner.bounds)
            path = replace(root.path, states=states)
            stopping = self._dress(path, query)
            if stopping.reached == path.horizon:
                kind = RootPlanKind.STOPPED if _way(path, path.horizon) < _STANDING else RootPlanKind.SHORTENED
                return _Whole(replace(root, path=path, kind=kind), replace(stopping.plan, blockade=why))
        whole = self._continued(query) or _Whole(root, upper.plan)
        return whole._replace(local=replace(whole.local, blockade=why))

    def _continued(self, query: MotionQuery) -> _Whole | None:
        """What is left of the last plan, if it led to where this one starts."""
        if self._last is None or not len(self._last.local.configurations):
            return None
        root, local = self._last
        at = round((query.time - root.path.start_time) / query.interval)
        if not 0 <= at < len(root.path.states) - 1 or not np.allclose(root.path.states[at], query.root, atol=1e-9):
            return None
        path = RootPath(query.time, query.interval, root.path.states[at:])
        rest = _part(local, slice(at, None))
        return _Whole(replace(root, path=path, kind=RootPlanKind.SHORTENED), rest)

    def _why(self, upper: UpperPlan) -> Blockade:
        """Why there is no way; an earlier answer for the same place where this one names no obstacles.

        Near the end of a way it is now and then only the motion between free postures that touches.
        """
        why, last = upper.dressing.blockade(), self._blockade
        if why.kind is BlockadeKind.MOTION and last is not None and math.dist(why.place, last.place) < _SAME_PLACE:
            why = replace(last, ahead=why.ahead)
        self._blockade = why
        return why

    def _dress(self, path: RootPath, query: MotionQuery, *, refine: bool = False) -> UpperPlan:
        return self._body.plan(path, query.upper, query.velocity, self._kept(path), query.others, refine=refine)

    def _kept(self, path: RootPath) -> Floats | None:
        """What the last plan had at the key times of `path` (n+1, 11), if it has any of them."""
        if self._last is None or not len(self._last.local.configurations):
            return None
        last = self._last.root.path
        at = (path.start_time - last.start_time) / path.interval
        known = self._last.local.configurations
        if path.interval != last.interval or abs(at - round(at)) > 1e-6 or not 0 <= round(at) < len(known):
            return None
        kept: Floats = known[np.minimum(round(at) + np.arange(len(path.states)), len(known) - 1)]
        return kept


def _moving(reached: int) -> Iterator[int]:
    """Key frames at which to begin to brake, latest first; at last at once."""
    yield from (reached - earlier for earlier in _EARLIER if reached - earlier > 0)
    yield 0


def _way(path: RootPath, depth: int) -> float:
    """Metres walked until a key frame."""
    return float(np.linalg.norm(np.diff(path.states[: depth + 1, :2], axis=0), axis=1).sum())


def _first_part(whole: _Whole, horizon: int) -> Motion:
    """The first `horizon` key intervals."""
    path, local = whole.root.path, whole.local
    shown = replace(path, states=path.states[: horizon + 1])
    return Motion(replace(whole.root, path=shown), _part(local, slice(horizon + 1)))


def _part(local: LocalPlan, rows: slice) -> LocalPlan:
    """Some key times of a plan."""
    velocities = None if local.velocities is None else local.velocities[rows]
    return replace(local, configurations=local.configurations[rows], goals=local.goals[rows], velocities=velocities)
