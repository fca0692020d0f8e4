"""The way of one group along a root path: cheapest through the lattice, then proven as it will be shown.

A way that touches between its key frames is banned there, with the steps near it; where that happens, the steps of
that key interval through which the next ways would lead are looked at in one batch, and the next cheapest way is taken.
So steps are swept only where the search is blocked, and every candidate is swept as a whole. It is one compiled call.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, plain
from elbowroom.planning.exact.group.caches import GroupCache
from elbowroom.planning.exact.group.node_costs import Carriers, carriers_at, node_costs
from elbowroom.planning.exact.group.problem import Group, GroupPath, GroupTask, Weights
from elbowroom.planning.exact.lattice.closed_edges import (
    ClosedEdges,
    new_closed_edges,
    reopen_first,
    with_tables,
)
from elbowroom.planning.exact.lattice.dynamic_programming import cheapest_path, settle_backward, widen
from elbowroom.planning.exact.lattice.extra_nodes import extra_nodes
from elbowroom.planning.exact.lattice.lattice import EXTRA, Lattice, Work, least_in, new_work
from elbowroom.planning.exact.lattice.paths import set_keys, traced
from elbowroom.planning.exact.lattice.postures import Postures
from elbowroom.planning.exact.lattice.tangents import peak_acceleration, peak_speed, smooth_tangents
from elbowroom.planning.exact.memory.cache_index import begin_round
from elbowroom.planning.exact.sweep.edges import MOST_EDGES, close_edges, close_near, promising_edges
from elbowroom.planning.exact.sweep.motion_bounds import KinematicChain, LimbSweeps, RootSweeps
from elbowroom.planning.exact.sweep.proof import ENOUGH, Carrier, limb_sweep_in
from elbowroom.planning.exact.sweep.scratch import Scratch, new_scratch
from elbowroom.world.obstacles.layout import Spans
from elbowroom.world.obstacles.rows import at_span

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

_BAN_RADIUS = 0.1  # radians: steps so near to one that touches are banned with it
_FIRST_SLACK = 0.1  # squared radians: how much dearer ways are looked at where one touches; doubled when those were
_BEGIN = plain(0)  # the depth at which the search begins


@helper
def _carrier(roots: RootSweeps, waists: LimbSweeps, task: GroupTask, k: int, is_waist: bool) -> Carrier:
    """What carries the limb in interval k, as a proof needs it."""
    root = task.roots[k]
    states, heights = roots.entries.keys[root], roots.places[root]
    if is_waist:
        return Carrier(roots.entries.ids[root], heights, roots.turns[root], roots.sway[root], states, heights, states)
    at = task.carriers[k]
    return Carrier(
        waists.entries.ids[at],
        waists.places[at],
        waists.turns[at],
        waists.sway[at],
        states,
        heights,
        waists.entries.keys[at],
    )


@exact_kernel
def _proven(
    scratch: Scratch,
    group: Group,
    roots: RootSweeps,
    waists: LimbSweeps,
    chain: KinematicChain,
    task: GroupTask,
    keys: Floats,
    tangents: Floats,
    motion_margins: Floats,
    entries: Longs,
    touches: Bools,
    gentle: bool,
) -> tuple[int, bool]:
    """Prove the curve through `keys` (n+1, d) free: `touches` (n,) where it is not; the capsules checked.

    An interval fails too if its curve is faster than the group or asks for too much acceleration, the first only if it
    has to be `gentle`. Also whether that does. The ways through the intervals are put into `slots` (n,).
    """
    ways, postures, levers, checks = group.ways, group.postures, group.levers, 0
    is_waist, harsh = postures.limb.is_waist, False
    begin_round(ways.entries)
    for k in range(entries.shape[0]):
        carrier = _carrier(roots, waists, task, k, is_waist)
        ends = (keys[k], tangents[k], keys[k + 1], tangents[k + 1])
        at, count = limb_sweep_in(
            scratch, ways, postures, levers, chain, carrier, ends, at_span(task.obstacles, k), motion_margins[k]
        )
        entries[k] = at
        checks += count
        much = peak_acceleration(keys[k], tangents[k], keys[k + 1], tangents[k + 1], task.interval) > group.acceleration
        much = much or peak_speed(keys[k], tangents[k], keys[k + 1], tangents[k + 1], task.interval) > group.speed
        harsh = harsh or (k == 0 and much)
        touches[k] = ways.least[at] < motion_margins[k] or ways.proven[at] < ENOUGH or ((k > 0 or gentle) and much)
    return checks, harsh


@exact_kernel
def _stiffened(stiff: Bools, touches: Bools) -> bool:
    """Make the key times (n+1,) stiff at both ends of the intervals (n,) that touch; whether any does."""
    found = False
    for k in range(touches.shape[0]):
        if touches[k]:
            stiff[k], stiff[k + 1], found = True, True, True
    return found


@exact_kernel
def _closing(lattice: Lattice, edges: ClosedEdges) -> Lattice:
    """The same lattice with other tables of closed edges."""
    return Lattice(
        lattice.postures,
        lattice.columns,
        lattice.moves,
        lattice.spans,
        lattice.own,
        lattice.goals,
        lattice.cost,
        edges.tables,
        edges.closed,
        lattice.previous,
        lattice.step,
        lattice.weight,
    )


@exact_kernel
def _close(lattice: Lattice, work: Work, edges: ClosedEdges, way: Longs, touches: Bools) -> tuple[int, float]:
    """Close the steps of a way in the intervals where it touches, and those near to them; each has a table.

    Returns the first of these intervals and how much dearer ways are to be looked at.
    """
    first, farthest = touches.shape[0], 0.0
    for k in range(touches.shape[0] - 1, -1, -1):
        if touches[k]:
            first = k
            close_near(lattice, work, k, way[k], way[k + 1], _BAN_RADIUS)
            at = edges.tables[k]
            slack = max(2.0 * edges.slack[at], _FIRST_SLACK)
            edges.slack[at], farthest = slack, max(farthest, slack)
    return first, farthest


@exact_kernel
def _close_promising(
    scratch: Scratch,
    postures: Postures,
    carriers: Carriers,
    obstacles: Spans,
    motion_margins: Floats,
    lattice: Lattice,
    work: Work,
    edges: ClosedEdges,
    steps: Longs,
    first: int,
    best: float,
) -> int:
    """Look at the steps of key intervals with a table, from `first` on, through which ways lead that cost little more
    than the `best`; close those that touch. Returns the capsules checked; `steps` (MOST_STEPS, 2) is scratch."""
    checks = 0
    for k in range(first, motion_margins.shape[0]):
        at = edges.tables[k]
        if at >= 0:
            count = promising_edges(lattice, work, k, best + edges.slack[at], edges.seen[at], steps)
            if count == MOST_EDGES:
                edges.slack[at] *= 0.5  # there are more of them: the same once again
            if count:
                places, turns = carriers.places[k], carriers.turns[k]
                checks += close_edges(
                    scratch, postures, lattice, k, steps, count, places, turns, at_span(obstacles, k), motion_margins[k]
                )
    return checks


@helper
def _priced(
    scratch: Scratch, cache: GroupCache, task: GroupTask, weights: Weights, edges: ClosedEdges
) -> tuple[Lattice, Carriers, float, int]:
    """The lattice of a task with its nodes' costs, all edges open; and what carries the limb.

    Also the greatest clearance that may be asked for, and the capsules checked.
    """
    group, roots, waists, _ = cache
    postures = group.postures
    begin_round(group.tables.entries)
    own, needed, previous = extra_nodes(
        postures.configurations, postures.columns, postures.step, task.goals, task.previous, task.start, task.settled
    )
    if postures.limb.is_waist:
        carriers = carriers_at(roots.entries.ids, roots.places, roots.turns, task.roots)
    else:
        carriers = carriers_at(waists.entries.ids, waists.places, waists.turns, task.carriers)
    cost, clear = np.empty(task.extra.shape, np.float32), np.empty(task.extra.shape, np.float32)
    most, checks = node_costs(
        scratch, group.tables, postures, carriers, task, weights, own, needed, previous, clear, cost
    )
    lattice = Lattice(
        postures.configurations,
        postures.columns,
        postures.moves,
        postures.spans,
        own,
        task.goals,
        cost,
        edges.tables,
        edges.closed,
        previous,
        postures.step,
        weights.step,
    )
    return lattice, carriers, most, checks


@exact_kernel
def search_group(cache: GroupCache, task: GroupTask, weights: Weights) -> GroupPath:
    """The cheapest way whose motion is free as shown, at every moment.

    It begins gently; if there is no such way, only who is told so begins as hard as it takes.
    """
    group, roots, waists, chain = cache
    postures, goals, obstacles = group.postures, task.goals, task.obstacles
    horizon, nodes_in_row = goals.shape[0] - 1, postures.moves.shape[1] + EXTRA
    scratch, steps = new_scratch(postures, chain.waist, at_span(obstacles, 0)), np.empty((MOST_EDGES, 2), np.int64)
    work, edges = new_work(horizon + 1, nodes_in_row), new_closed_edges(horizon, nodes_in_row)
    lattice, carriers, most, checks = _priced(scratch, cache, task, weights, edges)
    entries, motion_margins = np.empty(horizon, np.int64), np.minimum(task.motion_margins, most)
    touches, stiff = np.zeros(horizon, np.bool_), np.empty(horizon + 1, np.bool_)
    first, deepest, spent, nodes, gentle, harsh = _BEGIN, 0, weights.rounds, 0, True, False
    keys, tangents = np.empty(goals.shape), np.empty(goals.shape)
    for rounds in range(weights.rounds):
        reached, count = cheapest_path(lattice, work, first, rounds == 0)
        nodes += count
        way = traced(lattice, work, reached)
        set_keys(lattice, way, keys)
        if reached < horizon and gentle and harsh and task.harsh:
            gentle, first = False, _BEGIN
            reopen_first(edges)
            continue
        if reached < horizon:
            deepest, spent = reached, rounds
            break
        stiff[:] = False
        for attempt in range(2):
            tangents = smooth_tangents(keys, task.interval, task.velocity, group.limits, stiff)
            count, asks_much = _proven(
                scratch, group, roots, waists, chain, task, keys, tangents, motion_margins, entries, touches, gentle
            )
            checks, harsh = checks + count, harsh or asks_much
            if attempt == 1 or not _stiffened(stiff, touches):
                break
        if not touches.any():
            deepest, spent = horizon, rounds + 1
            break
        nodes += widen(lattice, work)
        edges = with_tables(edges, touches)
        lattice = _closing(lattice, edges)
        first, farthest = _close(lattice, work, edges, way, touches)
        deepest = max(deepest, first)
        best = least_in(work.costs[horizon])
        settle_backward(lattice, work, first, best + farthest)
        checks += _close_promising(
            scratch, postures, carriers, obstacles, motion_margins, lattice, work, edges, steps, first, best
        )
    until = deepest + 1
    return GroupPath(deepest, keys[:until], tangents[:until], entries, lattice.cost, most, checks, nodes, spent)
