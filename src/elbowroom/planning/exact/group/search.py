"""The path of one group along a root path: cheapest through the lattice, then proven as it will be shown.

Nodes are looked at where a cheapest path leads through them (`node_costs`), and all about where one touches. Where a
path touches between its key times the edge is closed, with those near to it; then the edges of that interval, and of
those next to it, through which the next paths would lead are checked in one batch, and the next cheapest path is taken.
Where paths touch in one place after the other, edges are checked twice as far away each time: what no path gets past is
in the way for many intervals. So edges are swept only where the search is blocked, and every candidate is swept as a
whole. It is one compiled call.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, plain
from elbowroom.planning.exact.group.caches import GroupCache
from elbowroom.planning.exact.group.carriers import Carriers, carrier_in, carriers_of
from elbowroom.planning.exact.group.node_costs import NodeCosts, NodeLooks, begun_costs, look_along
from elbowroom.planning.exact.group.problem import GroupPath, GroupTask, Weights
from elbowroom.planning.exact.lattice.closed_edges import ClosedEdges, reopen_first, with_tables
from elbowroom.planning.exact.lattice.dynamic_programming import cheapest_path, settle_backward, widen
from elbowroom.planning.exact.lattice.extra_nodes import extra_nodes
from elbowroom.planning.exact.lattice.lattice import EXTRA, Lattice, Work, least_in, new_work
from elbowroom.planning.exact.lattice.paths import keys_into, traced
from elbowroom.planning.exact.lattice.tangents import peak_acceleration, peak_speed, smooth_tangents
from elbowroom.planning.exact.memory.cache_index import begin_round
from elbowroom.planning.exact.sweep.edges import MOST_EDGES, close_edges, close_near, promising_edges
from elbowroom.planning.exact.sweep.motion_bounds import LimbSweeps
from elbowroom.planning.exact.sweep.proof import MovedLimb, limb_sweep
from elbowroom.planning.exact.sweep.scratch import Scratch
from elbowroom.planning.halving import ENOUGH
from elbowroom.world.obstacles.layout import Spans
from elbowroom.world.obstacles.rows import at_span

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

_CLOSE_RADIUS = 0.1  # radians: edges so near to one that touches are closed with it, and
_CLOSE_MORE = 0.0125  # so much farther about each that touches later
_FIRST_SLACK = 0.1  # squared radians: how much dearer paths are checked where one touches; doubled when those were
_BEGIN = plain(0)  # the depth at which the search begins
_GENTLY = plain(True)  # how it begins
_NEXT = plain(1)  # intervals before and after one that touches that are looked at with it
_WIDELY = plain(False)
_LOOKS = 4  # along so many paths before all nodes are looked at


class _Question(NamedTuple):
    """What one search is about, and what it works on: only what is asked for again and again.

    A kernel copies a tuple, with all that is in it, wherever it names it: a whole cache or task takes long to compile.
    """

    scratch: Scratch
    sweeps: LimbSweeps
    limb: MovedLimb
    carriers: Carriers
    obstacles: Spans
    margins: Floats  # (n,) clearance that the motion needs in each interval, metres
    speed: float  # the greatest of the group, rad/s, and
    acceleration: float  # rad/s^2


@helper
def _proven(
    question: _Question, interval: float, curve: tuple[Floats, Floats], gentle: bool, entries: Longs, touches: Bools
) -> tuple[int, bool]:
    """Prove the curve through keys (n+1, d) with tangents free: `touches` (n,) where it is not; the capsules checked.

    An interval of so many seconds fails too if its curve is faster than the group or asks for too much acceleration,
    the first only if it has to be `gentle`. Also whether that does. The cache entries of the sweeps are written to
    `entries` (n,).
    """
    scratch, sweeps, limb, carriers, obstacles, margins, speed, acceleration = question
    (keys, tangents), checks, harsh = curve, 0, False
    begin_round(sweeps.entries)
    for k in range(entries.shape[0]):
        a, m, b, n = keys[k], tangents[k], keys[k + 1], tangents[k + 1]
        carrier, near = carrier_in(carriers, k), at_span(obstacles, k)
        at, count = limb_sweep(scratch, sweeps, limb, carrier, (a, m, b, n), near, margins[k])
        entries[k] = at
        checks += count
        much = peak_acceleration(a, m, b, n, interval) > acceleration or peak_speed(a, m, b, n, interval) > speed
        harsh = harsh or (k == 0 and much)
        touches[k] = sweeps.least[at] < margins[k] or sweeps.proven[at] < ENOUGH or ((k > 0 or gentle) and much)
    return checks, harsh


@helper
def _stiffened(stiff: Bools, touches: Bools) -> bool:
    """Make the key times (n+1,) stiff at both ends of the intervals (n,) that touch; whether any does."""
    found = False
    for k in range(touches.shape[0]):
        if touches[k]:
            stiff[k], stiff[k + 1], found = True, True, True
    return found


@helper
def _closing(lattice: Lattice, edges: ClosedEdges) -> Lattice:
    """The same lattice with other tables of closed edges."""
    return Lattice(
        lattice.postures,
        lattice.extras,
        lattice.goals,
        lattice.cost,
        edges.tables,
        edges.closed,
        lattice.previous,
        lattice.weight,
    )


@helper
def _is_elsewhere(edges: ClosedEdges, touches: Bools) -> bool:
    """Whether an interval touches that was not looked at before, nor is near to one that was."""
    found = False
    for k in range(touches.shape[0]):
        found |= touches[k] and edges.tables[k] < 0
    return found


@helper
def _near_to(touches: Bools, far: int) -> Bools:
    """The intervals (n,) that touch, and those up to so many before and after them.

    What is in the way in one is often in the way in these, and the next path would lead through it there.
    """
    near = np.zeros_like(touches)
    for k in range(touches.shape[0]):
        if touches[k]:
            near[max(k - far, 0) : k + far + 1] = True
    return near


@helper
def _close(
    lattice: Lattice, work: Work, edges: ClosedEdges, nodes: Longs, touches: Bools, looked_at: Bools, radius: float
) -> tuple[int, float]:
    """Close the edges of a path through `nodes` (n+1,) in the intervals where it touches, and those within `radius`.

    Each interval that is `looked_at` (n,) has a table. Returns the first of them and how much dearer paths are to be
    checked.
    """
    first, farthest = touches.shape[0], 0.0
    tables, _, _, slacks = edges
    for k in range(touches.shape[0] - 1, -1, -1):
        if touches[k]:
            close_near(lattice, work, k, nodes[k], nodes[k + 1], radius)
        if looked_at[k]:
            first, at = k, tables[k]
            slack = max(2.0 * slacks[at], _FIRST_SLACK)
            slacks[at], farthest = slack, max(farthest, slack)
    return first, farthest


@helper
def _close_promising(
    question: _Question, lattice: Lattice, work: Work, edges: ClosedEdges, first: int, best: float
) -> int:
    """Check the edges through which paths lead that cost little more than the `best`; close those that touch.

    Of the intervals with a table, from `first` on. Returns the capsules checked.
    """
    scratch, _, _, carriers, obstacles, margins, _, _ = question
    tables, _, seen, slack = edges
    places, turns = carriers.places, carriers.turns
    pairs, checks = np.empty((MOST_EDGES, 2), np.int64), 0
    for k in range(first, margins.shape[0]):
        at = tables[k]
        if at >= 0:
            count = promising_edges(lattice, work, k, best + slack[at], seen[at], pairs)
            if count == MOST_EDGES:
                slack[at] *= 0.5  # there are more of them: the same once again
            if count:
                carrier, near = (places[k], turns[k]), at_span(obstacles, k)
                checks += close_edges(scratch, lattice, k, pairs[:count], carrier, near, margins[k])
    return checks


@helper
def _begun(
    scratch: Scratch, cache: GroupCache, task: GroupTask, weights: Weights, edges: ClosedEdges
) -> tuple[_Question, Lattice, NodeLooks, NodeCosts, float, int]:
    """The lattice of a task, no node looked at, and what the search works on.

    Also the greatest clearance that may be asked for, and the capsules checked.
    """
    group, chain, postures, known = cache.group, cache.chain, cache.group.postures, cache.group.tables
    obstacles, goals = task.obstacles, task.goals
    carriers = carriers_of(cache.roots, cache.waists, task.roots, task.carriers, postures.limb.chain.carries)
    begin_round(known.entries)
    extras = extra_nodes(
        postures.configurations, postures.columns, postures.step, goals, task.previous, task.start, task.settled
    )
    looks = NodeLooks(scratch, postures, known, carriers, obstacles, goals, extras)
    nodes, most, checks = begun_costs(looks, task, weights)
    lattice = Lattice(
        postures,
        extras.postures,
        goals,
        nodes.cost,
        edges.tables,
        edges.closed,
        extras.previous,
        weights.step,
    )
    margins, limb = np.minimum(task.motion_margins, most), MovedLimb(postures, group.levers, chain)
    question = _Question(scratch, group.sweeps, limb, carriers, obstacles, margins, group.speed, group.acceleration)
    return question, lattice, looks, nodes, most, checks


@helper
def _cheapest(
    lattice: Lattice, work: Work, looks: NodeLooks, nodes: NodeCosts, weights: Weights, first: int, narrow: bool
) -> tuple[int, Longs, int, int, int]:
    """The greatest depth that is reached, and the nodes of the cheapest path to there, all of which were looked at.

    It is sought from the depth `first` on, narrowly if that is enough. Also the first depth from which on other nodes
    have grown dearer since they were settled, the nodes settled, and the capsules checked.
    """
    settled, checks, last, looked, whole = 0, 0, nodes.tables.shape[0], 0, np.zeros(nodes.tables.shape, np.bool_)
    while True:
        reached, count = cheapest_path(lattice, work, first, narrow)
        path, settled = traced(lattice, work, reached), settled + count
        whole[:] = reached < last or looked >= _LOOKS
        changed, dearer, count = look_along(looks, nodes, path[:0] if reached < last else path, whole, weights)
        checks, looked = checks + count, looked + 1
        if changed > last or (reached == last and not dearer):
            return reached, path, max(changed - 1, _BEGIN), settled, checks
        first = _BEGIN if narrow else min(max(changed - 1, _BEGIN), reached)


@helper
def _settled(
    lattice: Lattice, work: Work, looks: NodeLooks, nodes: NodeCosts, weights: Weights, whole: Bools, stale: int
) -> tuple[int, int]:
    """Look at all nodes of some intervals (n,); settle what is not: from `stale` on, or left out by a narrow search.

    Returns the nodes settled and the capsules checked.
    """
    changed, _, checks = look_along(looks, nodes, nodes.tables[:0], whole, weights)
    begin, last = min(max(changed - 1, _BEGIN), stale), nodes.tables.shape[0]
    if begin >= last:
        return widen(lattice, work), checks
    _, settled = cheapest_path(lattice, work, begin, _WIDELY)
    return settled, checks


@exact_kernel
def search_group(
    scratch: Scratch, cache: GroupCache, task: GroupTask, weights: Weights, edges: ClosedEdges
) -> tuple[GroupPath, ClosedEdges]:
    """The cheapest path whose motion is free as shown, at every moment, and the edges that are closed then.

    Some may be closed already, by an earlier search under the same carrier for the same goals. It begins gently; if
    there is no such path, and the task allows it, it begins as hard as it takes.
    """
    goals, interval, velocity, may_be_harsh = task.goals, task.interval, task.velocity, task.harsh
    limits, most_rounds = cache.group.limits, weights.rounds
    horizon, row = goals.shape[0] - 1, cache.group.postures.moves.shape[1] + EXTRA
    work = new_work(horizon + 1, row)
    question, lattice, looks, nodes, most, checks = _begun(scratch, cache, task, weights, edges)
    if task.whole:
        checks += look_along(looks, nodes, nodes.tables[:0], np.ones(horizon, np.bool_), weights)[2]
    entries = np.empty(horizon, np.int64)
    touches, stiff = np.zeros(horizon, np.bool_), np.empty(horizon + 1, np.bool_)
    first, far, deepest, spent, settled, gentle, harsh = _BEGIN, _NEXT, 0, most_rounds, 0, _GENTLY, False
    keys, tangents = np.empty(goals.shape), np.empty(goals.shape)
    for rounds in range(most_rounds):
        reached, path, stale, count, more = _cheapest(lattice, work, looks, nodes, weights, first, rounds == 0)
        settled, checks = settled + count, checks + more
        keys_into(lattice, path, keys)
        if reached < horizon and gentle and harsh and may_be_harsh:
            gentle, first = False, _BEGIN
            reopen_first(edges)
            continue
        if reached < horizon:
            deepest, spent = reached, rounds
            break
        stiff[:] = False
        for attempt in range(2):
            tangents = smooth_tangents(keys, interval, velocity, limits, stiff)
            count, asks_much = _proven(question, interval, (keys, tangents), gentle, entries, touches)
            checks, harsh = checks + count, harsh or asks_much
            if attempt == 1 or not _stiffened(stiff, touches):
                break
        if not touches.any():
            deepest, spent = horizon, rounds + 1
            break
        far = 2 * far if rounds > 0 and _is_elsewhere(edges, touches) else far
        looked_at = _near_to(touches, far)
        count, more = _settled(lattice, work, looks, nodes, weights, looked_at, stale)
        settled, checks = settled + count, checks + more
        edges = with_tables(edges, looked_at)
        lattice = _closing(lattice, edges)
        first, farthest = _close(lattice, work, edges, path, touches, looked_at, _CLOSE_RADIUS + rounds * _CLOSE_MORE)
        deepest = max(deepest, first)
        best = least_in(work.costs[horizon])
        settle_backward(lattice, work, first, best + farthest)
        checks += _close_promising(question, lattice, work, edges, first, best)
    until = deepest + 1
    found = GroupPath(deepest, keys[:until], tangents[:until], entries, lattice.cost, most, checks, settled, spent)
    return found, edges
