"""The cheapest way through a time lattice: dynamic programming, each (posture, key time) settled once.

The nodes of a depth are the V postures of a group and E postures of that key time alone: the goal itself, what the last
plan had there, and the like. A step leads from a node to a free node of the next depth at most `step` radians away. A
node costs its own price, a step costs the squared change of the deviation from the goal: so a group that follows
its goal pays nothing, and evading begins and ends gently. The least sum is found exactly in one sweep: no node is
expanded twice, so the cost grows with the horizon and never explodes.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
Bools = NDArray[np.bool_]

_WIDTH = 4  # components of the widest group: inner loops of a fixed length
_ROUNDING = 1.0 + 1e-9
_SAME = 1e-9  # radians
_SLACK = 1e-9  # squared radians: more than the rounding of a sum


class Lattice(NamedTuple):
    """One group's problem along one root path."""

    postures: Floats  # (V, d) radians
    first: Ints  # (V+1,) steps between the postures, as in `Postures`
    targets: Ints
    own: Floats  # (n+1, E, d) postures of one key time each
    goals: Floats  # (n+1, d)
    start: Floats  # (d,) the posture at depth 0
    price: Floats  # (n+1, V+E) of each node; infinite where it is not free; row 0 is not used
    closed: Bools  # (n, steps) of `targets` that must not be taken at a depth
    like: Ints  # (n+1, E) the posture most like each of `own`, or -1; in row 0 the one most like the start
    kept: int  # the node of every depth that is the last plan's: its steps are banned only for themselves
    step: float  # radians
    step_weight: float


class Ban(NamedTuple):
    """Steps that must not be taken: those near to one that was found to touch."""

    depths: Ints  # (K,) depth at which the step begins
    steps: Floats  # (K, 2d) its two postures
    radius: float  # radians


class Way(NamedTuple):
    """The outcome."""

    reached: int  # greatest depth that has a way; n if the lattice is crossed
    cost: float  # of the cheapest way to that depth
    path: Floats  # (reached+1, d)
    nodes: int  # nodes settled


@exact_kernel
def _banned(ban: Ban, depth: int, a: Floats, b: Floats, radius: float) -> bool:
    size = ban.steps.shape[1] // 2
    for k in range(ban.depths.shape[0]):
        if ban.depths[k] != depth:
            continue
        total = 0.0
        for i in range(size):
            total += (ban.steps[k, i] - a[i]) ** 2 + (ban.steps[k, size + i] - b[i]) ** 2
        if total <= radius * radius:
            return True
    return False


@exact_kernel
def _fill(lattice: Lattice, depth: int, rows: Floats) -> None:
    """The configurations of a depth's nodes into rows (V+E, 4), without those that are the same at all depths."""
    size = lattice.postures.shape[0]
    for e in range(lattice.own.shape[1]):
        for i in range(lattice.own.shape[2]):
            rows[size + e, i] = lattice.own[depth, e, i]


@exact_kernel
def _set_gates(lattice: Lattice, depth: int, node: int, gates: Bools) -> None:
    """Which steps from `node` to and from a key time's own postures are closed: as for the posture most like each.

    Steps between two such postures, the goal's own motion among them, stay open until they are found to touch.
    """
    size = lattice.postures.shape[0]
    gates[:] = False
    listed = depth > 0 and node < size
    twin = node
    if not listed:
        twin = lattice.like[depth, node - size] if depth > 0 else lattice.like[0, 0]
    if twin < 0:
        return
    for k in range(lattice.first[twin], lattice.first[twin + 1]):
        if not lattice.closed[depth, k]:
            continue
        target = lattice.targets[k]
        gates[target] = True
        for e in range(lattice.like.shape[1]):
            gates[size + e] |= listed and lattice.like[depth + 1, e] == target


@exact_kernel
def _settle(
    lattice: Lattice, ban: Ban, depth: int, before: Floats, after: Floats, costs: Floats, parents: Ints, most: float
) -> int:
    """From the costs of the nodes at `depth` those of the next; returns how many of those have a way.

    Rows of `before` and `after` (V+E, 4) are the nodes' configurations; `costs` and `parents` are the next depth's in
    row 1, row 0 is known. Cheap nodes go first, so that most dearer ways are dismissed by their price alone; nodes that
    cost more than `most` are left out.
    """
    size, total = lattice.postures.shape[0], lattice.price.shape[1]
    shift = np.zeros(_WIDTH)
    for i in range(lattice.goals.shape[1]):
        shift[i] = lattice.goals[depth + 1, i] - lattice.goals[depth, i]
    price, closed, gates = lattice.price[depth + 1], lattice.closed[depth], np.zeros(total, np.bool_)
    first, targets, known, out, origins = lattice.first, lattice.targets, costs[0], costs[1], parents[1]
    gated, bans = closed.any(), (ban.depths == depth).any()
    longest, weight, kept = lattice.step * lattice.step * _ROUNDING, lattice.step_weight, lattice.kept
    for node in np.argsort(known, kind="mergesort"):
        cost = known[node]
        if cost == np.inf or cost > most:
            break
        if gated:
            _set_gates(lattice, depth, node, gates)
        listed = depth > 0 and node < size  # its steps are listed; others may lead to any node
        begin, own = (first[node], size) if listed else (0, 0)
        steps = first[node + 1] - begin if listed else 0
        for k in range(steps + total - own):
            target = targets[begin + k] if k < steps else own + k - steps
            bound = cost + price[target]
            if bound >= out[target] or (closed[begin + k] if k < steps else gates[target]):
                continue
            moved, changed = 0.0, 0.0
            for i in range(_WIDTH):
                step = after[target, i] - before[node, i]
                moved += step * step
                changed += (step - shift[i]) * (step - shift[i])
            if moved > longest or bound + weight * changed >= out[target]:
                continue
            if bans:
                radius = _SAME if target == kept and (depth == 0 or node == kept) else ban.radius
                if _banned(ban, depth, before[node], after[target], radius):
                    continue
            out[target] = bound + weight * changed
            origins[target] = node
    return int(np.sum(out < np.inf))


