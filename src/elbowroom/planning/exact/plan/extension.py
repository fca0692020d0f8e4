"""A plan that is still good is kept, and only its end is searched anew, together with what has come into view.

A plan's motion is proven where it leads. While the user wants the same, among things that stand, it is played as it is,
and nothing is planned until it gets shorter than the look-ahead. Then it is made longer. Its last part was planned for
a world that ended there, so that part is left free: an obstacle is reckoned with from where it comes into view, and
what was planned for it can be bettered until it is that near.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.exact.memory.previous_plan import RequiredMargins, StartState
from elbowroom.planning.exact.plan.full_plan import FullPlan
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.plan.upper_body_search import Effort, UpperPlan
from elbowroom.planning.motion import MotionQuery
from elbowroom.planning.result import LocalPlan
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan
from elbowroom.planning.stillness import SAME

Floats = NDArray[np.float64]


class Settled(NamedTuple):
    """The first part of the last plan, from now on, that the next one has too."""

    at: int  # key intervals
    configurations: Floats  # (at+1, LOCAL)
    velocities: Floats  # (at+1, LOCAL)
    goals: Floats  # (at+1, LOCAL)
    margins: RequiredMargins  # over more than these intervals

    @property
    def begins(self) -> StartState:
        """Where the rest begins."""
        return StartState(self.configurations[-1], self.velocities[-1], self.at)


def settled(left: FullPlan, path: RootPath, free: int) -> Settled | None:
    """What is kept, of what is `left` of a plan, on a path of which the last `free` key intervals are searched anew."""
    at, local = path.horizon - free, left.local
    if not 0 < at < len(local.configurations) or local.velocities is None or left.margins is None:
        return None
    if np.abs(left.root.path.states[: at + 1] - path.states[: at + 1]).max() > SAME:
        return None
    rows = slice(at + 1)
    return Settled(at, local.configurations[rows], local.velocities[rows], local.goals[rows], left.margins)


def rest_of(path: RootPath, at: int) -> RootPath:
    """A path from one of its key times on."""
    return RootPath(path.time_of(at), path.interval, path.states[at:])


def extended(previous: Settled, rest: UpperPlan, root: RootPlan) -> FullPlan:
    """What was kept, and the rest that was found."""
    at, plan = previous.at, rest.plan
    assert plan.velocities is not None
    assert rest.margins is not None
    keys = np.concatenate([previous.configurations[:at], plan.configurations])
    velocities = np.concatenate([previous.velocities[:at], plan.velocities])
    goals = np.concatenate([previous.goals[:at], plan.goals])
    local = LocalPlan(plan.status, keys, goals, plan.evidence, plan.joint, plan.blockade, velocities)
    return FullPlan(root, local, previous.margins.then(at, rest.margins), leads_on=True)


def prolonged(
    body: UpperBodyPlanner, left: FullPlan, root: RootPlan, query: MotionQuery, effort: Effort
) -> tuple[FullPlan | None, int]:
    """What is left of a walk with a new end on a root path that goes on from it; None if there is none.

    And the key time of that path that all groups reached.
    """
    previous = settled(left, root.path, round(body.settings.revisited / root.path.interval))
    if previous is None:
        return None, 0
    path = rest_of(root.path, previous.at)
    rest = body.plan(path, previous.begins, body.memory.recent.previous(path), query.others, effort, query.go_on)
    found = extended(previous, rest, root) if rest.reached == path.horizon else None
    return found, previous.at + rest.reached
