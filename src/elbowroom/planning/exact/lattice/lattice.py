"""A time lattice: its nodes at each key time, what they cost, and what an edge to the next key time costs.

The nodes of a depth are the V postures of a group, W with the lanes that fill up the last block, and EXTRA nodes whose
postures belong to that key time alone: the goal itself, what the last plan had there, and the like. An edge leads from
a node to a free node of the next depth at most `step` radians away, and costs w |d - g|^2: the squared change of the
deviation from the goal, d being the change of the posture and g that of the goal. So a group that follows its goal
pays nothing, and evading begins and ends gently.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, inner_exact_kernel
from elbowroom.planning.exact.lattice.postures import Postures

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Ints = NDArray[np.int32]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

EXTRA = 4  # extra nodes of a key time
GOAL, PREVIOUS, HOLD, BACK = range(EXTRA)  # the goal, what the last plan had, the start, between start and goal
_ROUNDING = 1.0 + 1e-6
_INFINITE = np.float32(np.inf)


class Lattice(NamedTuple):
    """One group's problem along one root path. Nodes 0..W-1 are the postures, W..W+EXTRA-1 the extra ones."""

    postures: Postures
    extras: Floats  # (n+1, EXTRA, d) postures of the extra nodes; in row 0 HOLD is the start
    goals: Floats  # (n+1, d)
    cost: Floats32  # (n+1, W+EXTRA) of each node, squared radians; infinite: not free; row 0 is not used
    masks: Longs  # (n,) which of `closed` holds for an interval; -1: all its edges are open
    closed: Bools  # (M, W+EXTRA, W+EXTRA) which edges are closed
    previous: Longs  # (n+1,) the nodes that the last plan had
    weight: float  # w


class Work(NamedTuple):
    """What is known of the cheapest paths, and scratch memory; of one search after the other."""

    costs: Floats32  # (n+1, W+EXTRA) of the cheapest path from the start to each node
    parents: Ints  # (n+1, W+EXTRA) the node before it on that path
    onward: Floats32  # (n+1, W+EXTRA) of the cheapest path from each node on to the end
    squares: Floats32  # (n+1, EXTRA, W) squared distances of the extra nodes from the postures
    most: Floats  # (2,) dearer paths were left out by the last search; by one that is not narrow
    least: Floats  # (n+1,) what a path on from each depth costs at least
    base: Floats32  # (W+EXTRA,) scratch, as is what follows
    slopes: Floats32  # (W+EXTRA,)
    closed: Bools  # (W,)
    origins: Ints  # (W+EXTRA,)


@exact_kernel
def new_work(depths: int, nodes: int) -> Work:
    """Memory for lattices of `depths` key times with `nodes` nodes each."""
    return Work(
        np.empty((depths, nodes), np.float32),
        np.empty((depths, nodes), np.int32),
        np.empty((depths, nodes), np.float32),
        np.empty((depths, EXTRA, nodes - EXTRA), np.float32),
        np.zeros(2),
        np.zeros(depths),
        np.empty(nodes, np.float32),
        np.empty(nodes, np.float32),
        np.empty(nodes - EXTRA, np.bool_),
        np.empty(nodes, np.int32),
    )


@inner_exact_kernel
def component_of(lattice: Lattice, depth: int, node: int, i: int) -> float:
    """One component of the configuration of a node."""
    postures = lattice.postures
    width = postures.moves.shape[1]
    return float(postures.configurations[node, i] if node < width else lattice.extras[depth, node - width, i])


@inner_exact_kernel
def squares_from(columns: Floats32, posture: Floats, out: Floats32) -> None:
    """The squared distances (W,) of the postures from one (d,)."""
    out[:] = 0.0
    for i in range(posture.shape[0]):
        column, place = columns[i], np.float32(posture[i])
        for v in range(np.uint64(out.shape[0])):
            out[v] += (column[v] - place) * (column[v] - place)


@inner_exact_kernel
def measure_extras(lattice: Lattice, work: Work) -> None:
    """The squared distances of the extra nodes from the postures; infinite where an edge would be too long."""
    postures, columns = lattice.postures, lattice.postures.columns
    size, width = postures.configurations.shape[0], postures.moves.shape[1]
    longest = np.float32(postures.step * postures.step * _ROUNDING)
    for depth in range(lattice.extras.shape[0]):
        for e in range(EXTRA):
            if lattice.cost[depth, width + e] == _INFINITE and (depth > 0 or e != HOLD):
                continue
            row = work.squares[depth, e]
            squares_from(columns, lattice.extras[depth, e], row)
            for v in range(np.uint64(width)):
                row[v] = row[v] if row[v] <= longest else _INFINITE
            row[size:] = _INFINITE


@inner_exact_kernel
def extra_edge_square(lattice: Lattice, depth: int, e: int, f: int) -> float:
    """The squared length of the edge from extra node `e` at `depth` to `f` at the next; infinite if it is too long."""
    total = 0.0
    for i in range(lattice.extras.shape[2]):
        total += (lattice.extras[depth + 1, f, i] - lattice.extras[depth, e, i]) ** 2
    step = lattice.postures.step
    return total if total <= step * step * _ROUNDING else np.inf


@inner_exact_kernel
def slopes_of(lattice: Lattice, depth: int, row: int, out: Floats32) -> float:
    """2 w q.g into `out` (W+EXTRA,) for the nodes q of `row`; returns w |g|^2, g the goal's change after `depth`."""
    columns, weight = lattice.postures.columns, lattice.weight
    width = columns.shape[1]
    square, known = 0.0, out[:width]
    out[:] = 0.0
    for i in range(lattice.goals.shape[1]):
        change = lattice.goals[depth + 1, i] - lattice.goals[depth, i]
        square += weight * change * change
        factor, column = np.float32(2.0 * weight * change), columns[i]
        for v in range(np.uint64(width)):
            known[v] += factor * column[v]
        for e in range(EXTRA):
            out[width + e] += factor * np.float32(lattice.extras[row, e, i])
    return square


@inner_exact_kernel
def edge_cost(lattice: Lattice, depth: int, source: int, target: int) -> float:
    """What the edge from a node at `depth` to one of the next costs; infinite if there is none."""
    postures, mask = lattice.postures, lattice.masks[depth]
    size, longest = postures.configurations.shape[0], postures.step * postures.step * _ROUNDING
    if mask >= 0 and lattice.closed[mask, source, target]:
        return np.inf
    moved, changed = 0.0, 0.0
    for i in range(lattice.goals.shape[1]):
        step = component_of(lattice, depth + 1, target, i) - component_of(lattice, depth, source, i)
        moved += step * step
        changed += (step - lattice.goals[depth + 1, i] + lattice.goals[depth, i]) ** 2
    listed = source >= size or target >= size or postures.moves[source, target] < _INFINITE
    return lattice.weight * changed if listed and moved <= longest else np.inf


@inner_exact_kernel
def least_in(row: Floats32) -> Any:
    """The least of many numbers."""
    least = row[0]
    for i in range(1, row.shape[0]):
        least = min(least, row[i])
    return least


@inner_exact_kernel
def place_of_least(row: Floats32) -> int:
    """Where the least of many numbers is; the first of them."""
    place = 0
    for i in range(1, row.shape[0]):
        if row[i] < row[place]:
            place = i
    return place
