"""A plan that is still good is kept, and only its end is searched anew, together with what has come into view.

A plan's motion is proven where it leads. While the user wants the same, among things that stand, it is played as it is,
and nothing is planned until it gets shorter than the look-ahead. Then it is made longer. Its last part was planned for
a world that ended there, so that part is left free: an obstacle is reckoned with from where it comes into view, and
what was planned for it can be bettered until it is that near.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.memory.previous_plan import Asked, Start
from elbowroom.planning.exact.plan.full_plan import FullPlan, later
from elbowroom.planning.exact.plan.upper_body_search import UpperPlan
from elbowroom.planning.motion import MotionQuery
from elbowroom.planning.result import LocalPlan
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan
from elbowroom.planning.stillness import SAME, SAME_TIME

Floats = NDArray[np.float64]


class Settled(NamedTuple):
    """The first part of the last plan, from now on, that the next one has too."""

    at: int  # key intervals
    configurations: Floats  # (at+1, 11)
    velocities: Floats  # (at+1, 11)
    goals: Floats  # (at+1, 11)
    asked: Asked  # over more than these intervals

    @property
    def begins(self) -> Start:
        """Where the rest begins."""
        return Start(self.configurations[-1], self.velocities[-1], self.at)


def settled(left: FullPlan, path: RootPath, free: int) -> Settled | None:
    """What is kept, of what is `left` of a plan, on a path of which the last `free` key intervals are searched anew."""
    at, local = path.horizon - free, left.local
    if not 0 < at < len(local.configurations) or local.velocities is None or left.asked is None:
        return None
    if np.abs(left.root.path.states[: at + 1] - path.states[: at + 1]).max() > SAME:
        return None
    rows = slice(at + 1)
    return Settled(at, local.configurations[rows], local.velocities[rows], local.goals[rows], left.asked)


def rest_of(path: RootPath, at: int) -> RootPath:
    """A path from one of its key times on."""
    return RootPath(path.time_of(at), path.interval, path.states[at:])


def extended(previous: Settled, rest: UpperPlan, root: RootPlan) -> FullPlan:
    """What was kept, and the rest that was found."""
    at, plan = previous.at, rest.plan
    assert plan.velocities is not None
    assert rest.asked is not None
    keys = np.concatenate([previous.configurations[:at], plan.configurations])
    velocities = np.concatenate([previous.velocities[:at], plan.velocities])
    goals = np.concatenate([previous.goals[:at], plan.goals])
    local = LocalPlan(plan.status, keys, goals, plan.evidence, plan.joint, plan.blockade, velocities)
    return FullPlan(root, local, previous.asked.then(at, rest.asked))


class OngoingPlan(NamedTuple):
    """A plan that answered a query with the path as commanded: who is asked to walk on does as planned."""

    query: MotionQuery
    whole: FullPlan

    def left(self, query: MotionQuery) -> FullPlan | None:
        """What is left of it at a later query, if that goes on from where the plan leads, and wants the same."""
        known, whole = self.query, self.whole
        at = round((query.time - known.time) / query.interval)
        local = whole.local
        if known.command != query.command or local.velocities is None:
            return None
        if not 0 <= at < len(local.configurations) or abs(query.time - whole.root.path.time_of(at)) > SAME_TIME:
            return None
        keys = whole.root.path.states, local.configurations, local.velocities
        return later(whole, at) if leads_to(*keys, at, query.root.as_array(), query.upper, query.velocity) else None


@exact_kernel
def leads_to(
    states: Floats, uppers: Floats, rates: Floats, at: int, state: Floats, upper: Floats, rate: Floats
) -> bool:
    """Whether a motion has the root `state` (7,), the `upper` body (11,) and its `rate` (11,) at its key time `at`.

    It leads through root states (n+1, 7) and `uppers` (n+1, 11) with `rates` (n+1, 11).
    """
    apart = 0.0
    for i in range(state.shape[0]):
        apart = max(apart, abs(states[at, i] - state[i]))
    for i in range(upper.shape[0]):
        apart = max(apart, abs(uppers[at, i] - upper[i]), abs(rates[at, i] - rate[i]))
    return apart <= SAME
