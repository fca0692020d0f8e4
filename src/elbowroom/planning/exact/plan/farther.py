"""A plan is made longer a part at a time, in the plans before the one that needs it.

While somebody walks on as planned, most plans have nothing to search, and now and then one has to be made longer. What
is found there does not depend on when it is looked for, so it is begun early and done in parts, by what searches cost
and not by the clock: a recording replays alike on a slower machine.
"""

from collections.abc import Callable

from elbowroom.planning.exact.plan.evidence import by_group
from elbowroom.planning.exact.plan.extension import OngoingPlan
from elbowroom.planning.exact.plan.full_plan import FullPlan
from elbowroom.planning.exact.plan.pauses import Pausing
from elbowroom.planning.motion import MotionQuery
from elbowroom.planning.result import GroupEvidence

# A part ends when it has cost so much, in nodes that are settled. A search counts for so much more than its nodes, to
# begin and whatever else takes its time for so much; a check for more than it takes: where something is near, the next
# search may be a long one.
_PART, _SEARCH, _ELSE, _CHECK = 6300.0, 1000.0, 2500.0, 0.6


class AheadOfTime:
    """What goes on from a walk, in the making."""

    def __init__(self, query: MotionQuery, work: Pausing[FullPlan | None]) -> None:
        """It was begun at a `query`, from where `work` goes on."""
        self._query, self._work = query, work
        self._rows: list[GroupEvidence] = []
        self._spent = _ELSE
        self._done = False
        self.searched = False  # whether the root had a path that is worth it
        self._found: FullPlan | None = None

    def do_part(self, go_on: Callable[[], None]) -> None:
        """Go on until that has cost enough; `go_on` is called now and then, and raises an exception to call it off."""
        while not self._done and self._spent < _PART:
            go_on()
            self._step()
        self._spent = 0.0

    def walk(self, go_on: Callable[[], None]) -> OngoingPlan | None:
        """What was found, when all is done; None if there is nothing."""
        while not self._done:
            go_on()
            self._step()
        return None if self._found is None else OngoingPlan(self._query, self._found)

    def costs(self) -> tuple[GroupEvidence, ...]:
        """What was searched since they were last asked for."""
        rows, self._rows = self._rows, []
        return by_group(rows)

    def _step(self) -> None:
        """Go on until the next pause."""
        try:
            row = next(self._work)
        except StopIteration as end:
            self._found, self._done = end.value, True
            return
        if row is None:
            self._spent += _ELSE
        else:
            self._spent += _SEARCH + row.nodes + _CHECK * row.checks
            self._rows.append(row)
            self.searched = True
