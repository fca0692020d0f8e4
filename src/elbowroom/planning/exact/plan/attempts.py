"""Which of the paths that have no way at first sight is thought through with all means: one in each plan, in turn."""

import math
from collections.abc import Sequence

from elbowroom.planning.exact.plan.upper_body_search import Effort
from elbowroom.planning.result import LocalPlan

_SAME_PLACE = 0.3  # metres: blocked places that are taken for one
_SOON = 1.05  # seconds ahead: what is nearer is thought through at once
# Work is counted in capsules checked, some 10 to 20 ns each. These cost as much as so many of them: a triple, a node, a
# path for the upper body, the tables of all groups together, a place of the root.
_TRIPLE, _NODE, _PATH, _TABLES, _PLACE = 2.5, 10, 150_000, 500_000, 60
# Work of a plan after which nothing is begun but a safe end: of who stands, of who walks, and in a hurry.
_MOST_STANDING, _MOST, _MOST_IN_A_HURRY = 4e6, 3e6, 1e6


def same_place(a: tuple[float, float], b: tuple[float, float]) -> bool:
    """Whether two blocked places (x, z) are one."""
    return math.dist(a, b) < _SAME_PLACE


class AttemptOrder:
    """The commanded path as soon as it is blocked, then the one that leads farthest, and so on."""

    def __init__(self) -> None:
        self._turn = self._paths = 0
        self._work, self._most = 0.0, _MOST  # of this plan, in capsules checked
        self._seen: tuple[float, float] | None = None  # the place that ended the commanded path in the plan before
        self.thought_through: tuple[float, float] | None = None  # the place that ended the commanded path when it was

    @property
    def left(self) -> int:
        """Turns to come after the last plan: one for each path that had none yet, the last for steps to elsewhere."""
        return self._paths

    def begin(self, *, hurry: bool, moves: bool) -> None:
        """Begin a plan."""
        self._paths, self._work = 0, 0.0
        self._most = _MOST_IN_A_HURRY if hurry else _MOST if moves else _MOST_STANDING

    def enter_root(self, checks: int) -> None:
        """A root path was made, for which so many places and postures were looked at."""
        self._work += _PLACE * checks

    def enter(self, upper: LocalPlan) -> None:
        """A path was sought for the upper body."""
        self._work += _PATH + sum(row.checks + _NODE * row.nodes for row in upper.evidence)
        if upper.joint is not None:
            self._work += _TABLES + upper.joint.checks + _TRIPLE * upper.joint.states

    @property
    def spent(self) -> bool:
        """Whether this plan has cost as much as it may: nothing dear is begun any more, the best so far will do."""
        return self._work > self._most

    def can_wait(self, place: tuple[float, float], ahead: float) -> bool:
        """Whether the commanded path, ending at a place (x, z) `ahead` seconds from now, need not be thought through.

        That is so where it is far off and was not in the way in the plan before: whoever steers round a bend looks at
        the wall all the time, and seldom means to walk into it.
        """
        before, self._seen = self._seen, place
        return ahead > _SOON and (before is None or not same_place(place, before))

    def found(self) -> None:
        """The commanded path has a way."""
        self._turn, self.thought_through, self._seen = 0, None, None

    def is_new(self, place: tuple[float, float]) -> bool:
        """Whether the commanded path now ends at another place (x, z) than when it was thought through last."""
        if self.thought_through is not None and same_place(place, self.thought_through):
            return False
        self.thought_through, self._turn = place, 0
        return True

    def efforts(self, reached: Sequence[int]) -> list[tuple[int, Effort]]:
        """The paths, in order, and what is tried on each; `reached` is how far each has a way, the commanded one first.

        All but one get the joint step's first answer.
        """
        ranked = [0, *sorted(range(1, len(reached)), key=lambda i: -reached[i])]
        turn = self._turn % len(reached)
        self._paths, self._turn = len(reached), self._turn + 1
        found = []
        for place, number in enumerate(ranked):
            if number == 0 and self._turn == 1:
                continue  # it was thought through just now
            found.append((number, Effort.GLANCE if place != turn else Effort.JOINT if number else Effort.REFINED))
        return found
