"""The last plans: what the next one may keep to, or go on with."""

import math

import numpy as np

from elbowroom.planning.exact.memory.previous_plan import PreviousPlan
from elbowroom.planning.exact.plan.full_plan import FullPlan, later, previous_of
from elbowroom.planning.motion import MotionQuery
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan
from elbowroom.planning.stillness import SAME, UNMOVED

_PAST = 3  # plans before the last one
_SAME_TIME = 1e-6  # of a key interval


class RecentPlans:
    """The last plan, and what was shown before it.

    Plans may begin a little ahead: who changes the wish before that is still in an earlier one.
    """

    def __init__(self) -> None:
        self._last: FullPlan | None = None
        self._past: tuple[FullPlan, ...] = ()

    def take(self, whole: FullPlan) -> None:
        """Remember a plan as the last one."""
        if self._last is not None:
            self._past = (*self._past[1 - _PAST :], self._last)
        self._last = whole

    def since(self, time: float) -> FullPlan | None:
        """The last plan, with what is shown before it if it begins later than `time`."""
        whole = self._last
        for earlier in reversed(self._past):
            if whole is None or whole.root.path.start_time <= time:
                break
            whole = after(earlier, whole)
        return whole

    def previous(self, path: RootPath) -> PreviousPlan | None:
        """What the last plan had at the key times of `path`, if it has any of them."""
        last = self.since(path.start_time)
        return None if last is None else previous_of(last, path)

    def continued(self, query: MotionQuery) -> FullPlan | None:
        """What is left of the last plan, if it led to where this one starts."""
        last = self.since(query.time)
        if last is None or not len(last.local.configurations):
            return None
        path = last.root.path
        at = round((query.time - path.start_time) / query.interval)
        if not 0 <= at < len(path.states) - 1 or not np.abs(path.states[at] - query.root.as_array()).max() <= SAME:
            return None
        left = later(last, at)
        return left._replace(root=left.root.ended(left.root.path))

    def ahead(self, query: MotionQuery) -> RootPlan | None:
        """The way that is left of the last plan, if it leads through where this one starts, at a key time or not."""
        last = self.since(query.time)
        if last is None:
            return None
        path = last.root.path
        horizon = math.floor((path.times[-1] - query.time) / query.interval + _SAME_TIME)
        here = path.sample([query.time])[0]
        if horizon < 1 or np.abs(here - query.root.as_array()).max() > UNMOVED:
            return None
        states = path.sample(query.time + query.interval * np.arange(horizon + 1.0))
        states[0] = query.root.as_array()
        left = RootPath(query.time, query.interval, states)
        return last.root.going_on(left).ended(left)


def after(earlier: FullPlan, whole: FullPlan) -> FullPlan:
    """A motion with what is shown before it, if it goes on from an `earlier` one at one of its key times."""
    path, local = whole.root.path, whole.local
    if earlier.margins is None or whole.margins is None:
        return whole
    known, rows = earlier.root.path, earlier.local.configurations
    velocities, speeds = earlier.local.velocities, local.velocities
    at = round((path.start_time - known.start_time) / known.interval)
    apart = abs(known.start_time + at * known.interval - path.start_time)
    if velocities is None or speeds is None or not 0 < at < len(rows):
        return whole
    there, here = (known.states[at], rows[at], velocities[at]), (path.states[0], local.configurations[0], speeds[0])
    if apart > _SAME_TIME * path.interval or any(np.abs(a - b).max() > SAME for a, b in zip(there, here, strict=True)):
        return whole
    joined = local._replace(
        configurations=np.concatenate([rows[:at], local.configurations]),
        goals=np.concatenate([earlier.local.goals[:at], local.goals]),
        velocities=np.concatenate([velocities[:at], speeds]),
    )
    states = np.concatenate([known.states[:at], path.states])
    longer = whole.root.along(RootPath(known.start_time, known.interval, states))
    return FullPlan(longer, joined, earlier.margins.then(at, whole.margins))
