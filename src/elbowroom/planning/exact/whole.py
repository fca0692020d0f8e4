"""A motion over the whole look-ahead: what is handed over of it, and when it answers a later query too."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from elbowroom.planning.exact.kept import Asked
from elbowroom.planning.motion import Motion, MotionQuery
from elbowroom.planning.result import GroupEvidence, LocalPlan
from elbowroom.planning.root_path import RootPath
from elbowroom.planning.root_plan import RootPlan


class Whole(NamedTuple):
    """A motion over the whole look-ahead."""

    root: RootPlan
    local: LocalPlan
    asked: Asked | None = None  # None: not a way that was found


def key_at(whole: Whole, path: RootPath) -> int | None:
    """Which of a motion's key times a path begins at; None if it is none of them."""
    known = whole.root.path
    at = (path.start_time - known.start_time) / path.interval
    if path.interval != known.interval or abs(at - round(at)) > 1e-6:
        return None
    return round(at) if 0 <= round(at) < len(whole.local.configurations) else None


def first_part(whole: Whole, horizon: int) -> Motion:
    """The first `horizon` key intervals."""
    path, local = whole.root.path, whole.local
    shown = replace(path, states=path.states[: horizon + 1])
    return Motion(replace(whole.root, path=shown), part(local, slice(horizon + 1)))


def part(local: LocalPlan, rows: slice) -> LocalPlan:
    """Some key times of a plan."""
    velocities = None if local.velocities is None else local.velocities[rows]
    return replace(local, configurations=local.configurations[rows], goals=local.goals[rows], velocities=velocities)


def later(whole: Whole, at: int) -> Whole:
    """What is left of a motion from its key time `at` on, for which nothing was searched."""
    root, local, asked = whole
    path = RootPath(float(root.path.times[at]), root.path.interval, root.path.states[at:])
    rest = part(replace(local, evidence=_free_of_charge(local), joint=None), slice(at, None))
    asked = None if asked is None else asked.since(at, path.horizon)
    return Whole(replace(root, path=path, checks=0, nanoseconds=0), rest, asked)


def _free_of_charge(local: LocalPlan) -> tuple[GroupEvidence, ...]:
    return tuple(replace(row, checks=0, nodes=0, enhanced=0, nanoseconds=0) for row in local.evidence)


class Stand(NamedTuple):
    """The answer to a query of one who stands and goes on standing: asked the same again, it would be the same."""

    query: MotionQuery
    versions: tuple[int, ...]  # of the posture sets
    whole: Whole
    left: int  # paths that have not had their turn to be thought through

    def answers(self, query: MotionQuery, versions: tuple[int, ...]) -> bool:
        """Whether this is the answer to `query` too."""
        known, asked = self.query, query
        same = known.root == asked.root and known.command == asked.command and versions == self.versions
        same &= known.horizon == asked.horizon and known.interval == asked.interval
        return same and bool(
            np.array_equal(known.upper, asked.upper) and np.array_equal(known.velocity, asked.velocity)
        )

    def at(self, time: float) -> Whole:
        """The answer at another time, for which nothing was searched."""
        root, local = self.whole.root, self.whole.local
        passed = time - self.query.time
        why = None if local.blockade is None else replace(local.blockade, time=local.blockade.time + passed)
        path = replace(root.path, start_time=time)
        return Whole(
            replace(root, path=path, checks=0, nanoseconds=0),
            replace(local, evidence=_free_of_charge(local), joint=None, blockade=why),
            self.whole.asked,
        )


def stands(whole: Whole, query: MotionQuery) -> bool:
    """Whether a plan leaves all as it is."""
    still = not np.any(whole.root.path.states[:, 3:6]) and not np.any(query.velocity)
    return still and bool((whole.local.configurations == query.upper).all())
