"""What the nodes of a group's lattice cost: how far each is from its goal, and how near to an obstacle."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, plain
from elbowroom.planning.exact.group.problem import GroupTask, Weights
from elbowroom.planning.exact.lattice.lattice import BACK, EXTRA, squares_from
from elbowroom.planning.exact.lattice.postures import Postures
from elbowroom.planning.exact.sweep.motion_bounds import SWEEP
from elbowroom.planning.exact.sweep.node_clearances import (
    HELD_AT_START,
    HELD_EARLY,
    HELD_LATE,
    NodeClearances,
    held_clearance_in,
    interval_clearances,
)
from elbowroom.planning.exact.sweep.scratch import Scratch
from elbowroom.planning.model.limb import Limb, pose_into
from elbowroom.planning.model.self_contact import is_clear_of_trunk
from elbowroom.planning.paper.activity_graph import squared_distance
from elbowroom.world.obstacles.layout import Spans
from elbowroom.world.obstacles.rows import at_span

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]
Bools = NDArray[np.bool_]

_INFINITE = np.float32(np.inf)
_ONE, _FIRST = plain(1), plain(0)  # posture; place


class Carriers(NamedTuple):
    """What carries the limb in each key interval: numbers and frames of its ways."""

    ids: Longs  # (n,)
    places: Floats  # (n, SWEEP+1, 3)
    turns: Floats  # (n, SWEEP+1, 4)


@exact_kernel
def carriers_at(ids: Longs, places: Floats, turns: Floats, entries: Longs) -> Carriers:
    """The ways at `slots` (n,), one after the other."""
    count = entries.shape[0]
    out = Carriers(np.empty(count, np.int64), np.empty((count, SWEEP + 1, 3)), np.empty((count, SWEEP + 1, 4)))
    for k in range(count):
        at = entries[k]
        out.ids[k] = ids[at]
        for sample in range(SWEEP + 1):
            for i in range(3):
                out.places[k, sample, i] = places[at, sample, i]
            for i in range(4):
                out.turns[k, sample, i] = turns[at, sample, i]
    return out


@helper
def _clearances(
    scratch: Scratch,
    tables: NodeClearances,
    postures: Postures,
    carriers: Carriers,
    goals: Floats,
    obstacles: Spans,
    own: Floats,
    needed: Bools,
    clear: Floats32,
) -> int:
    """The clearances of the nodes into `clear` (n+1, W+OWN); returns the capsules that had to be checked for them."""
    width = postures.columns.shape[1]
    clear[:] = _INFINITE
    checks = 0
    for k in range(goals.shape[0] - 1):
        places, turns, around = carriers.places[k], carriers.turns[k], at_span(obstacles, k)
        at, count = interval_clearances(
            scratch, tables, postures, carriers.ids[k], places, turns, goals[k : k + 2], around
        )
        checks += count
        _lower(clear[k], tables.early[at])
        _lower(clear[k + 1], tables.late[at])
        for e in range(1, EXTRA):
            for end in range(2):
                if needed[k + end, e]:
                    part = HELD_EARLY if end == 0 else HELD_LATE
                    found, count = held_clearance_in(scratch, postures, own[k + end, e], places, turns, around, part)
                    checks += count
                    clear[k + end, width + e] = min(clear[k + end, width + e], found)
    return checks


@exact_kernel
def _lower(row: Floats32, other: Floats32) -> None:
    """Lower the beginning of a row to another."""
    for i in range(np.uint64(other.shape[0])):
        row[i] = min(row[i], other[i])


@helper
def _costs(
    columns: Floats32,
    goals: Floats,
    own: Floats,
    clear: Floats32,
    extras: Floats32,
    margins: Floats,
    most: float,
    weights: Weights,
    previous: Longs,
    price: Floats32,
) -> None:
    """Squared distance from the goal and the lack of comfort, for nodes with the clearances `clear` (n+1, W+OWN).

    Infinite where there is less than the margin, or than `most`. What is `kept` (n+1,) costs less, but near the goal
    not so much less that nobody would go back to it.
    """
    width = columns.shape[1]
    comfort, near = np.float32(weights.comfort), np.float32(weights.near)
    for t in range(price.shape[0]):
        row, free, extra = price[t], clear[t], extras[t]
        squares_from(columns, goals[t], row[:width])
        for e in range(EXTRA):
            row[width + e] = squared_distance(own[t, e], goals[t])
        row[previous[t]] -= min(np.float32(weights.keeping), np.float32(0.5) * row[previous[t]])
        margin = np.float32(min(margins[t], most))
        for node in range(np.uint64(width + EXTRA)):
            lack = max(comfort - free[node], np.float32(0.0))
            cost = row[node] + near * lack * lack + extra[node]
            row[node] = cost if free[node] >= margin else _INFINITE


@helper
def _unfold(scratch: Scratch, limb: Limb, own: Floats, needed: Bools, price: Floats32) -> None:
    """Rule out ways back that lead through the trunk."""
    width = price.shape[1] - EXTRA
    for t in range(own.shape[0]):
        if needed[t, BACK]:
            pose_into(limb, scratch.limb, own[t, BACK : BACK + 1], _ONE, _FIRST, scratch.segments)
            if not is_clear_of_trunk(scratch.segments, _FIRST, limb.trunk, limb.allowed, scratch.axis):
                price[t, width + BACK] = _INFINITE


@exact_kernel
def _rule_out(price: Floats32, size: int, needed: Bools) -> None:
    """Lanes that only fill up the last block, and postures of a key time alone that are not needed, are no nodes."""
    width = price.shape[1] - EXTRA
    for t in range(price.shape[0]):
        row = price[t]
        for node in range(size, width):
            row[node] = _INFINITE
        for e in range(1, EXTRA):
            if not needed[t, e]:
                row[width + e] = _INFINITE


@exact_kernel
def node_costs(
    scratch: Scratch,
    tables: NodeClearances,
    postures: Postures,
    carriers: Carriers,
    task: GroupTask,
    weights: Weights,
    own: Floats,
    needed: Bools,
    previous: Longs,
    clear: Floats32,
    price: Floats32,
) -> tuple[float, int]:
    """The prices (n+1, W+OWN) of all nodes, infinite where one is not free, into `price`; `clear` like it is scratch.

    Returns the greatest clearance that may be asked for, half of what the start has, and the capsules checked.
    """
    limb, columns, goals, obstacles = postures.limb, postures.columns, task.goals, task.obstacles
    most, checks = np.inf, 0
    if not task.settled:
        clearance, checks = held_clearance_in(
            scratch,
            postures,
            task.start,
            carriers.places[0],
            carriers.turns[0],
            at_span(obstacles, 0),
            HELD_AT_START,
        )
        most = max(0.5 * clearance, 0.0)
    checks += _clearances(scratch, tables, postures, carriers, goals, obstacles, own, needed, clear)
    _costs(columns, goals, own, clear, task.extra, task.margins, most, weights, previous, price)
    _rule_out(price, postures.configurations.shape[0], needed)
    if not limb.is_waist:
        _unfold(scratch, limb, own, needed, price)
    return most, checks
