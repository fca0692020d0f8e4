"""What a path through one posture of one group costs at least, whatever the other groups do."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import kernel

Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]


_LANES = 16  # least values that are kept side by side


class Problem(NamedTuple):
    """The product of three groups' postures over n+1 slices; all costs in squared radians, infinite: closed.

    Depth 0 is the start: only what is there has a finite cost.
    """

    waist: Floats32  # (n+1, W) node costs
    left: Floats32  # (n+1, W, L) node costs under each waist
    right: Floats32  # (n+1, W, R)
    waist_edges: Floats32  # (n, W, W) from row to column
    left_edges: Floats32  # (n, L, L)
    right_edges: Floats32  # (n, R, R)
    apart: Bools  # (n+1, L, R) whether the arms keep clear of each other


class CostBounds(NamedTuple):
    """Lower bounds on the cost of whole paths, for waist, left and right arm: infinite where there is no such path."""

    through: tuple[Floats32, Floats32, Floats32]  # (n+1, V) of a path from start to end through the posture


def bounds_of(problem: Problem) -> CostBounds:
    """Each group by itself, the others at their best.

    What an arm costs under a waist at least is charged to the waist, and the arms pay what they cost beyond: the sum
    stays the same and the bounds become tighter.
    """
    least = [under.min(axis=2) for under in (problem.left, problem.right)]
    waist = problem.waist + least[0] + least[1]
    allowed = np.isfinite(waist)
    costs = [waist]
    for own, best in zip((problem.left, problem.right), least, strict=True):
        beyond = _beyond(own, np.where(allowed, best, np.float32(np.inf)))
        costs.append(beyond)
    edges = problem.waist_edges, problem.left_edges, problem.right_edges
    alone = [path_costs(cost, edge) for cost, edge in zip(costs, edges, strict=True)]
    whole = [one[0].min() for one in alone]
    others = [np.float32(sum(whole[:g] + whole[g + 1 :])) for g in range(3)]
    through = [one + other for one, other in zip(alone, others, strict=True)]
    return CostBounds((through[0], through[1], through[2]))


def path_costs(costs: Floats32, edges: Floats32) -> Floats32:
    """The cost (n+1, V) of the cheapest path of one group alone through each of its postures.

    `costs` (n+1, V) are those of its nodes, `edges` (n, V, V) from row to column.
    """
    through: Floats32 = _ahead(costs, edges) + _behind(costs, edges)
    return through


@kernel
def _beyond(costs: Floats32, least: Floats32) -> Floats32:
    """The least (n+1, V) over the waists of what a posture costs beyond the best under that waist (n+1, W)."""
    depths, waists, size = costs.shape
    out = np.empty((depths, size), np.float32)
    out[:] = np.inf
    for t in range(depths):
        for w in range(waists):
            if least[t, w] < np.inf:
                row, target, best = costs[t, w], out[t], least[t, w]
                for v in range(np.uint64(size)):
                    target[v] = min(target[v], row[v] - best)
    return out


@kernel
def _ahead(costs: Floats32, edges: Floats32) -> Floats32:
    """The least cost (n+1, V) of reaching each posture, its own node cost included."""
    out = np.empty(costs.shape, np.float32)
    out[:] = np.inf
    for v in range(costs.shape[1]):
        out[0, v] = costs[0, v]
    for t in range(edges.shape[0]):
        target = out[t + 1]
        for v in range(costs.shape[1]):
            reached, row = out[t, v], edges[t, v]
            if reached < np.inf:
                for u in range(np.uint64(costs.shape[1])):
                    target[u] = min(target[u], reached + row[u])
        for u in range(np.uint64(costs.shape[1])):
            target[u] += costs[t + 1, u]
    return out


@kernel
def _behind(costs: Floats32, edges: Floats32) -> Floats32:
    """The least cost (n+1, V) of the path on to the last depth, without the posture's own cost; of open postures."""
    out, size = np.empty(costs.shape, np.float32), costs.shape[1]
    out[:] = 0.0
    onward, best = np.empty(size, np.float32), np.empty(_LANES, np.float32)
    whole = size // _LANES * _LANES
    for t in range(edges.shape[0] - 1, -1, -1):
        for u in range(np.uint64(size)):
            onward[u] = out[t + 1, u] + costs[t + 1, u]
        for v in range(size):
            if costs[t, v] == np.inf:
                out[t, v] = np.inf
                continue
            row = edges[t, v]
            for lane in range(np.uint64(_LANES)):
                best[lane] = np.float32(np.inf)
            for first in range(0, whole, _LANES):
                for lane in range(np.uint64(_LANES)):
                    best[lane] = min(best[lane], row[first + lane] + onward[first + lane])
            least = np.float32(np.inf)
            for lane in range(np.uint64(_LANES)):
                least = min(least, best[lane])
            for u in range(whole, size):
                least = min(least, row[u] + onward[u])
            out[t, v] = least
    return out
