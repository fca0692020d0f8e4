"""Waist, left arm and right arm at once: the cheapest path through the product of their postures, exactly.

The arms hang on the waist, so a posture of the whole upper body is a triple (w, l, r) that costs c(w) + c(w, l) +
c(w, r), infinite where it is not free; arm may also run into arm, a table (l, r). Edges are the groups' own, and their
costs add up. So the least cost over all predecessors falls apart into three small minimisations,

    V'(w', l', r') = c(w', l', r') + min_w (E(w, w') + min_l (E(l, l') + min_r (E(r, r') + V(w, l, r)))),

instead of one over the whole product. A child that nothing but the waist can hinder enters as its least cost under
each waist, within c(w). Even so, fifty waists and two hundred postures an arm are two million triples a slice. Few of
them matter: what a path through one posture costs at least is known from the group alone (the others at their best).
The product is therefore first searched among the best K postures of each group and slice; a path that is found there
costs U, and whatever could not be part of a cheaper one is left out for good. If none is found, K grows. If the first
few K find none, it is asked whether there is any (`reachability`). The answer is that of the whole product: the same
feasibility, the same optimum.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.exact.joint.bounds import Problem, bounds_of
from elbowroom.planning.exact.joint.dynamic_programming import sweep
from elbowroom.planning.exact.joint.reachability import reach
from elbowroom.planning.result import PlanStatus

Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

_FIRST = 8  # postures of each group and slice that are tried at first
_GROWTH = 3
_FEW = 24  # postures of each: if so many lead nowhere, it is asked first whether any path exists
_ROUNDING = 1e-4  # squared radians: more than the rounding of a sum in single precision


class JointPath(NamedTuple):
    """How a search of the product ended."""

    status: PlanStatus
    cost: float  # of the cheapest path to the last depth; infinite unless FOUND
    nodes: Indices  # (n+1, 3) waist, left and right posture at each depth; (0, 3) unless FOUND
    states: int  # triples that were settled


_NONE = np.empty((0, 3), np.int64)
NO_PATH = JointPath(PlanStatus.EXHAUSTED, np.inf, _NONE, 0)
OUT_OF_BUDGET = JointPath(PlanStatus.OUT_OF_BUDGET, np.inf, _NONE, 0)


def joint_path(problem: Problem, budget: int = 4_000_000) -> JointPath:
    """The cheapest path from depth 0 to the last, or the proof that there is none.

    At most `budget` triples are settled; the proof is made at once where a group by itself has none, else once the
    first few selections have found nothing.
    """
    bounds = bounds_of(problem)
    if not all(bool(np.isfinite(through).any(axis=1).all()) for through in bounds.through):
        return NO_PATH
    states, count, proved = 0, _FIRST, False
    while True:
        if not proved and count > _FEW:
            if reach(problem).depth < len(problem.waist_edges):
                return NO_PATH._replace(states=states)
            proved = True
        chosen = [_cheapest(through, count) for through in bounds.through]
        size = _size(chosen)
        if states + size > budget:
            return OUT_OF_BUDGET._replace(states=states)
        states += size
        cost, nodes = sweep(problem, *chosen)
        if np.isfinite(cost):
            break
        count *= _GROWTH
    needed = [through <= cost + _ROUNDING for through in bounds.through]
    if not all(bool((mask >= need).all()) for mask, need in zip(chosen, needed, strict=True)):
        size = _size(needed)
        if states + size > budget:
            return OUT_OF_BUDGET._replace(states=states)
        states += size
        cost, nodes = sweep(problem, *needed)
    return JointPath(PlanStatus.FOUND, cost, nodes, states)


def _cheapest(through: Floats32, count: int) -> Bools:
    """The `count` cheapest postures of every slice, and what costs the same as the dearest of them, (n+1, V)."""
    if count >= through.shape[1]:
        return np.isfinite(through)
    most = np.partition(through, count - 1, axis=1)[:, count - 1 : count]
    chosen: Bools = np.isfinite(through) & (through <= most)
    return chosen


def _size(chosen: list[Bools]) -> int:
    """The number of triples in all slices."""
    waist, left, right = (mask.sum(axis=1, dtype=np.int64) for mask in chosen)
    return int((waist * left * right).sum())
