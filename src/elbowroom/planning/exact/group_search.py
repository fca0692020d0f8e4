"""The way of one group along a root path: cheapest through the lattice, then proven as it will be shown.

A way that touches between its key frames is banned there, with the steps near it; where that happens, the steps of
that key interval through which the next ways would lead are looked at in one batch, and the next cheapest way is taken.
So steps are swept only where the search is blocked, and every candidate is swept as a whole. It is one compiled call.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.held import Held
from elbowroom.jit import exact_kernel, exact_lean_kernel, inlined
from elbowroom.planning.exact.alone import alone_into
from elbowroom.planning.exact.curve import peak_acceleration, peak_speed, tangents_into
from elbowroom.planning.exact.group import Group, GroupTask, GroupWay, Weights
from elbowroom.planning.exact.lattice import Lattice, Work, cheapest_way, least_in, set_keys, settle_backward, trace
from elbowroom.planning.exact.masks import Masks, find_masks, new_mask, reopen, set_mask_keys
from elbowroom.planning.exact.postures import Postures
from elbowroom.planning.exact.prices import Carriers, node_prices, set_carriers
from elbowroom.planning.exact.proof import ENOUGH, Carrier, limb_way_in
from elbowroom.planning.exact.search_room import SearchRoom, search_room
from elbowroom.planning.exact.shelves import Shelf
from elbowroom.planning.exact.slots import begin_round
from elbowroom.planning.exact.steps import MOST_STEPS, ban_near, close_steps, promising
from elbowroom.planning.exact.ways import Chain, LimbWays, RootWays
from elbowroom.planning.exact.workroom import Workroom, workroom

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

    Returns the first of these intervals, n if there is none, and how much dearer ways are to be looked at.
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


@exact_lean_kernel
def _begun(it: Shelf, task: GroupTask, weights: Weights, room: Workroom, made: SearchRoom) -> tuple[float, int]:
    """Find what the nodes cost, and what is asked of the motion between them.

    Returns the greatest clearance that may be asked for, half of what the start has, and the capsules checked.
    """
    group, postures, alone = it.group, it.group.postures, made.alone
    begin_round(group.tables.slots)
    alone_into(
        postures.configurations, postures.columns, postures.step, task.goals, task.kept, task.start, task.settled, alone
    )
    if postures.limb.is_waist:
        set_carriers(it.roots.slots.ids, it.roots.places, it.roots.turns, task.roots, made.carriers)
    else:
        set_carriers(it.waists.slots.ids, it.waists.places, it.waists.turns, task.carriers, made.carriers)
    most, checks = node_prices(
        room, group.tables, postures, made.carriers, task, weights, alone.own, alone.needed, alone.kept, made.clear,
        made.price,
    )  # fmt: skip
    set_mask_keys(made.carriers.ids, task.goals, made.named)
    find_masks(group.masks, made.named, alone.kept, made.masks)
    for k in range(made.skins.shape[0]):
        made.skins[k] = min(task.skins[k], most)
    return most, checks


@exact_lean_kernel
def _curved(it: Shelf, task: GroupTask, room: Workroom, made: SearchRoom, gentle: bool) -> tuple[int, bool]:
    """Lay the curve through a way's key postures and prove it, once more where it touches and could be stiffer.

    Returns the capsules checked, and whether the beginning asks for much.
    """
    checks, harsh = 0, False
    made.stiff[:] = False
    for attempt in range(2):
        tangents_into(made.keys, task.interval, task.velocity, it.group.limits, made.stiff, made.tangents)
        count, asks_much = _proven(
            room, it.group, it.roots, it.waists, it.chain, task, made.keys, made.tangents, made.skins, made.slots,
            made.touches, gentle,
        )  # fmt: skip
        checks, harsh = checks + count, harsh or asks_much
        if attempt == 1 or not _stiffened(made.stiff, made.touches):
            break
    return checks, harsh


@exact_lean_kernel
def _search(
    it: Shelf, task: GroupTask, weights: Weights, room: Workroom, made: SearchRoom
) -> tuple[int, int, float, int, int, int]:
    """`search_group`, with room to work in: what it reached, keys that hold, and the last of a `GroupWay`."""
    postures, masks, horizon = it.group.postures, it.group.masks, task.goals.shape[0] - 1
    most, checks = _begun(it, task, weights, room, made)
    lattice = Lattice(
        postures.configurations, postures.columns, postures.moves, postures.spans, made.alone.own, task.goals,
        made.price, made.masks, masks.closed, made.alone.kept, postures.step, weights.step,
    )  # fmt: skip
    first, deepest, nodes, gentle, harsh = int(_BEGIN), 0, 0, True, False
    for rounds in range(weights.rounds):
        reached, count = cheapest_way(lattice, it.work, first)
        nodes += count
        trace(lattice, it.work, reached, made.way)
        set_keys(lattice, made.way, reached, made.keys)
        if reached < horizon and gentle and harsh and task.harsh:
            gentle, first = False, int(_BEGIN)
            reopen(masks, made.masks[0])
            continue
        if reached < horizon:
            return reached, reached + 1, most, checks, nodes, rounds
        count, asks_much = _curved(it, task, room, made, bool(gentle))
        checks, harsh = checks + count, harsh or asks_much
        first, farthest = _closed(lattice, it.work, masks, made.named, made.way, made.touches)
        if first == horizon:
            return horizon, horizon + 1, most, checks, nodes, rounds + 1
        deepest = max(deepest, first)
        best = least_in(it.work.costs[horizon])
        settle_backward(lattice, it.work, first, best + farthest)
        checks += _close_promising(
            room, postures, made.carriers, task.boxes, made.skins, lattice, it.work, masks, made.steps, first, best
        )
    return deepest, deepest + 1, most, checks, nodes, weights.rounds


@exact_kernel
def search_group(shelf: Held[Shelf], task: GroupTask, weights: Weights) -> GroupWay:
    """The cheapest way whose motion is free as shown, at every moment.

    It begins gently; if there is no such way, only who is told so begins as hard as it takes.
    """
    it = shelf.value
    room = workroom(it.group.postures, it.chain.waist, task.boxes.shape[1])
    made = search_room(task.goals.shape[0] - 1, task.goals.shape[1], task.extra.shape[1])
    reached, until, most, checks, nodes, rounds = _search(it, task, weights, room, made)
    return GroupWay(
        reached, made.keys[:until], made.tangents[:until], made.slots, made.price, most, checks, nodes, rounds
    )
