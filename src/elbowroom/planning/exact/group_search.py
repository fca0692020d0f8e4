"""The way of one group along a root path: cheapest through the lattice, then proven as it will be shown.

A way that touches between its key frames is banned there, with the steps near it; where that happens, the steps of
that key interval through which the next ways would lead are looked at in one batch, and the next cheapest way is taken.
So steps are swept only where the search is blocked, and every candidate is swept as a whole. It is one compiled call.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.curve import peak_acceleration, smooth_tangents
from elbowroom.planning.exact.lattice import (
    BACK,
    GOAL,
    HOLD,
    KEPT,
    OWN,
    Lattice,
    Work,
    cheapest_way,
    posture_of,
    settle_backward,
    squares_from,
    traced,
)
from elbowroom.planning.exact.postures import Postures
from elbowroom.planning.exact.proof import ENOUGH, limb_way
from elbowroom.planning.exact.slots import Slots, admit, begin_round, find, new_slots
from elbowroom.planning.exact.steps import ban_near, close_steps, promising
from elbowroom.planning.exact.tables import HELD_AT_START, HELD_EARLY, HELD_LATE, Tables, held_clearance, table_of
from elbowroom.planning.exact.ways import Chain, LimbWays, RootWays
from elbowroom.planning.limb import pose
from elbowroom.planning.self_contact import clear_of_trunk

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Ints = NDArray[np.int32]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

_BAN_RADIUS = 0.1  # radians: steps so near to one that touches are banned with it
_FIRST_SLACK = 0.1  # squared radians: how much dearer ways are looked at where one touches; doubled each time
_BACK_STEP = 0.8  # of the longest step
_SAME = 1e-9  # radians
_INFINITE = np.float32(np.inf)


class Masks(NamedTuple):
    """Steps that were found to touch, by interval; the key is that of its table. So no plan has to find them again."""

    slots: Slots
    closed: Floats32  # (M, W+OWN, W+OWN) infinite where a step is closed, else 0
    seen: Bools  # (M, W+OWN, W+OWN) steps that were looked at
    slack: Floats  # (M,) squared radians: how much dearer ways were looked at


class Group(NamedTuple):
    """One group for a key interval: what is known of it once and for all, and its shelves."""

    postures: Postures
    levers: Floats  # (C, 3) as `levers_of`
    limits: Floats  # (d, 2) of the joints
    acceleration: float  # the greatest over all components together, rad/s^2
    tables: Tables
    ways: LimbWays
    masks: Masks


class Weights(NamedTuple):
    """What a search prefers and where it ends; see `ExactSettings`."""

    step: float
    near: float
    comfort: float
    keeping: float
    rounds: int


class GroupTask(NamedTuple):
    """What one group has to do."""

    goals: Floats  # (n+1, d)
    kept: Floats  # (n+1, d) what the last plan had
    start: Floats  # (d,)
    velocity: Floats  # (d,) there
    margins: Floats  # (n+1,) clearance of a node; less where the start has less, so that who stands close by can go
    skins: Floats  # (n,) clearance of the motion at the looks; less where the start has less
    extra: Floats32  # (n+1, W+OWN) added to the nodes' prices
    roots: Longs  # (n,) slots of the root ways
    carriers: Longs  # (n,) slots of the waist's ways, for an arm
    boxes: Floats  # (n, B, 15) in the world, in each key interval
    interval: float


class GroupWay(NamedTuple):
    """What was found."""

    reached: int  # n if there is a way, else the depth that none got beyond
    keys: Floats  # (reached+1, d)
    velocities: Floats  # (reached+1, d) of the curve
    slots: Longs  # (n,) of the ways through the intervals
    price: Floats32  # (n+1, W+OWN) of the nodes, infinite where one is not free
    checks: int  # capsules checked
    nodes: int
    rounds: int  # motions that were tried


def new_masks(count: int, size: int, nodes: int) -> Masks:
    """Room for `count` intervals of a group with `size` components and rows of `nodes` nodes."""
    square = (count, nodes, nodes)
    return Masks(
        new_slots(count, 1 + 2 * size), np.zeros(square, np.float32), np.zeros(square, np.bool_), np.zeros(count)
    )


@exact_kernel
def _carrier(group: Group, roots: RootWays, waists: LimbWays, task: GroupTask, k: int) -> tuple[int, Floats, Floats]:
    """Number and frames of what carries the limb in interval k."""
    if group.postures.limb.is_waist:
        at = task.roots[k]
        return roots.slots.ids[at], roots.places[at], roots.turns[at]
    at = task.carriers[k]
    return waists.slots.ids[at], waists.places[at], waists.turns[at]


@exact_kernel
def own_postures(group: Group, task: GroupTask) -> tuple[Floats, Bools, Ints]:
    """The postures of each key time alone (n+1, OWN, d), which of them are needed, and the last plan's nodes (n+1,).

    A posture that is among the others already needs no node of its own.
    """
    width = group.postures.moves.shape[1]
    count, size = task.goals.shape
    own, needed = np.empty((count, OWN, size)), np.ones((count, OWN), np.bool_)
    kept = np.empty(count, np.int32)
    length = np.sqrt(np.sum((task.goals[0] - task.start) ** 2))
    pace = _BACK_STEP * group.postures.step
    for t in range(count):
        part = min(pace * t / max(np.sqrt(np.sum((task.goals[t] - task.start) ** 2)), 1e-9), 1.0)
        own[t, GOAL], own[t, KEPT], own[t, HOLD] = task.goals[t], task.kept[t], task.start
        own[t, BACK] = task.start + part * (task.goals[t] - task.start)
        kept[t] = width + KEPT
        if _near(task.kept[t], task.goals[t]):
            kept[t] = width + GOAL
        else:
            at = _known(group.postures, task.kept[t])
            kept[t] = at if at >= 0 else width + KEPT
        needed[t, KEPT] = kept[t] == width + KEPT
        needed[t, BACK] = part < 1.0 and length > _SAME
        needed[t, HOLD] = not _near(task.start, task.goals[t])
    if _known(group.postures, task.start) >= 0:
        needed[:, HOLD] = False
    return own, needed, kept


@exact_kernel
def _known(postures: Postures, posture: Floats) -> int:
    """The number of a posture (d,), or -1."""
    squares = np.empty(postures.columns.shape[1], np.float32)
    squares_from(postures.columns, posture, squares)
    at = np.argmin(squares)
    return int(at) if at < len(postures.configurations) and _near(posture, postures.configurations[at]) else -1


@exact_kernel
def _near(a: Floats, b: Floats) -> bool:
    apart = 0.0
    for i in range(a.shape[0]):
        apart = max(apart, abs(a[i] - b[i]))
    return apart <= _SAME


@exact_kernel
def _prices(
    group: Group, roots: RootWays, waists: LimbWays, task: GroupTask, weights: Weights, own: Floats, needed: Bools,
    kept: Ints, most: float,
) -> tuple[Floats32, int]:  # fmt: skip
    """The prices (n+1, W+OWN): squared distance from the goal and the lack of comfort; infinite where not free."""
    postures = group.postures
    known, width = postures.configurations, postures.moves.shape[1]
    horizon = task.goals.shape[0] - 1
    price = np.empty((horizon + 1, width + OWN), np.float32)
    clear = np.full((horizon + 1, width + OWN), _INFINITE, np.float32)
    checks = 0
    for k in range(horizon):
        carrier, places, turns = _carrier(group, roots, waists, task, k)
        at, count = table_of(group.tables, postures, carrier, places, turns, task.goals[k : k + 2], task.boxes[k])
        checks += count
        clear[k, : width + 1] = np.minimum(clear[k, : width + 1], group.tables.early[at])
        clear[k + 1, : width + 1] = np.minimum(clear[k + 1, : width + 1], group.tables.late[at])
        for e in range(1, OWN):
            for end in range(2):
                if needed[k + end, e]:
                    part = HELD_EARLY if end == 0 else HELD_LATE
                    found, count = held_clearance(postures, own[k + end, e], places, turns, task.boxes[k], part)
                    checks += count
                    clear[k + end, width + e] = min(clear[k + end, width + e], found)
    comfort, near = np.float32(weights.comfort), np.float32(weights.near)
    for t in range(horizon + 1):
        row, free, extra = price[t], clear[t], task.extra[t]
        squares_from(postures.columns, task.goals[t], row[:width])
        for e in range(OWN):
            row[width + e] = np.sum((own[t, e] - task.goals[t]) ** 2)
        margin = np.float32(min(task.margins[t], most))
        for node in range(np.uint64(width + OWN)):
            lack = max(comfort - free[node], np.float32(0.0))
            cost = row[node] + near * lack * lack + extra[node]
            row[node] = cost if free[node] >= margin else _INFINITE
        price[t, known.shape[0] : width] = _INFINITE
        price[t, kept[t]] -= weights.keeping
        for e in range(1, OWN):
            if not needed[t, e]:
                price[t, width + e] = _INFINITE
    _unfold(postures, own, needed, price)
    return price, checks


@exact_kernel
def _unfold(postures: Postures, own: Floats, needed: Bools, price: Floats32) -> None:
    """Rule out ways back that lead through the trunk."""
    if postures.limb.is_waist:
        return
    width = postures.moves.shape[1]
    for t in range(own.shape[0]):
        if needed[t, BACK]:
            segments = pose(postures.limb, own[t, BACK : BACK + 1])
            if not clear_of_trunk(segments, postures.limb.trunk, postures.limb.allowed)[0]:
                price[t, width + BACK] = _INFINITE


@exact_kernel
def _known_masks(masks: Masks, keys: Floats, kept: Ints) -> Longs:
    """The masks (n,) of intervals with these keys (n, K), -1 where there is none.

    What it says of postures that belonged to the last plan's key times alone is forgotten, and so is what it says of
    the steps between the nodes `kept` (n+1,) of the last plan: they may be closed for being near to others only.
    """
    begin_round(masks.slots)
    out = np.empty(keys.shape[0], np.int64)
    for k in range(keys.shape[0]):
        at = find(masks.slots, keys[k])
        out[k] = at
        if at >= 0:
            own = masks.closed.shape[1] - OWN
            for e in range(1, OWN):
                masks.closed[at, own + e], masks.closed[at, :, own + e] = 0.0, 0.0
                masks.seen[at, own + e], masks.seen[at, :, own + e] = False, False
            masks.closed[at, kept[k], kept[k + 1]] = 0.0
    return out


@exact_kernel
def _new_mask(masks: Masks, key: Floats) -> int:
    at = admit(masks.slots, key)
    masks.closed[at], masks.seen[at], masks.slack[at] = 0.0, False, 0.0
    return int(at)


@exact_kernel
def _mask_keys(group: Group, roots: RootWays, waists: LimbWays, task: GroupTask) -> Floats:
    """The keys (n, 1 + 2 d): number of the carrier's way, goals at both ends."""
    horizon, size = task.goals.shape[0] - 1, task.goals.shape[1]
    keys = np.empty((horizon, 1 + 2 * size))
    for k in range(horizon):
        keys[k, 0] = _carrier(group, roots, waists, task, k)[0]
        keys[k, 1 : 1 + size], keys[k, 1 + size :] = task.goals[k], task.goals[k + 1]
    return keys


