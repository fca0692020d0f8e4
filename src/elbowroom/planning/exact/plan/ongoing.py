"""A walk that goes on as planned: who is asked for the same, and is where the plan leads, does as planned."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.command import changed
from elbowroom.planning.exact.plan.full_plan import FullPlan, later
from elbowroom.planning.motion import MotionQuery
from elbowroom.planning.stillness import SAME, SAME_TIME

Floats = NDArray[np.float64]


class OngoingPlan(NamedTuple):
    """A plan that answered a query with the path as commanded: who is asked to walk on does as planned."""

    query: MotionQuery
    whole: FullPlan

    def left(self, query: MotionQuery) -> FullPlan | None:
        """What is left of it at a later query, if that goes on from where the plan leads, and wants the same."""
        return self._left(query) if self.query.command == query.command else None

    def left_for_another(self, query: MotionQuery) -> FullPlan | None:
        """The same where something a little different is wanted."""
        return None if changed(self.query.command, query.command) else self._left(query)

    def _left(self, query: MotionQuery) -> FullPlan | None:
        known, whole = self.query, self.whole
        at = round((query.time - known.time) / query.interval)
        local = whole.local
        if local.velocities is None:
            return None
        if not 0 <= at < len(local.configurations) or abs(query.time - whole.root.path.time_of(at)) > SAME_TIME:
            return None
        keys = whole.root.path.states, local.configurations, local.velocities
        return later(whole, at) if leads_to(*keys, at, query.root.as_array(), query.upper, query.velocity) else None


@exact_kernel
def leads_to(
    states: Floats, uppers: Floats, rates: Floats, at: int, state: Floats, upper: Floats, rate: Floats
) -> bool:
    """Whether a motion has the root `state` (7,), the `upper` body (LOCAL,) and its `rate` (LOCAL,) at key time `at`.

    It leads through root states (n+1, 7) and `uppers` (n+1, LOCAL) with `rates` (n+1, LOCAL).
    """
    apart = 0.0
    for i in range(state.shape[0]):
        apart = max(apart, abs(states[at, i] - state[i]))
    for i in range(upper.shape[0]):
        apart = max(apart, abs(uppers[at, i] - upper[i]), abs(rates[at, i] - rate[i]))
    return apart <= SAME
