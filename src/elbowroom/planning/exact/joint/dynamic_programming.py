"""One sweep of dynamic programming through a product of postures, each triple settled once.

Slices are compact: of each group only the chosen postures of a depth are there, and the lanes of the inner loops are
the right arm's, or the postures of both arms.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import helper, inner_kernel, kernel, plain
from elbowroom.planning.exact.joint.bounds import Problem

Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]

_START = plain(0)  # the first slice


@inner_kernel
def _compact(edges: Floats32, sources: Indices, targets: Indices) -> Floats32:
    """The edges (N, M) from chosen nodes (N,) to chosen ones (M,), of all edges (V, V)."""
    out = np.empty((sources.shape[0], targets.shape[0]), np.float32)
    for i in range(sources.shape[0]):
        row = edges[sources[i]]
        for j in range(targets.shape[0]):
            out[i, j] = row[targets[j]]
    return out


@inner_kernel
def _lower(out: Floats32, values: Floats32, cost: float) -> None:
    """out[i] = min(out[i], values[i] + cost)."""
    for i in range(np.uint64(out.shape[0])):
        out[i] = min(out[i], values[i] + cost)


@helper
def _over_right(known: Floats32, edges: Floats32) -> Floats32:
    """The least over the right arm: (W, L, R) to (W, L, R')."""
    out = np.empty((known.shape[0], known.shape[1], edges.shape[1]), np.float32)
    out[:] = np.inf
    for w in range(known.shape[0]):
        for left in range(known.shape[1]):
            for r in range(known.shape[2]):
                cost = known[w, left, r]
                if cost < np.inf:
                    _lower(out[w, left], edges[r], cost)
    return out


@helper
def _over_left(known: Floats32, edges: Floats32) -> Floats32:
    """The least over the left arm: (W, L, R) to (W, L', R)."""
    out = np.empty((known.shape[0], edges.shape[1], known.shape[2]), np.float32)
    out[:] = np.inf
    for w in range(known.shape[0]):
        for left in range(known.shape[1]):
            for target in range(edges.shape[1]):
                if edges[left, target] < np.inf:
                    _lower(out[w, target], known[w, left], edges[left, target])
    return out


@helper
def _over_waist(known: Floats32, edges: Floats32) -> Floats32:
    """The least over the waist: (W, LR) to (W', LR)."""
    out = np.empty((edges.shape[1], known.shape[1]), np.float32)
    out[:] = np.inf
    for w in range(known.shape[0]):
        for target in range(edges.shape[1]):
            if edges[w, target] < np.inf:
                _lower(out[target], known[w], edges[w, target])
    return out


@inner_kernel
def _add_costs(problem: Problem, depth: int, waist: Indices, left: Indices, right: Indices, costs: Floats32) -> bool:
    """Add the node costs of a slice's triples to `costs` (W, L, R); whether any is finite."""
    found = False
    for i in range(waist.shape[0]):
        w = waist[i]
        for j in range(left.shape[0]):
            cost = problem.waist[depth, w] + problem.left[depth, w, left[j]]
            for k in range(right.shape[0]):
                if problem.apart[depth, left[j], right[k]]:
                    costs[i, j, k] += cost + problem.right[depth, w, right[k]]
                    found |= costs[i, j, k] < np.inf
                else:
                    costs[i, j, k] = np.inf
    return found


@helper
def _before(
    known: Floats32, waist_edges: Floats32, left_edges: Floats32, right_edges: Floats32, target: Indices
) -> Indices:
    """The triple (3,) of a slice from which the cheapest path leads to the triple `target` of the next."""
    best, out = np.float32(np.inf), np.empty(3, np.int64)
    out[:] = 0
    for w in range(known.shape[0]):
        of_waist = waist_edges[w, target[0]]
        if of_waist == np.inf:
            continue
        for left in range(known.shape[1]):
            of_both = of_waist + left_edges[left, target[1]]
            if of_both >= best:
                continue
            for r in range(known.shape[2]):
                cost = known[w, left, r] + of_both + right_edges[r, target[2]]
                if cost < best:
                    best = cost
                    out[0], out[1], out[2] = w, left, r
    return out


@helper
def _least(costs: Floats32) -> Indices:
    """The cheapest triple (3,)."""
    best, out = np.float32(np.inf), np.empty(3, np.int64)
    out[:] = 0
    for w in range(costs.shape[0]):
        for left in range(costs.shape[1]):
            for r in range(costs.shape[2]):
                if costs[w, left, r] < best:
                    best = costs[w, left, r]
                    out[0], out[1], out[2] = w, left, r
    return out


@inner_kernel
def _numbers(chosen: Bools) -> Indices:
    """The numbers of those that are chosen (V,)."""
    out, count = np.empty(chosen.shape[0], np.int64), 0
    for v in range(chosen.shape[0]):
        if chosen[v]:
            out[count] = v
            count += 1
    return out[:count]


@kernel
def sweep(problem: Problem, waist: Bools, left: Bools, right: Bools) -> tuple[float, Indices]:
    """The cheapest path (n+1, 3) through the chosen postures (n+1, V) of each group, and its cost.

    Where there is none to the last depth, the path is empty and its cost infinite.
    """
    depths = waist.shape[0]
    rows = [(_numbers(waist[t]), _numbers(left[t]), _numbers(right[t])) for t in range(depths)]
    costs: list[Floats32] = [np.empty((rows[0][0].shape[0], rows[0][1].shape[0], rows[0][2].shape[0]), np.float32)]
    costs[0][:] = 0.0
    path = np.empty((depths, 3), np.int64)
    if not _add_costs(problem, _START, rows[0][0], rows[0][1], rows[0][2], costs[0]):
        return np.inf, path[:0]
    for t in range(depths - 1):
        here, there = rows[t], rows[t + 1]
        over_right = _over_right(costs[t], _compact(problem.right_edges[t], here[2], there[2]))
        over_left = _over_left(over_right, _compact(problem.left_edges[t], here[1], there[1]))
        sizes = there[0].shape[0], there[1].shape[0], there[2].shape[0]
        flat = over_left.reshape(over_left.shape[0], sizes[1] * sizes[2])
        over_waist = _over_waist(flat, _compact(problem.waist_edges[t], here[0], there[0]))
        costs.append(over_waist.reshape(sizes))
        if not _add_costs(problem, t + 1, there[0], there[1], there[2], costs[t + 1]):
            return np.inf, path[:0]
    at = _least(costs[depths - 1])
    cost = costs[depths - 1][at[0], at[1], at[2]]
    for t in range(depths - 1, -1, -1):
        if t < depths - 1:
            after = rows[t + 1]
            at = _before(
                costs[t],
                _compact(problem.waist_edges[t], rows[t][0], after[0]),
                _compact(problem.left_edges[t], rows[t][1], after[1]),
                _compact(problem.right_edges[t], rows[t][2], after[2]),
                at,
            )
        path[t, 0], path[t, 1], path[t, 2] = rows[t][0][at[0]], rows[t][1][at[1]], rows[t][2][at[2]]
    return float(cost), path
