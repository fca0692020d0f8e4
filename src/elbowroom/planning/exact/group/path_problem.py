"""What the upper body is asked for along one root path, and each group's part of it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import SEARCH_ORDER, DofGroup, columns_of
from elbowroom.planning.carried import carried
from elbowroom.planning.exact.group.caches import PlanCaches
from elbowroom.planning.exact.group.problem import GroupTask, Guide
from elbowroom.planning.exact.lattice.lattice import EXTRA
from elbowroom.planning.exact.memory.previous_plan import PreviousPlan, RequiredMargins, StartState
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.tracks.along import Along

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

_NONE = np.zeros((0, 0), np.float32)  # where only the extra nodes are asked for


class PathProblem(NamedTuple):
    """What the upper body is asked for along one root path."""

    path: RootPath
    walk: Floats  # (n+1, LOCAL) the natural walk: in that no part of the body is too deep in another
    goals: Floats  # (n+1, LOCAL) what is liked here
    last: PreviousPlan | None  # the last plan
    previous: Floats  # (n+1, LOCAL) what it had, its end where it did not reach; the goals if there was none
    begins: StartState
    roots: Longs  # (n,) cache entries of the root's sweeps
    near: Along  # the obstacles
    anew: RequiredMargins  # clearances that are asked for, whatever the last plan was allowed
    required: RequiredMargins  # the same, less where the last plan was allowed less

    @staticmethod
    def of(
        path: RootPath,
        walk: Floats,
        goals: Floats,
        last: PreviousPlan | None,
        begins: StartState,
        roots: Longs,
        near: Along,
        anew: RequiredMargins,
    ) -> "PathProblem":
        """What is asked for on a path among what is `near`, in view of the `last` plan.

        One who goes on from the last plan has other postures to end with.
        """
        if last is None:
            return PathProblem(path, walk, goals, None, goals, begins, roots, near, anew, anew)
        reached = last.known if begins.ahead else len(goals)
        previous = np.concatenate([last.keys[:reached], goals[reached:]])
        return PathProblem(path, walk, goals, last, previous, begins, roots, near, anew, anew.beside(last.required))

    def under(self, waists: Floats) -> "PathProblem":
        """The same with what head and arms would like under a path of the waist (n+1, 3)."""
        return self._replace(goals=carried(self.goals, waists))

    def task(
        self, group: DofGroup, carriers: Longs, added: Floats32 | None = None, follow: Guide | None = None
    ) -> GroupTask:
        """What one group has to do on its carriers' sweeps, cache entries `carriers` (n,).

        `added` (n+1, W+EXTRA) is added to the costs of its nodes; it may `follow` a guide, which adds costs too.
        """
        at, number, begins = columns_of(group), SEARCH_ORDER.index(group), self.begins
        previous = self.previous[:, at] if follow is None else follow.keys
        own = _NONE if added is None else added
        costs = own if follow is None else follow.added if added is None else follow.added + own
        return GroupTask(
            np.ascontiguousarray(self.goals[:, at]),
            np.ascontiguousarray(previous),
            begins.upper[at],
            begins.velocity[at],
            self.required.margins[number],
            self.required.motion_margins[number],
            costs,
            self.roots,
            carriers,
            self.near.spans,
            self.path.interval,
            begins.harsh,
            begins.ahead > 0,
        )


def no_costs(caches: PlanCaches, group: DofGroup, horizon: int) -> Floats32:
    """Zeros (n+1, W+EXTRA), to be added to the costs of a group's nodes."""
    return np.zeros((horizon + 1, caches.group(group).postures.moves.shape[1] + EXTRA), np.float32)
