"""A plan that is still good is kept, and only its end is searched anew, together with what has come into view.

The last plan's motion is proven where it leads. If the root goes on as it was going to, among things that stand, its
first part can be played as it is. Its last part was planned for a world that ended there, so that part is left free: an
obstacle is reckoned with in every search from where it comes into view until it is that near.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.exact.kept import Asked, Start
from elbowroom.planning.exact.upper_body import UpperPlan
from elbowroom.planning.exact.whole import Whole, key_at
from elbowroom.planning.motion import MotionQuery
from elbowroom.planning.root_path import RootPath
from elbowroom.planning.root_plan import RootPlan

Floats = NDArray[np.float64]

_SAME = 1e-9  # radians, metres


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


def settled(last: Whole | None, path: RootPath, query: MotionQuery, free: int) -> Settled | None:
    """What of the last plan can be kept on a path, of which the last `free` key intervals are searched anew."""
    at = path.horizon - free
    first = None if last is None else key_at(last, path)
    if last is None or first is None or at < 1 or last.asked is None:
        return None
    rows, velocities = slice(first, first + at + 1), last.local.velocities
    if velocities is None:
        return None
    kept = Settled(at, last.local.configurations[rows], velocities[rows], last.local.goals[rows], last.asked)
    if len(kept.configurations) <= at or not np.array_equal(last.root.path.states[rows], path.states[: at + 1]):
        return None
    apart = max(_apart(kept.configurations[0], query.upper), _apart(kept.velocities[0], query.velocity))
    return kept._replace(asked=last.asked.since(first, path.horizon)) if apart <= _SAME else None


def rest_of(path: RootPath, at: int) -> RootPath:
    """A path from one of its key times on."""
    return RootPath(float(path.times[at]), path.interval, path.states[at:])


def prolonged(kept: Settled, rest: UpperPlan, root: RootPlan) -> Whole:
    """What was kept, and the rest that was found."""
    at, plan = kept.at, rest.plan
    assert plan.velocities is not None
    assert rest.asked is not None
    local = replace(
        plan,
        configurations=np.concatenate([kept.configurations[:at], plan.configurations]),
        velocities=np.concatenate([kept.velocities[:at], plan.velocities]),
        goals=np.concatenate([kept.goals[:at], plan.goals]),
    )
    return Whole(root, local, kept.asked.then(at, rest.asked))


def _apart(a: Floats, b: Floats) -> float:
    return float(np.abs(a - b).max())
