"""The extra nodes of a key time: its goal, what the last plan had there, the start, and the way back from it."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.lattice.lattice import BACK, EXTRA, GOAL, HOLD, PREVIOUS, place_of_least, squares_from
from elbowroom.planning.paper.activity_graph import squared_distance

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

_BACK_STEP = 0.8  # of the longest edge
_SAME = 1e-9  # radians


class ExtraNodes(NamedTuple):
    """The nodes of each key time alone."""

    postures: Floats  # (n+1, EXTRA, d) radians
    needed: Bools  # (n+1, EXTRA) which of them are needed
    previous: Longs  # (n+1,) the nodes that the last plan had, extra or not


@exact_kernel
def extra_nodes(
    known: Floats, columns: Floats32, step: float, goals: Floats, last: Floats, start: Floats, settled: bool
) -> ExtraNodes:
    """The extra nodes along a path.

    `known` (V, d) are the group's postures, also as `columns` (d, W), with edges of at most `step` radians; `goals`
    (n+1, d), `last` (n+1, d) what the last plan had, `start` (d,). A posture that is among the known needs no extra
    node. A start that is `settled` lies on the last plan: no node is needed to stay there or to lead back from it.
    """
    width = columns.shape[1]
    count, size = goals.shape
    extras, needed = np.empty((count, EXTRA, size)), np.empty((count, EXTRA), np.bool_)
    previous, squares = np.empty(count, np.int64), np.empty(width, np.float32)
    length, pace = _distance(goals[0], start), _BACK_STEP * step
    start_is_known = _known(known, columns, start, squares) >= 0
    for t in range(count):
        goal = goals[t]
        part = min(pace * t / max(_distance(goal, start), 1e-9), 1.0)
        for i in range(size):
            extras[t, GOAL, i], extras[t, PREVIOUS, i], extras[t, HOLD, i] = goal[i], last[t, i], start[i]
            extras[t, BACK, i] = start[i] + part * (goal[i] - start[i])
        if _near(last[t], goal):
            previous[t] = width + GOAL
        else:
            at = _known(known, columns, last[t], squares)
            previous[t] = at if at >= 0 else width + PREVIOUS
        needed[t, GOAL], needed[t, PREVIOUS] = True, previous[t] == width + PREVIOUS
        needed[t, BACK] = not settled and part < 1.0 and length > _SAME
        needed[t, HOLD] = not settled and not start_is_known and not _near(start, goal)
    return ExtraNodes(extras, needed, previous)


@exact_kernel
def _distance(a: Floats, b: Floats) -> float:
    """How far two postures (d,) are apart, radians."""
    return float(np.sqrt(squared_distance(a, b)))


@exact_kernel
def _known(known: Floats, columns: Floats32, posture: Floats, squares: Floats32) -> int:
    """The number of a posture (d,), or -1; `squares` (W,) is scratch."""
    squares_from(columns, posture, squares)
    at = place_of_least(squares)
    return at if at < known.shape[0] and _near(posture, known[at]) else -1


@exact_kernel
def _near(a: Floats, b: Floats) -> bool:
    apart = 0.0
    for i in range(a.shape[0]):
        apart = max(apart, abs(a[i] - b[i]))
    return apart <= _SAME
