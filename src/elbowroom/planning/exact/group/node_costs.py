"""What the nodes of a group's lattice cost: how far each is from its goal, and how near to an obstacle.

To see how near is dear, above all among meshes, and through most nodes no path leads: they are too far from the goal.
So at first nodes cost what they do where nothing is near, which is never too much. The cheapest path is looked at node
by node; where that makes it dearer, the cheapest is sought again. A path whose nodes have all been looked at, and that
is still the cheapest, is the one that would be found had all been looked at. What earlier plans saw saves looks, and
changes nothing else.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import helper, inner_exact_kernel, plain
from elbowroom.planning.exact.group.carriers import Carriers
from elbowroom.planning.exact.group.problem import GroupTask, Weights
from elbowroom.planning.exact.lattice.extra_nodes import ExtraNodes
from elbowroom.planning.exact.lattice.lattice import BACK, EXTRA, GOAL, squares_from
from elbowroom.planning.exact.lattice.postures import BLOCK, Postures
from elbowroom.planning.exact.sweep.node_clearances import (
    HELD_AT_START,
    HELD_EARLY,
    HELD_LATE,
    NodeClearances,
    held_clearance,
    interval_table,
    look_at_nodes,
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
_NOTHING = np.float32(0.0)
_ONE, _FIRST = plain(1), plain(0)  # posture; place


class NodeLooks(NamedTuple):
    """What the nodes along one path are looked at with."""

    scratch: Scratch
    postures: Postures
    known: NodeClearances
    carriers: Carriers
    obstacles: Spans
    goals: Floats  # (n+1, d)
    extras: ExtraNodes


class NodeCosts(NamedTuple):
    """What is known by now of the nodes along one path."""

    cost: Floats32  # (n+1, W+EXTRA) squared radians, infinite where one is not free; never too much
    away: Floats32  # (n+1, W+EXTRA) what they cost for being away from the goal
    added: Floats32  # (n+1, W+EXTRA) and for other reasons
    clear: Floats32  # (n+1, W+EXTRA) clearances, metres; more than there is where nobody looked
    margins: Floats  # (n+1,) clearances that are asked for
    tables: Longs  # (n,) the slots of the intervals' tables
    blocks: Bools  # (n, W/16 + 1) which blocks of postures were looked at in each interval, and whether its goals were
    extras: Bools  # (n+1, EXTRA) which of the other extra nodes were


@helper
def begun_costs(looks: NodeLooks, task: GroupTask, weights: Weights) -> tuple[NodeCosts, float, int]:
    """What is known of the nodes before any is looked at.

    Also the greatest clearance that may be asked for, half of what the start has, and the capsules checked.
    """
    scratch, postures, known, carriers, obstacles, goals, extras = looks
    most, checks = np.inf, 0
    if not task.settled:
        places, turns, near = carriers.places[0], carriers.turns[0], at_span(obstacles, 0)
        clearance, checks = held_clearance(scratch, postures, task.start, places, turns, near, HELD_AT_START)
        most = max(0.5 * clearance, 0.0)
    away = _away(postures, goals, extras, np.float32(weights.keeping))
    if not postures.limb.chain.carries:
        _rule_out_through_trunk(scratch, postures.limb, extras, away)
    clear, tables = np.empty(away.shape, np.float32), np.empty(goals.shape[0] - 1, np.int64)
    clear[:] = _INFINITE
    for k in range(tables.shape[0]):
        tables[k] = interval_table(scratch, known, carriers.numbers[k], goals[k : k + 2])
    blocks, others = np.zeros((tables.shape[0], known.seen.shape[1]), np.bool_), np.zeros(extras.needed.shape, np.bool_)
    margins = np.minimum(task.margins, most)
    nodes = NodeCosts(np.empty(away.shape, np.float32), away, task.added, clear, margins, tables, blocks, others)
    for t in range(goals.shape[0]):
        _price(nodes.cost[t], away[t], task.added[t], clear[t], margins[t], weights)
    return nodes, most, checks


@helper
def _away(postures: Postures, goals: Floats, extras: ExtraNodes, keeping: Any) -> Floats32:
    """The squared distances (n+1, W+EXTRA) of nodes from the goal; infinite where there is none.

    The last plan's nodes cost less, but near the goal not so much less that nobody would go back to it.
    """
    columns, size = postures.columns, postures.configurations.shape[0]
    width, (own, needed, previous) = columns.shape[1], extras
    away: Floats32 = np.empty((goals.shape[0], width + EXTRA), np.float32)
    for t in range(away.shape[0]):
        row, kept = away[t], previous[t]
        squares_from(columns, goals[t], row[:width])
        for e in range(EXTRA):
            row[width + e] = squared_distance(own[t, e], goals[t])
        row[kept] -= min(keeping, np.float32(0.5) * row[kept])
        for node in range(size, width):
            row[node] = _INFINITE  # lanes that only fill up the last block
        for e in range(1, EXTRA):
            row[width + e] = row[width + e] if needed[t, e] else _INFINITE
    return away


@inner_exact_kernel
def _lower(row: Floats32, other: Floats32, blocks: Longs) -> None:
    """Lower some blocks (K,) of a row to those of another; the number after the last block is that of the goal."""
    width = other.shape[0] - 1
    for b in blocks:
        for node in range(b * BLOCK, min((b + 1) * BLOCK, width) if b * BLOCK < width else width + 1):
            row[node] = min(row[node], other[node])


@inner_exact_kernel
def _price(cost: Floats32, away: Floats32, added: Floats32, clear: Floats32, margin: float, weights: Weights) -> None:
    """What the nodes (W+EXTRA,) of a key time cost: more where they lack comfort, infinite below the margin."""
    comfort, close, least = np.float32(weights.comfort), np.float32(weights.near), np.float32(margin)
    for node in range(np.uint64(cost.shape[0])):
        lack = max(comfort - clear[node], np.float32(0.0))
        total = away[node] + close * lack * lack + added[node]
        cost[node] = total if clear[node] >= least else _INFINITE


@inner_exact_kernel
def look_along(
    looks: NodeLooks, nodes: NodeCosts, path: Longs, whole: Bools, weights: Weights
) -> tuple[int, bool, int]:
    """Look at the nodes of a path (n+1,), if it is not empty, and at all nodes of intervals that are `whole` (n,).

    Returns the first key time at which a node may cost more than was known, the number of key times if none does;
    whether one of the path does; and the capsules checked.
    """
    changed, checks = _looked_at(looks, nodes, path, whole)
    first, dearer = changed.shape[0], False
    for t in range(first - 1, -1, -1):
        if changed[t]:
            before = nodes.cost[t, path[t]] if path.shape[0] > 0 else _NOTHING
            _price(nodes.cost[t], nodes.away[t], nodes.added[t], nodes.clear[t], nodes.margins[t], weights)
            dearer = dearer or (path.shape[0] > 0 and nodes.cost[t, path[t]] > before)
            first = t
    return first, dearer, checks


@helper
def _looked_at(looks: NodeLooks, nodes: NodeCosts, path: Longs, whole: Bools) -> tuple[Bools, int]:
    """Look at nodes as `look_along` does; at which key times (n+1,) there were any, and the capsules checked."""
    scratch, postures, known, carriers, obstacles, goals, extras = looks
    changed, checks, width = np.zeros(goals.shape[0], np.bool_), 0, postures.columns.shape[1]
    asked = np.empty(known.seen.shape[1], np.int64)
    for k in range(nodes.tables.shape[0]):
        blocks = asked[: _new_blocks(path, k, whole[k], nodes.blocks[k], asked)]
        if blocks.shape[0] > 0:
            at, carrier, near = nodes.tables[k], (carriers.places[k], carriers.turns[k]), at_span(obstacles, k)
            checks += look_at_nodes(scratch, known, at, blocks, postures, carrier, goals[k : k + 2], near)
            changed[k], changed[k + 1] = True, True
            _lower(nodes.clear[k], known.early[at], blocks)
            _lower(nodes.clear[k + 1], known.late[at], blocks)
    for t in range(1, changed.shape[0]):
        every = whole[t - 1] or (t < whole.shape[0] and whole[t])
        for e in range(1, EXTRA):
            here = every or (path.shape[0] > 0 and path[t] == width + e)
            if here and extras.needed[t, e] and not nodes.extras[t, e]:
                nodes.extras[t, e], changed[t] = True, True
                nodes.clear[t, width + e], count = _held(looks, t, extras.postures[t, e])
                checks += count
    return changed, checks


@inner_exact_kernel
def _new_blocks(path: Longs, k: int, whole: bool, blocks: Bools, out: Longs) -> int:
    """Write to `out` which blocks of an interval a path (n+1,) leads through, or all if it is `whole`; how many.

    Only those that were not looked at, as `blocks` (W/16 + 1,) tells, in which they are noted now.
    """
    count, goals = 0, (blocks.shape[0] - 1) * BLOCK + GOAL
    for b in range(blocks.shape[0]):
        wanted = whole
        for t in range(max(k, 1), min(k + 2, path.shape[0])):
            wanted = wanted or (path[t] // BLOCK == b and path[t] <= goals)
        if wanted and not blocks[b]:
            blocks[b], out[count] = True, b
            count += 1
    return count


@helper
def _held(looks: NodeLooks, t: int, posture: Floats) -> tuple[Any, int]:
    """The clearance of an extra node's posture (d,) about its key time, metres, and the capsules checked."""
    places, turns = looks.carriers.places, looks.carriers.turns
    least, checks = _INFINITE, 0
    for k in range(t - 1, min(t + 1, places.shape[0])):
        part, near = HELD_EARLY if k == t else HELD_LATE, at_span(looks.obstacles, k)
        found, count = held_clearance(looks.scratch, looks.postures, posture, places[k], turns[k], near, part)
        least, checks = min(least, np.float32(found)), checks + count
    return least, checks


@helper
def _rule_out_through_trunk(scratch: Scratch, limb: Limb, extras: ExtraNodes, cost: Floats32) -> None:
    """Rule out extra nodes on the straight line back from the start that lie in the trunk, by their `cost`."""
    own, needed, _ = extras
    width, room, segments, axis = cost.shape[1] - EXTRA, scratch.limb, scratch.segments, scratch.axis
    for t in range(cost.shape[0]):
        if needed[t, BACK]:
            pose_into(limb, room, own[t, BACK : BACK + 1], _ONE, _FIRST, segments)
            if not is_clear_of_trunk(segments, _FIRST, limb.trunk, limb.allowed, axis):
                cost[t, width + BACK] = _INFINITE