@exact_kernel
def _proven(
    group: Group, roots: RootWays, waists: LimbWays, chain: Chain, task: GroupTask, keys: Floats, tangents: Floats,
    skins: Floats, slots: Longs,
) -> tuple[int, Bools]:  # fmt: skip
    """Prove the curve through `keys` (n+1, d) free: the capsules checked and the intervals (n,) in which it is not.

    An interval fails too if its curve asks for too much. Not the first: it begins with a velocity that is given, and
    may have to brake hard. The ways through the intervals are put into `slots` (n,).
    """
    is_waist, horizon, checks = group.postures.limb.is_waist, slots.shape[0], 0
    touches = np.zeros(horizon, np.bool_)
    begin_round(group.ways.slots)
    for k in range(horizon):
        ends = (keys[k], tangents[k], keys[k + 1], tangents[k + 1])
        slots[k], count = limb_way(
            group.ways, group.postures, group.levers, chain, roots, task.roots[k], waists,
            0 if is_waist else task.carriers[k], ends, task.boxes[k], skins[k],
        )  # fmt: skip
        checks += count
        asked = peak_acceleration(keys[k], tangents[k], keys[k + 1], tangents[k + 1], task.interval)
        touches[k] = group.ways.least[slots[k]] < skins[k] or group.ways.proven[slots[k]] < ENOUGH
        touches[k] |= k > 0 and asked > group.acceleration
    return checks, touches


