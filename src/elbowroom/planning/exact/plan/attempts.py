"""Which of the paths that have no way at first sight is thought through with all means: one in each plan, in turn."""

import math
from collections.abc import Sequence

from elbowroom.planning.exact.plan.upper_body_search import Effort
from elbowroom.planning.result import JointEvidence

_SAME_PLACE = 0.3  # metres: blocked places that are taken for one
_SOON = 1.05  # seconds ahead: what is nearer is thought through at once
_MOST = 2e6  # capsules checked for joint steps in a plan, after which none is begun any more
_TRIPLE = 2.5  # capsules that settling a triple costs as much as checking


def same_place(a: tuple[float, float], b: tuple[float, float]) -> bool:
    """Whether two blocked places (x, z) are one."""
    return math.dist(a, b) < _SAME_PLACE


class AttemptOrder:
    """The commanded path as soon as it is blocked, then the one that leads farthest, and so on."""

    def __init__(self) -> None:
        self._turn = self._paths = 0
        self._work = 0.0  # of joint steps in this plan, in capsules checked
        self._seen: tuple[float, float] | None = None  # the place that ended the commanded path in the plan before
        self.thought_through: tuple[float, float] | None = None  # the place that ended the commanded path when it was

    @property
    def left(self) -> int:
        """Paths that have yet to have their turn after the last plan."""
        return max(self._paths - 1, 0)

    def begin(self) -> None:
        """Begin a plan."""
        self._paths, self._work = 0, 0.0

    def enter(self, joint: JointEvidence | None) -> None:
        """A joint step was made."""
        self._work += 0.0 if joint is None else joint.checks + _TRIPLE * joint.states

    @property
    def spent(self) -> bool:
        """Whether this plan has cost as much as it may: nothing dear is begun any more, the best so far will do."""
        return self._work > _MOST

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
