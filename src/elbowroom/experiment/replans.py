"""How much a plan differs from the one before it at the same moments: what would show as jitter."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.control.frame import PlanReport

Floats = NDArray[np.float64]


class Replans:
    """Compares every plan with the one before, where both answer the same command."""

    def __init__(self) -> None:
        self._last: PlanReport | None = None
        self._changes: list[float] = []

    def enter(self, plan: PlanReport) -> None:
        """A new plan was made."""
        if self._last is not None and self._last.found and plan.found and plan.command == self._last.command:
            self._changes.append(plan_change(self._last, plan))
        self._last = plan

    @property
    def changes(self) -> Floats:
        """The change of each plan that could be compared, radians."""
        return np.array(self._changes)


def plan_change(before: PlanReport, after: PlanReport) -> float:
    """The largest difference of a joint, radians, at the key times of `after` that `before` covers; 0 without any."""
    times = after.root.path.times
    times = times[times <= before.root.path.times[-1]]
    if len(times) == 0:
        return 0.0
    return float(np.abs(_at(before, times) - _at(after, times)).max())


def _at(plan: PlanReport, times: Floats) -> Floats:
    """Upper bodies (N, LOCAL) of a plan at times (N,), straight between its key frames."""
    known = plan.local.configurations
    return np.stack([np.interp(times, plan.root.path.times, column) for column in known.T], axis=1)
