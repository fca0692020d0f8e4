"""What the nodes of a group's lattice cost: how far each is from its goal, and how near to an obstacle."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, plain
from elbowroom.planning.exact.group.problem import Group, GroupTask, Weights
from elbowroom.planning.exact.lattice.extra_nodes import ExtraNodes
from elbowroom.planning.exact.lattice.lattice import BACK, EXTRA, squares_from
from elbowroom.planning.exact.lattice.postures import Postures
from elbowroom.planning.exact.sweep.motion_bounds import SWEEP
from elbowroom.planning.exact.sweep.node_clearances import (
    HELD_AT_START,
    HELD_EARLY,
    HELD_LATE,
    held_clearance_in,
    interval_clearances,
)
from elbowroom.planning.exact.sweep.scratch import Scratch
from elbowroom.planning.model.limb import Limb, pose_into
from elbowroom.planning.model.self_contact import is_clear_of_trunk
from elbowroom.planning.paper.activity_graph import squared_distance
from elbowroom.world.obstacles.rows import at_span

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]

_INFINITE = np.float32(np.inf)
_ONE, _FIRST = plain(1), plain(0)  # posture; place


class Carriers(NamedTuple):
    """What carries the limb in each key interval: the numbers of the sweeps, and their frames in the world."""

    ids: Longs  # (n,)
    places: Floats  # (n, SWEEP+1, 3)
    turns: Floats  # (n, SWEEP+1, 4)


@exact_kernel
def carriers_at(ids: Longs, places: Floats, turns: Floats, entries: Longs) -> Carriers:
    """The sweeps at cache `entries` (n,), one after the other."""
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
def node_costs(
    scratch: Scratch, group: Group, carriers: Carriers, task: GroupTask, weights: Weights, extras: ExtraNodes
) -> tuple[Floats32, float, int]:
    """The costs (n+1, W+EXTRA) of all nodes in squared radians, infinite where one is not free.

    Also the greatest clearance that may be asked for, half of what the start has, and the capsules checked.
    """
    postures, most, checks = group.postures, np.inf, 0
    if not task.settled:
        places, turns, near = carriers.places[0], carriers.turns[0], at_span(task.obstacles, 0)
        clearance, checks = held_clearance_in(scratch, postures, task.start, places, turns, near, HELD_AT_START)
        most = max(0.5 * clearance, 0.0)
    clear, count = _clearances(scratch, group, carriers, task, extras)
    cost = _costs(postures, task, weights, extras, clear, most)
    _rule_out_unneeded(cost, postures.configurations.shape[0], extras)
    if not postures.limb.chain.carries:
        _rule_out_through_trunk(scratch, postures.limb, extras, cost)
    return cost, most, checks + count


@helper
def _clearances(
    scratch: Scratch, group: Group, carriers: Carriers, task: GroupTask, extras: ExtraNodes
) -> tuple[Floats32, int]:
    """The clearances of the nodes (n+1, W+EXTRA), metres, and the capsules that had to be checked for them."""
    postures, goals = group.postures, task.goals
    width, checks = postures.columns.shape[1], 0
    clear = np.empty((goals.shape[0], width + EXTRA), np.float32)
    clear[:] = _INFINITE
    for k in range(goals.shape[0] - 1):
        places, turns, near = carriers.places[k], carriers.turns[k], at_span(task.obstacles, k)
        at, count = interval_clearances(
            scratch, group.tables, postures, carriers.ids[k], places, turns, goals[k : k + 2], near
        )
        checks += count
        _lower(clear[k], group.tables.early[at])
        _lower(clear[k + 1], group.tables.late[at])
        for e in range(1, EXTRA):
            for end in range(2):
                if extras.needed[k + end, e]:
                    part, posture = HELD_EARLY if end == 0 else HELD_LATE, extras.postures[k + end, e]
                    found, count = held_clearance_in(scratch, postures, posture, places, turns, near, part)
                    checks += count
                    clear[k + end, width + e] = min(clear[k + end, width + e], found)
    return clear, checks


@exact_kernel
def _lower(row: Floats32, other: Floats32) -> None:
    """Lower the beginning of a row to another."""
    for i in range(np.uint64(other.shape[0])):
        row[i] = min(row[i], other[i])


@helper
def _costs(
    postures: Postures, task: GroupTask, weights: Weights, extras: ExtraNodes, clear: Floats32, most: float
) -> Floats32:
    """Squared distance from the goal and the lack of comfort (n+1, W+EXTRA), for nodes with the clearances `clear`.

    Infinite where there is less than the margin, or than `most`. The last plan's nodes cost less, but near the goal not
    so much less that nobody would go back to it.
    """
    cost: Floats32 = np.empty(clear.shape, np.float32)
    width = postures.columns.shape[1]
    comfort, near = np.float32(weights.comfort), np.float32(weights.near)
    for t in range(cost.shape[0]):
        row, free, added, kept = cost[t], clear[t], task.added[t], extras.previous[t]
        squares_from(postures.columns, task.goals[t], row[:width])
        for e in range(EXTRA):
            row[width + e] = squared_distance(extras.postures[t, e], task.goals[t])
        row[kept] -= min(np.float32(weights.keeping), np.float32(0.5) * row[kept])
        margin = np.float32(min(task.margins[t], most))
        for node in range(np.uint64(width + EXTRA)):
            lack = max(comfort - free[node], np.float32(0.0))
            total = row[node] + near * lack * lack + added[node]
            row[node] = total if free[node] >= margin else _INFINITE
    return cost


@helper
def _rule_out_through_trunk(scratch: Scratch, limb: Limb, extras: ExtraNodes, cost: Floats32) -> None:
    """Rule out extra nodes on the straight line back from the start that lie in the trunk."""
    width = cost.shape[1] - EXTRA
    for t in range(cost.shape[0]):
        if extras.needed[t, BACK]:
            pose_into(limb, scratch.limb, extras.postures[t, BACK : BACK + 1], _ONE, _FIRST, scratch.segments)
            if not is_clear_of_trunk(scratch.segments, _FIRST, limb.trunk, limb.allowed, scratch.axis):
                cost[t, width + BACK] = _INFINITE


@helper
def _rule_out_unneeded(cost: Floats32, size: int, extras: ExtraNodes) -> None:
    """Lanes that only fill up the last block, and extra nodes that are not needed, are no nodes."""
    width = cost.shape[1] - EXTRA
    for t in range(cost.shape[0]):
        row = cost[t]
        for node in range(size, width):
            row[node] = _INFINITE
        for e in range(1, EXTRA):
            if not extras.needed[t, e]:
                row[width + e] = _INFINITE
