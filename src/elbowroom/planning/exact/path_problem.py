"""What the upper body is asked for along one root path, and each group's part of it."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL_GROUPS, DofGroup, columns_of
from elbowroom.planning.exact.group import GroupTask
from elbowroom.planning.exact.kept import Kept, Start
from elbowroom.planning.exact.lattice import OWN
from elbowroom.planning.exact.near_boxes import NearBoxes
from elbowroom.planning.exact.shelves import Shelves
from elbowroom.planning.exact.together import Guide
from elbowroom.planning.root_path import RootPath

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

_NONE = np.zeros((0, 0), np.float32)  # of one who only asks for the postures of key times alone


@dataclass(frozen=True, eq=False)
class PathProblem:
    """One root path to be dressed."""

    path: RootPath
    goals: Floats  # (n+1, 11)
    last: Kept | None  # the last plan
    begins: Start
    roots: Longs  # (n,) slots of the root ways
    near: NearBoxes
    margins: Floats  # (n+1,) clearances of postures, metres, and
    skins: Floats  # (n,) of the motion in each interval, apart from what the last plan was allowed

    @cached_property
    def kept(self) -> Floats:
        """What the last plan had (n+1, 11), its end where it did not reach; the goals if there was none.

        One who goes on from the last plan has other postures to end with.
        """
        if self.last is None:
            return self.goals
        reached = self.last.known if self.begins.ahead else len(self.goals)
        return np.concatenate([self.last.keys[:reached], self.goals[reached:]])

    @cached_property
    def asked_margins(self) -> Floats:
        """The clearances (3, n+1) of each group's postures; what the last plan was allowed stays allowed."""
        return _thrice(self.margins) if self.last is None else np.minimum(self.margins, self.last.asked.margins)

    @cached_property
    def asked_skins(self) -> Floats:
        """The clearances (3, n) of each group's motion."""
        return _thrice(self.skins) if self.last is None else np.minimum(self.skins, self.last.asked.skins)

    def task(
        self, group: DofGroup, carriers: Longs, extra: Floats32 | None = None, follow: Guide | None = None
    ) -> GroupTask:
        """What one group has to do, on carriers' ways in the slots `carriers` (n,).

        `extra` (n+1, W+OWN) is added to the prices of its nodes; it may `follow` a guide, which has prices of its own.
        """
        at, number, begins = columns_of(group), LOCAL_GROUPS.index(group), self.begins
        kept = self.kept[:, at] if follow is None else follow.keys
        own = _NONE if extra is None else extra
        prices = own if follow is None else follow.extra if extra is None else follow.extra + own
        return GroupTask(
            np.ascontiguousarray(self.goals[:, at]), np.ascontiguousarray(kept), begins.upper[at], begins.velocity[at],
            self.asked_margins[number], self.asked_skins[number], prices, self.roots, carriers,
            self.near.intervals, self.path.interval, begins.harsh, begins.ahead > 0,
        )  # fmt: skip


def _thrice(row: Floats) -> Floats:
    """A row (n,) for each group, (3, n)."""
    return row[None].repeat(len(LOCAL_GROUPS), axis=0)


def no_prices(shelves: Shelves, group: DofGroup, horizon: int) -> Floats32:
    """Nothing (n+1, W+OWN) to be added to the prices of a group's nodes."""
    return np.zeros((horizon + 1, shelves.group(group).postures.moves.shape[1] + OWN), np.float32)
