"""What the nodes of a group's lattice cost: how far each is from its goal, and how near to an obstacle."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import helper, inner_exact_kernel, plain
from elbowroom.planning.exact.group.carriers import Carriers
from elbowroom.planning.exact.group.problem import GroupTask, Weights
from elbowroom.planning.exact.lattice.extra_nodes import ExtraNodes
from elbowroom.planning.exact.lattice.lattice import BACK, EXTRA, squares_from
from elbowroom.planning.exact.lattice.postures import Postures
from elbowroom.planning.exact.sweep.node_clearances import (
    HELD_AT_START,
    HELD_EARLY,
    HELD_LATE,
    NodeClearances,
    held_clearance,
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
Bools = NDArray[np.bool_]

_INFINITE = np.float32(np.inf)
_ONE, _FIRST = plain(1), plain(0)  # posture; place


@helper
def node_costs(
    scratch: Scratch,
    postures: Postures,
    tables: NodeClearances,
    carriers: Carriers,
    task: GroupTask,
    weights: Weights,
    extras: ExtraNodes,
) -> tuple[Floats32, float, int]:
    """The costs (n+1, W+EXTRA) of all nodes in squared radians, infinite where one is not free.

    Also the greatest clearance that may be asked for, half of what the start has, and the capsules checked.
    """
    most, checks, obstacles, goals = np.inf, 0, task.obstacles, task.goals
    if not task.settled:
        places, turns, near = carriers.places[0], carriers.turns[0], at_span(obstacles, 0)
        clearance, checks = held_clearance(scratch, postures, task.start, places, turns, near, HELD_AT_START)
        most = max(0.5 * clearance, 0.0)
    clear, count = _clearances(scratch, postures, tables, carriers, goals, obstacles, extras)
    margins = np.minimum(task.margins, most)
    cost = _costs(postures.columns, goals, task.added, weights, extras, clear, margins)
    _rule_out_unneeded(cost, postures.configurations.shape[0], extras.needed)
    if not postures.limb.chain.carries:
        _rule_out_through_trunk(scratch, postures.limb, extras, cost)
    return cost, most, checks + count


@helper
def _clearances(
    scratch: Scratch,
    postures: Postures,
    tables: NodeClearances,
    carriers: Carriers,
    goals: Floats,
    obstacles: Spans,
    extras: ExtraNodes,
) -> tuple[Floats32, int]:
    """The clearances of the nodes (n+1, W+EXTRA), metres, and the capsules that had to be checked for them."""
    numbers, all_places, all_turns, _, _, _, _ = carriers
    own, needed, early, late = extras.postures, extras.needed, tables.early, tables.late
    width, checks = postures.columns.shape[1], 0
    clear = np.empty((goals.shape[0], width + EXTRA), np.float32)
    clear[:] = _INFINITE
    for k in range(goals.shape[0] - 1):
        places, turns, near, both = all_places[k], all_turns[k], at_span(obstacles, k), goals[k : k + 2]
        at, count = interval_clearances(scratch, tables, postures, numbers[k], places, turns, both, near)
        checks += count
        _lower(clear[k], early[at])
        _lower(clear[k + 1], late[at])
        for e in range(1, EXTRA):
            for end in range(2):
                if needed[k + end, e]:
                    part, posture = HELD_EARLY if end == 0 else HELD_LATE, own[k + end, e]
                    found, count = held_clearance(scratch, postures, posture, places, turns, near, part)
                    checks += count
                    clear[k + end, width + e] = min(clear[k + end, width + e], found)
    return clear, checks


@inner_exact_kernel
def _lower(row: Floats32, other: Floats32) -> None:
    """Lower the beginning of a row to another."""
    for i in range(np.uint64(other.shape[0])):
        row[i] = min(row[i], other[i])


@helper
def _costs(
    columns: Floats32,
    goals: Floats,
    added: Floats32,
    weights: Weights,
    extras: ExtraNodes,
    clear: Floats32,
    margins: Floats,
) -> Floats32:
    """Squared distance from the goal and the lack of comfort (n+1, W+EXTRA), for nodes with the clearances `clear`.

    Infinite where there is less than the `margins` (n+1,). The last plan's nodes cost less, but near the goal not so
    much less that nobody would go back to it.
    """
    cost: Floats32 = np.empty(clear.shape, np.float32)
    width, keeping = columns.shape[1], np.float32(weights.keeping)
    comfort, close = np.float32(weights.comfort), np.float32(weights.near)
    own, _, previous = extras
    for t in range(cost.shape[0]):
        row, free, more, kept = cost[t], clear[t], added[t], previous[t]
        squares_from(columns, goals[t], row[:width])
        for e in range(EXTRA):
            row[width + e] = squared_distance(own[t, e], goals[t])
        row[kept] -= min(keeping, np.float32(0.5) * row[kept])
        margin = np.float32(margins[t])
        for node in range(np.uint64(width + EXTRA)):
            lack = max(comfort - free[node], np.float32(0.0))
            total = row[node] + close * lack * lack + more[node]
            row[node] = total if free[node] >= margin else _INFINITE
    return cost


@helper
def _rule_out_through_trunk(scratch: Scratch, limb: Limb, extras: ExtraNodes, cost: Floats32) -> None:
    """Rule out extra nodes on the straight line back from the start that lie in the trunk."""
    own, needed, _ = extras
    width, room, segments, axis = cost.shape[1] - EXTRA, scratch.limb, scratch.segments, scratch.axis
    for t in range(cost.shape[0]):
        if needed[t, BACK]:
            pose_into(limb, room, own[t, BACK : BACK + 1], _ONE, _FIRST, segments)
            if not is_clear_of_trunk(segments, _FIRST, limb.trunk, limb.allowed, axis):
                cost[t, width + BACK] = _INFINITE


@helper
def _rule_out_unneeded(cost: Floats32, size: int, needed: Bools) -> None:
    """Lanes that only fill up the last block, and extra nodes that are not needed, are no nodes."""
    width = cost.shape[1] - EXTRA
    for t in range(cost.shape[0]):
        row = cost[t]
        for node in range(size, width):
            row[node] = _INFINITE
        for e in range(1, EXTRA):
            if not needed[t, e]:
                row[width + e] = _INFINITE
