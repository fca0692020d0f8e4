"""What the upper body is asked for along one root path, and each group's part of it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL_GROUPS, DofGroup, columns_of
from elbowroom.planning.exact.group.caches import PlanCaches
from elbowroom.planning.exact.group.problem import GroupTask
from elbowroom.planning.exact.joint.guide import Guide
from elbowroom.planning.exact.lattice.lattice import EXTRA
from elbowroom.planning.exact.memory.previous_plan import PreviousPlan, RequiredMargins, StartState
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.along import Along

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

_NONE = np.zeros((0, 0), np.float32)  # of one who only asks for the postures of key times alone


class PathProblem(NamedTuple):
    """One root path to be dressed."""

    path: RootPath
    goals: Floats  # (n+1, 11)
    last: PreviousPlan | None  # the last plan
    previous: Floats  # (n+1, 11) what it had, its end where it did not reach; the goals if there was none
    begins: StartState
    roots: Longs  # (n,) slots of the root ways
    near: Along
    anew: RequiredMargins  # clearances that are asked for, apart from what the last plan was allowed
    required: RequiredMargins  # with that

    @staticmethod
    def of(
        path: RootPath,
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
            return PathProblem(path, goals, None, goals, begins, roots, near, anew, anew)
        reached = last.known if begins.ahead else len(goals)
        previous = np.concatenate([last.keys[:reached], goals[reached:]])
        return PathProblem(path, goals, last, previous, begins, roots, near, anew, anew.beside(last.required))

    def task(
        self, group: DofGroup, carriers: Longs, extra: Floats32 | None = None, follow: Guide | None = None
    ) -> GroupTask:
        """What one group has to do, on carriers' ways in the slots `carriers` (n,).

        `extra` (n+1, W+OWN) is added to the prices of its nodes; it may `follow` a guide, which has prices of its own.
        """
        at, number, begins = columns_of(group), LOCAL_GROUPS.index(group), self.begins
        previous = self.previous[:, at] if follow is None else follow.keys
        own = _NONE if extra is None else extra
        costs = own if follow is None else follow.extra if extra is None else follow.extra + own
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
    """Nothing (n+1, W+OWN) to be added to the prices of a group's nodes."""
    return np.zeros((horizon + 1, caches.group(group).postures.moves.shape[1] + EXTRA), np.float32)
