"""The way of one group along a root path: cheapest through the lattice, then proven as it will be shown.

A way that touches between its key frames is banned there, with the steps near it; where that happens, the steps of
that key interval through which the next ways would lead are looked at in one batch, and the next cheapest way is taken.
So steps are swept only where the search is blocked, and every candidate is swept as a whole. It is one compiled call.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.held import Held
from elbowroom.jit import exact_kernel, exact_lean_kernel, inlined
from elbowroom.planning.exact.group.caches import Shelf
from elbowroom.planning.exact.group.node_costs import Carriers, carriers_at, node_prices
from elbowroom.planning.exact.group.problem import Group, GroupTask, GroupWay, Weights
from elbowroom.planning.exact.lattice.closed_edges import Masks, known_masks, mask_keys, new_mask, reopen
from elbowroom.planning.exact.lattice.dynamic_programming import cheapest_way, settle_backward, widen
from elbowroom.planning.exact.lattice.extra_nodes import alone_at
from elbowroom.planning.exact.lattice.lattice import Lattice, Work, least_in
from elbowroom.planning.exact.lattice.paths import set_keys, traced
from elbowroom.planning.exact.lattice.postures import Postures
from elbowroom.planning.exact.lattice.tangents import peak_acceleration, peak_speed, smooth_tangents
from elbowroom.planning.exact.memory.cache_index import begin_round
from elbowroom.planning.exact.sweep.edges import MOST_STEPS, ban_near, close_steps, promising
from elbowroom.planning.exact.sweep.motion_bounds import Chain, LimbWays, RootWays
from elbowroom.planning.exact.sweep.proof import ENOUGH, Carrier, limb_way_in
from elbowroom.planning.exact.sweep.scratch import Workroom, workroom

Floats = NDArray[np.float64]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

_BAN_RADIUS = 0.1  # radians: steps so near to one that touches are banned with it
_FIRST_SLACK = 0.1  # squared radians: how much dearer ways are looked at where one touches; doubled when those were
_BEGIN = 0  # the depth at which the search begins


@inlined
def _carrier(roots: RootWays, waists: LimbWays, task: GroupTask, k: int, is_waist: bool) -> Carrier:
    """What carries the limb in interval k, as a proof needs it."""
    root = task.roots[k]
    states, heights = roots.slots.keys[root], roots.places[root]
    if is_waist:
        return Carrier(roots.slots.ids[root], heights, roots.turns[root], roots.sway[root], states, heights, states)
    at = task.carriers[k]
    return Carrier(
        waists.slots.ids[at], waists.places[at], waists.turns[at], waists.sway[at], states, heights,
        waists.slots.keys[at],
    )  # fmt: skip


@exact_lean_kernel
def _proven(
    room: Workroom, group: Group, roots: RootWays, waists: LimbWays, chain: Chain, task: GroupTask, keys: Floats,
    tangents: Floats, skins: Floats, slots: Longs, touches: Bools, gentle: bool,
) -> tuple[int, bool]:  # fmt: skip
    """Prove the curve through `keys` (n+1, d) free: `touches` (n,) where it is not; the capsules checked.

    An interval fails too if its curve is faster than the group or asks for too much acceleration, the first only if it
    has to be `gentle`. Also whether that does. The ways through the intervals are put into `slots` (n,).
    """
    ways, postures, levers, checks = group.ways, group.postures, group.levers, 0
    is_waist, harsh = postures.limb.is_waist, False
    begin_round(ways.slots)
    for k in range(slots.shape[0]):
        carrier = _carrier(roots, waists, task, k, is_waist)
        ends = (keys[k], tangents[k], keys[k + 1], tangents[k + 1])
        at, count = limb_way_in(room, ways, postures, levers, chain, carrier, ends, task.boxes[k], skins[k])
        slots[k] = at
        checks += count
        much = peak_acceleration(keys[k], tangents[k], keys[k + 1], tangents[k + 1], task.interval) > group.acceleration
        much = much or peak_speed(keys[k], tangents[k], keys[k + 1], tangents[k + 1], task.interval) > group.speed
        harsh = harsh or (k == 0 and much)
        touches[k] = ways.least[at] < skins[k] or ways.proven[at] < ENOUGH or ((k > 0 or gentle) and much)
    return checks, harsh


@exact_lean_kernel
def _stiffened(stiff: Bools, touches: Bools) -> bool:
    """Make the key times (n+1,) stiff at both ends of the intervals (n,) that touch; whether any does."""
    found = False
    for k in range(touches.shape[0]):
        if touches[k]:
            stiff[k], stiff[k + 1], found = True, True, True
    return found


@exact_lean_kernel
def _closed(lattice: Lattice, work: Work, masks: Masks, keys: Floats, way: Longs, touches: Bools) -> tuple[int, float]:
    """Close the steps of a way in the intervals where it touches, and those near to them.

    Returns the first of these intervals and how much dearer ways are to be looked at.
    """
    first, farthest = touches.shape[0], 0.0
    for k in range(touches.shape[0] - 1, -1, -1):
        if touches[k]:
            first = k
            if lattice.masks[k] < 0:
                lattice.masks[k] = new_mask(masks, keys[k])
            ban_near(lattice, work, k, way[k], way[k + 1], _BAN_RADIUS)
            slack = max(2.0 * masks.slack[lattice.masks[k]], _FIRST_SLACK)
            masks.slack[lattice.masks[k]], farthest = slack, max(farthest, slack)
    return first, farthest


@exact_lean_kernel
def _close_promising(
    room: Workroom, postures: Postures, carriers: Carriers, boxes: Floats, skins: Floats, lattice: Lattice, work: Work,
    masks: Masks, steps: Longs, first: int, best: float,
) -> int:  # fmt: skip
    """Look at the steps of key intervals with a mask, from `first` on, through which ways lead that cost little more
    than the `best`; close those that touch. Returns the capsules checked; `steps` (MOST_STEPS, 2) is scratch."""
    checks = 0
    for k in range(first, skins.shape[0]):
        at = lattice.masks[k]
        if at >= 0:
            count = promising(lattice, work, k, best + masks.slack[at], masks.seen[at], steps)
            if count == MOST_STEPS:
                masks.slack[at] *= 0.5  # there are more of them: the same once again
            if count:
                places, turns = carriers.places[k], carriers.turns[k]
                checks += close_steps(room, postures, lattice, k, steps, count, places, turns, boxes[k], skins[k])
    return checks


@exact_kernel
def search_group(shelf: Held[Shelf], task: GroupTask, weights: Weights) -> GroupWay:
    """The cheapest way whose motion is free as shown, at every moment.

    It begins gently; if there is no such way, only who is told so begins as hard as it takes.
    """
    group, roots, waists, chain, work = shelf.value
    postures, masks, goals, boxes = group.postures, group.masks, task.goals, task.boxes
    configurations, columns = postures.configurations, postures.columns
    interval, limits, horizon = task.interval, group.limits, goals.shape[0] - 1
    room, steps = workroom(postures, chain.waist, boxes.shape[1]), np.empty((MOST_STEPS, 2), np.int64)
    begin_round(group.tables.slots)
    own, needed, kept = alone_at(configurations, columns, postures.step, goals, task.kept, task.start, task.settled)
    if postures.limb.is_waist:
        carriers = carriers_at(roots.slots.ids, roots.places, roots.turns, task.roots)
    else:
        carriers = carriers_at(waists.slots.ids, waists.places, waists.turns, task.carriers)
    price, clear = np.empty(task.extra.shape, np.float32), np.empty(task.extra.shape, np.float32)
    most, checks = node_prices(room, group.tables, postures, carriers, task, weights, own, needed, kept, clear, price)
    named = mask_keys(carriers.ids, goals)
    lattice = Lattice(
        configurations, columns, postures.moves, postures.spans, own, goals, price, known_masks(masks, named, kept),
        masks.closed, kept, postures.step, weights.step,
    )  # fmt: skip
    slots, skins = np.empty(horizon, np.int64), np.empty(horizon)
    touches, stiff = np.empty(horizon, np.bool_), np.empty(horizon + 1, np.bool_)
    touches[:] = False
    for k in range(horizon):
        skins[k] = min(task.skins[k], most)
    first, deepest, spent, nodes, gentle, harsh = int(_BEGIN), 0, weights.rounds, 0, True, False
    keys, tangents = np.empty(goals.shape), np.empty(goals.shape)
    for rounds in range(weights.rounds):
        reached, count = cheapest_way(lattice, work, first, rounds == 0)
        nodes += count
        way = traced(lattice, work, reached)
        set_keys(lattice, way, keys)
        if reached < horizon and gentle and harsh and task.harsh:
            gentle, first = False, int(_BEGIN)
            reopen(masks, lattice.masks[0])
            continue
        if reached < horizon:
            deepest, spent = reached, rounds
            break
        stiff[:] = False
        for attempt in range(2):
            tangents = smooth_tangents(keys, interval, task.velocity, limits, stiff)
            count, asks_much = _proven(
                room, group, roots, waists, chain, task, keys, tangents, skins, slots, touches, bool(gentle)
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
        checks += _close_promising(room, postures, carriers, boxes, skins, lattice, work, masks, steps, first, best)
    until = deepest + 1
    return GroupWay(deepest, keys[:until], tangents[:until], slots, price, most, checks, nodes, spent)
