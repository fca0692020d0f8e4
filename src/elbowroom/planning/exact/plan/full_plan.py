"""A motion over the whole look-ahead: what is handed over of it, and when it answers a later query too."""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.memory.previous_plan import PreviousPlan, RequiredMargins
from elbowroom.planning.interpolation import hermite
from elbowroom.planning.motion import Motion, MotionQuery
from elbowroom.planning.result import GroupEvidence, JointEvidence, LocalPlan, PlanStatus
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan
from elbowroom.planning.stillness import STILL, UNMOVED, is_still

Floats = NDArray[np.float64]

_SAME = 1e-6  # of a key interval


class FullPlan(NamedTuple):
    """A motion over the whole look-ahead."""

    root: RootPlan
    local: LocalPlan
    margins: RequiredMargins | None = None  # that it was found with; None: it was not found as a whole
    leads_on: bool = False  # whether it leads along a whole root path, and is not braked before its end


def previous_of(whole: FullPlan, path: RootPath) -> PreviousPlan | None:
    """What a motion has at the key times of a path, if it has any; between its own key times it is on its curve."""
    known, keys, velocities = whole.root.path, whole.local.configurations, whole.local.velocities
    at = (path.start_time - known.start_time) / known.interval
    first, last = math.floor(at + _SAME), len(keys) - 1
    if velocities is None or whole.margins is None or not 0 <= first <= last:
        return None
    margins, share = whole.margins.since(first, path.horizon), at - first
    rows = np.minimum(first + np.arange(len(path.states)), last)
    if share < _SAME:
        return PreviousPlan(keys[rows], len(keys) - first, margins)
    span, later = np.array([0.0, known.interval]), whole.margins.since(first + 1, path.horizon)
    between = [
        hermite(span, keys[k : k + 2], velocities[k : k + 2], share * known.interval)[0] if k < last else keys[last]
        for k in rows
    ]
    return PreviousPlan(np.array(between), last - first, margins.beside(later))


def first_part(whole: FullPlan, horizon: int) -> Motion:
    """The first `horizon` key intervals."""
    root, local = whole.root, whole.local
    return Motion(root.along(root.path.until(horizon)), part(local, slice(horizon + 1), local.evidence, local.joint))


def part(
    local: LocalPlan, rows: slice, evidence: tuple[GroupEvidence, ...], joint: JointEvidence | None = None
) -> LocalPlan:
    """Some key times of a plan, and what they cost."""
    velocities = None if local.velocities is None else local.velocities[rows]
    keys, goals = local.configurations[rows], local.goals[rows]
    return LocalPlan(local.status, keys, goals, evidence, joint, local.blockade, velocities)


def later(whole: FullPlan, at: int) -> FullPlan:
    """What is left of a motion from its key time `at` on, for which nothing was searched."""
    root, local, margins, _ = whole
    path = RootPath(root.path.time_of(at), root.path.interval, root.path.states[at:])
    rest = part(local, slice(at, None), _free_of_charge(local))
    margins = None if margins is None else margins.since(at, path.horizon)
    return FullPlan(root.going_on(path), rest, margins, whole.leads_on)


def kept_after(kept: FullPlan, tried: FullPlan) -> FullPlan:
    """A motion that is kept after another was tried in its place: it costs what was tried."""
    root = kept.root._replace(checks=tried.root.checks, nanoseconds=tried.root.nanoseconds)
    local = kept.local._replace(evidence=tried.local.evidence, joint=tried.local.joint)
    return kept._replace(root=root, local=local)


def _free_of_charge(local: LocalPlan) -> tuple[GroupEvidence, ...]:
    return tuple(GroupEvidence(row.group, row.status, 0, 0, 0, 0) for row in local.evidence)


class StandingPlan(NamedTuple):
    """The answer to a query of one who stands and goes on standing: asked the same again, it would be the same."""

    query: MotionQuery
    whole: FullPlan
    final: bool  # whether all was tried

    def answers(self, query: MotionQuery) -> bool:
        """Whether `query` is the one that this answered, asked later."""
        known, asked = self.query, query
        if known.command != asked.command or known.horizon != asked.horizon:
            return False
        pairs = (
            (known.root.as_array(), asked.root.as_array()),
            (known.upper, asked.upper),
            (known.velocity, asked.velocity),
        )
        apart = max(float(np.abs(one - other).max()) for one, other in pairs)
        return apart < UNMOVED

    def at(self, time: float) -> FullPlan:
        """The answer at another time, for which nothing was searched."""
        root, local = self.whole.root, self.whole.local
        passed = time - self.query.time
        why = None if local.blockade is None else replace(local.blockade, time=local.blockade.time + passed)
        path = replace(root.path, start_time=time)
        return FullPlan(
            root.going_on(path),
            local._replace(evidence=_free_of_charge(local), joint=None, blockade=why),
            self.whole.margins,
        )


def stands(whole: FullPlan, query: MotionQuery) -> bool:
    """Whether a plan leaves all as it is: it says so, or there is no motion in it for one who stands."""
    if whole.local.status is not PlanStatus.FOUND:
        return is_still(query.root.as_array()[3:6]) and is_still(query.velocity)
    return _stays(whole.root.path.states, whole.local.configurations, query.upper, query.velocity)


@exact_kernel
def _stays(states: Floats, uppers: Floats, upper: Floats, velocity: Floats) -> bool:
    """Whether root states (n+1, 7) are at rest, and `uppers` (n+1, LOCAL) where an `upper` body is at rest already."""
    fastest, farthest = 0.0, 0.0
    for t in range(states.shape[0]):
        for i in range(3, 6):
            fastest = max(fastest, abs(states[t, i]))
    for j in range(upper.shape[0]):
        fastest = max(fastest, abs(velocity[j]))
        for t in range(uppers.shape[0]):
            farthest = max(farthest, abs(uppers[t, j] - upper[j]))
    return bool(fastest < STILL and farthest < UNMOVED)
