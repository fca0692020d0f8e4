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
    admit_closed_edges,
    closed_edge_keys,
    known_closed_edges,
    reopen,
)
from elbowroom.planning.exact.lattice.dynamic_programming import cheapest_path, settle_backward, widen
from elbowroom.planning.exact.lattice.extra_nodes import extra_nodes
from elbowroom.planning.exact.lattice.lattice import Lattice, Work, least_in
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
def _closed(
    lattice: Lattice, work: Work, masks: ClosedEdges, keys: Floats, way: Longs, touches: Bools
) -> tuple[int, float]:
    """Close the steps of a way in the intervals where it touches, and those near to them.

    Returns the first of these intervals and how much dearer ways are to be looked at.
    """
    first, farthest = touches.shape[0], 0.0
    for k in range(touches.shape[0] - 1, -1, -1):
        if touches[k]:
            first = k
            if lattice.masks[k] < 0:
                lattice.masks[k] = admit_closed_edges(masks, keys[k])
            close_near(lattice, work, k, way[k], way[k + 1], _BAN_RADIUS)
            slack = max(2.0 * masks.slack[lattice.masks[k]], _FIRST_SLACK)
            masks.slack[lattice.masks[k]], farthest = slack, max(farthest, slack)
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
    masks: ClosedEdges,
    steps: Longs,
    first: int,
    best: float,
) -> int:
    """Look at the steps of key intervals with a mask, from `first` on, through which ways lead that cost little more
    than the `best`; close those that touch. Returns the capsules checked; `steps` (MOST_STEPS, 2) is scratch."""
    checks = 0
    for k in range(first, motion_margins.shape[0]):
        at = lattice.masks[k]
        if at >= 0:
            count = promising_edges(lattice, work, k, best + masks.slack[at], masks.seen[at], steps)
            if count == MOST_EDGES:
                masks.slack[at] *= 0.5  # there are more of them: the same once again
            if count:
                places, turns = carriers.places[k], carriers.turns[k]
                checks += close_edges(
                    scratch, postures, lattice, k, steps, count, places, turns, at_span(obstacles, k), motion_margins[k]
                )
    return checks


@exact_kernel
def search_group(cache: GroupCache, task: GroupTask, weights: Weights) -> GroupPath:
    """The cheapest way whose motion is free as shown, at every moment.

    It begins gently; if there is no such way, only who is told so begins as hard as it takes.
    """
    group, roots, waists, chain, work = cache
    postures, masks, goals, obstacles = group.postures, group.masks, task.goals, task.obstacles
    configurations, columns = postures.configurations, postures.columns
    interval, limits, horizon = task.interval, group.limits, goals.shape[0] - 1
    scratch, steps = new_scratch(postures, chain.waist, at_span(obstacles, 0)), np.empty((MOST_EDGES, 2), np.int64)
    begin_round(group.tables.entries)
    own, needed, previous = extra_nodes(
        configurations, columns, postures.step, goals, task.previous, task.start, task.settled
    )
    if postures.limb.is_waist:
        carriers = carriers_at(roots.entries.ids, roots.places, roots.turns, task.roots)
    else:
        carriers = carriers_at(waists.entries.ids, waists.places, waists.turns, task.carriers)
    cost, clear = np.empty(task.extra.shape, np.float32), np.empty(task.extra.shape, np.float32)
    most, checks = node_costs(
        scratch, group.tables, postures, carriers, task, weights, own, needed, previous, clear, cost
    )
    named = closed_edge_keys(carriers.ids, goals)
    lattice = Lattice(
        configurations,
        columns,
        postures.moves,
        postures.spans,
        own,
        goals,
        cost,
        known_closed_edges(masks, named, previous),
        masks.closed,
        previous,
        postures.step,
        weights.step,
    )
    entries, motion_margins = np.empty(horizon, np.int64), np.empty(horizon)
    touches, stiff = np.empty(horizon, np.bool_), np.empty(horizon + 1, np.bool_)
    touches[:] = False
    for k in range(horizon):
        motion_margins[k] = min(task.motion_margins[k], most)
    first, deepest, spent, nodes, gentle, harsh = _BEGIN, 0, weights.rounds, 0, True, False
    keys, tangents = np.empty(goals.shape), np.empty(goals.shape)
    for rounds in range(weights.rounds):
        reached, count = cheapest_path(lattice, work, first, rounds == 0)
        nodes += count
        way = traced(lattice, work, reached)
        set_keys(lattice, way, keys)
        if reached < horizon and gentle and harsh and task.harsh:
            gentle, first = False, _BEGIN
            reopen(masks, lattice.masks[0])
            continue
        if reached < horizon:
            deepest, spent = reached, rounds
            break
        stiff[:] = False
        for attempt in range(2):
            tangents = smooth_tangents(keys, interval, task.velocity, limits, stiff)
            count, asks_much = _proven(
                scratch,
                group,
                roots,
                waists,
                chain,
                task,
                keys,
                tangents,
                motion_margins,
                entries,
                touches,
                bool(gentle),
            )
            checks, harsh = checks + count, harsh or asks_much
            if attempt == 1 or not _stiffened(stiff, touches):
                break
        if not touches.any():
            deepest, spent = horizon, rounds + 1
            break
        nodes += widen(lattice, work)
        first, farthest = _closed(lattice, work, masks, named, way, touches)
        deepest = max(deepest, first)
        best = least_in(work.costs[horizon])
        settle_backward(lattice, work, first, best + farthest)
        checks += _close_promising(
            scratch, postures, carriers, obstacles, motion_margins, lattice, work, masks, steps, first, best
        )
    until = deepest + 1
    return GroupPath(deepest, keys[:until], tangents[:until], entries, cost, most, checks, nodes, spent)