class Work(NamedTuple):
    """What is known of the cheapest ways, kept while bans are added."""

    costs: Floats  # (n+1, V+E) of the cheapest way to each node
    parents: Ints  # (n+1, V+E) the node before it on that way
    most: Floats  # (1,) dearer ways were left out


def new_work(lattice: Lattice) -> Work:
    """Nothing but the start: any node of depth 0 may stand for it."""
    work = Work(np.full(lattice.price.shape, np.inf), np.full(lattice.price.shape, -1, np.int32), np.zeros(1))
    work.costs[0, 0] = 0.0
    return work


@exact_kernel
def _own_way(lattice: Lattice, ban: Ban) -> float:
    """The cost of the cheapest way through key times' own postures alone: no cheapest way costs more."""
    size, count, width = lattice.postures.shape[0], lattice.own.shape[1], lattice.start.shape[0]
    known, found = np.full(count, np.inf), np.full(count, np.inf)
    known[0] = 0.0
    for depth in range(lattice.price.shape[0] - 1):
        found[:] = np.inf
        for e in range(count):
            if known[e] == np.inf:
                continue
            a = lattice.own[depth, e] if depth > 0 else lattice.start
            for f in range(count):
                b, moved, changed = lattice.own[depth + 1, f], 0.0, 0.0
                for i in range(width):
                    step = b[i] - a[i]
                    moved += step * step
                    changed += (step - lattice.goals[depth + 1, i] + lattice.goals[depth, i]) ** 2
                total = known[e] + lattice.price[depth + 1, size + f] + lattice.step_weight * changed
                if total >= found[f] or moved > lattice.step * lattice.step:
                    continue
                keeps = size + f == lattice.kept and (depth == 0 or size + e == lattice.kept)
                if not _banned(ban, depth, a, b, _SAME if keeps else ban.radius):
                    found[f] = total
        known, found = found, known
    return float(known.min())


@exact_kernel
def _least_left(lattice: Lattice) -> Floats:
    """The least that the depths after each one cost, (n+1,): steps cost nothing or more."""
    left = np.zeros(lattice.price.shape[0])
    for depth in range(left.shape[0] - 2, -1, -1):
        left[depth] = left[depth + 1] + lattice.price[depth + 1].min()
    return left


@exact_kernel
def cheapest_way(lattice: Lattice, ban: Ban, work: Work, begin: int) -> Way:
    """The cheapest way from the start to the last depth, or to the deepest that can be reached.

    `work` is right up to depth `begin`, 0 at first: later it is the least depth at which steps were banned or closed.
    Nodes from which even the least prices of the depths to come would cost more than a way that is known are left out.
    """
    size, total, width = lattice.postures.shape[0], lattice.price.shape[1], lattice.start.shape[0]
    costs, parents = work.costs, work.parents
    most = _own_way(lattice, ban) + _SLACK
    if most > work.most[0]:
        begin = 0  # what was left out may be needed
    work.most[0] = most
    before, after = np.zeros((total, _WIDTH)), np.zeros((total, _WIDTH))
    before[:size, :width] = lattice.postures
    after[:size, :width] = lattice.postures
    _fill(lattice, begin, before)
    if begin == 0:
        before[0, :] = 0.0
        before[0, :width] = lattice.start
    reached, nodes = begin, 0
    costs[begin + 1 :] = np.inf
    left = _least_left(lattice)
    for depth in range(begin, costs.shape[0] - 1):
        _fill(lattice, depth + 1, after)
        found = _settle(
            lattice,
            ban,
            depth,
            before,
            after,
            costs[depth : depth + 2],
            parents[depth : depth + 2],
            work.most[0] - left[depth],
        )
        if found == 0:
            break
        reached, nodes = depth + 1, nodes + found
        if depth == 0:
            before[:size, :width] = lattice.postures
        before, after = after, before
    return Way(reached, costs[reached].min(), _traced(lattice, costs, parents, reached), nodes)


@exact_kernel
def _traced(lattice: Lattice, costs: Floats, parents: Ints, reached: int) -> Floats:
    """The configurations (reached+1, d) of the cheapest way to that depth."""
    path, size = np.empty((reached + 1, lattice.start.shape[0])), lattice.postures.shape[0]
    node = np.argmin(costs[reached])
    for depth in range(reached, 0, -1):
        path[depth] = lattice.postures[node] if node < size else lattice.own[depth, node - size]
        node = parents[depth, node]
    path[0] = lattice.start
    return path