@exact_kernel
def search_group(
    group: Group, roots: RootWays, waists: LimbWays, chain: Chain, task: GroupTask, weights: Weights, work: Work
) -> GroupWay:
    """The cheapest way whose motion is free as shown, at every moment."""
    postures, masks, horizon = group.postures, group.masks, task.goals.shape[0] - 1
    begin_round(group.tables.slots)
    own, needed, kept = own_postures(group, task)
    _, places, turns = _carrier(group, roots, waists, task, 0)
    clearance, checks = held_clearance(postures, task.start, places, turns, task.boxes[0], HELD_AT_START)
    most = max(0.5 * clearance, 0.0)
    price, count = _prices(group, roots, waists, task, weights, own, needed, kept, most)
    checks += count
    mask_keys = _mask_keys(group, roots, waists, task)
    lattice = Lattice(
        postures.configurations, postures.columns, postures.moves, own, task.goals, price,
        _known_masks(masks, mask_keys, kept), masks.closed, kept, postures.step, weights.step,
    )  # fmt: skip
    skins = np.minimum(task.skins, most)
    slots, stiff = np.empty(horizon, np.int64), np.zeros(horizon + 1, np.bool_)
    nodes, begin, deepest = 0, 0, 0
    keys, tangents = np.empty_like(task.goals), np.empty_like(task.goals)
    for rounds in range(weights.rounds):
        reached, count = cheapest_way(lattice, work, begin)
        nodes += count
        way = traced(lattice, work, reached)
        for t in range(reached + 1):
            keys[t] = posture_of(lattice, t, way[t])
        if reached < horizon:
            return GroupWay(reached, keys[: reached + 1], tangents[: reached + 1], slots, price, checks, nodes, rounds)
        first, farthest, stiff[:] = horizon, 0.0, False
        for attempt in range(2):
            tangents[:] = smooth_tangents(keys, task.interval, task.velocity, group.limits, stiff)
            count, touches = _proven(group, roots, waists, chain, task, keys, tangents, skins, slots)
            checks += count
            if attempt == 1 or not touches.any():
                break
            stiff[:-1] |= touches
            stiff[1:] |= touches
        for k in range(horizon - 1, -1, -1):
            if touches[k]:
                first = k
                if lattice.masks[k] < 0:
                    lattice.masks[k] = _new_mask(masks, mask_keys[k])
                ban_near(lattice, k, way[k], way[k + 1], _BAN_RADIUS)
                slack = max(2.0 * masks.slack[lattice.masks[k]], _FIRST_SLACK)
                masks.slack[lattice.masks[k]], farthest = slack, max(farthest, slack)
        if first == horizon:
            return GroupWay(horizon, keys, tangents, slots, price, checks, nodes, rounds + 1)
        deepest = max(deepest, first)
        best = work.costs[horizon].min()
        settle_backward(lattice, work, first, best + farthest)
        for k in range(first, horizon):
            at = lattice.masks[k]
            if at >= 0:
                steps = promising(lattice, work, k, best + masks.slack[at], masks.seen[at])
                if len(steps):
                    _, places, turns = _carrier(group, roots, waists, task, k)
                    checks += close_steps(postures, lattice, k, steps, places, turns, task.boxes[k], skins[k])
        begin = first
    until = deepest + 1
    return GroupWay(deepest, keys[:until], tangents[:until], slots, price, checks, nodes, weights.rounds)
