"""The motion of who has room: where nothing stands near, and nothing is left to come back from, it is what is liked.

No search would find another: it costs nothing, and in the natural walk no part of the body comes too near to another.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, SEARCH_ORDER, DofGroup, columns_of, limits
from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.group.caches import PlanCaches
from elbowroom.planning.exact.group.path_problem import PathProblem
from elbowroom.planning.exact.lattice.tangents import peak_acceleration, peak_speed, smooth_tangents
from elbowroom.planning.result import GroupEvidence, LocalPlan, PlanStatus
from elbowroom.planning.stillness import SAME
from elbowroom.world.obstacles.rows import any_in

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]

_GROUPS: Longs = np.array([(columns_of(group).start, columns_of(group).stop) for group in SEARCH_ORDER])
_LIMITS: Floats = np.zeros((LOCAL, 2))  # of the joints, radians
for _group in SEARCH_ORDER:
    _LIMITS[columns_of(_group)] = limits(_group)
_SEARCHED = tuple(GroupEvidence(group, PlanStatus.FOUND, 0, 0, 0, 0) for group in SEARCH_ORDER)  # for nothing


def unhindered(problem: PathProblem, caches: PlanCaches) -> LocalPlan | None:
    """The motion on a path on which nothing is near, from a posture that is liked there; None where that is not so."""
    if any_in(problem.near.spans) or np.abs(problem.begins.upper - problem.goals[0]).max() > SAME:
        return None
    waists = np.ascontiguousarray(problem.goals[:, columns_of(DofGroup.WAIST)])
    goals = problem.under(waists).goals
    keys = np.concatenate([problem.begins.upper[None], goals[1:]])
    groups = [caches.group(group) for group in SEARCH_ORDER]
    bounds = np.array([(group.speed, group.acceleration) for group in groups])
    rates = np.zeros_like(keys)
    if not _gentle_rates(keys, problem.path.interval, problem.begins.velocity, bounds, rates):
        return None
    return LocalPlan(PlanStatus.FOUND, keys, goals, _SEARCHED, velocities=rates)


@exact_kernel
def _gentle_rates(keys: Floats, interval: float, first: Floats, bounds: Floats, rates: Floats) -> bool:
    """Set the velocities (n+1, LOCAL) at key postures (n+1, LOCAL); whether no group's curve exceeds its `bounds`.

    The first velocity is `first` (LOCAL,); `bounds` (G, 2) are the greatest speed and acceleration of each group.
    """
    stiff, gentle = np.zeros(keys.shape[0], np.bool_), True
    for g in range(_GROUPS.shape[0]):
        low, high = _GROUPS[g, 0], _GROUPS[g, 1]
        own = np.ascontiguousarray(keys[:, low:high])
        tangents = smooth_tangents(own, interval, first[low:high], _LIMITS[low:high], stiff)
        rates[:, low:high] = tangents
        for k in range(own.shape[0] - 1):
            a, m, b, n = own[k], tangents[k], own[k + 1], tangents[k + 1]
            if (
                peak_acceleration(a, m, b, n, interval) > bounds[g, 1]
                or peak_speed(a, m, b, n, interval) > bounds[g, 0]
            ):
                gentle = False
    return gentle
