"""Which steps of one key interval touch: looked at in a batch where the search is blocked, the promising ones first."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper, inner_exact_kernel, plain
from elbowroom.planning.exact.lattice.lattice import EXTRA, Lattice, Work, least_in, slopes_of, squares_from
from elbowroom.planning.exact.lattice.postures import BETWEEN, BLOCK, ON_EDGE
from elbowroom.planning.exact.sweep.motion_bounds import SWEEP
from elbowroom.planning.exact.sweep.scratch import Scratch
from elbowroom.planning.model.limb import pose_into
from elbowroom.planning.paper.activity_graph import squared_distance
from elbowroom.world.obstacles.blocks import capsule_clearances_in
from elbowroom.world.obstacles.layout import Nearby
from elbowroom.world.obstacles.rows import around, move_into

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Longs = NDArray[np.int64]

MOST_EDGES = 128  # looked at in one go
_INFINITE = np.float32(np.inf)
_ONE = plain(1)  # posture


@exact_kernel
def _distances(lattice: Lattice, depth: int, node: int, out: Floats32) -> None:
    """The squared distances (W+OWN,) of the nodes of a depth from one of them."""
    postures, width = lattice.postures, lattice.postures.moves.shape[1]
    posture = postures.configurations[node] if node < width else lattice.extras[depth, node - width]
    squares_from(postures.columns, posture, out[:width])
    for e in range(EXTRA):
        out[width + e] = squared_distance(lattice.extras[depth, e], posture)


@inner_exact_kernel
def close_near(lattice: Lattice, work: Work, depth: int, source: int, target: int, radius: float) -> None:
    """Close a step, and those whose ends together are within `radius` of its; not the last plan's other steps."""
    nodes, most = lattice.cost.shape[1], np.float32(radius * radius)
    before, after = work.base, work.slopes
    _distances(lattice, depth, source, before)
    _distances(lattice, depth + 1, target, after)
    previous, closed = lattice.previous[depth + 1], lattice.closed[lattice.masks[depth]]
    for node in range(nodes):
        if before[node] <= most:
            row, spared = closed[node], closed[node, previous]
            for other in range(nodes):
                if before[node] + after[other] <= most:
                    row[other] = True
            if depth == 0 or node == lattice.previous[depth]:
                row[previous] = spared
    closed[source, target] = True


@helper
def promising_edges(lattice: Lattice, work: Work, depth: int, most: float, seen: Bools, found: Longs) -> int:
    """The steps of a key interval through which a way might go that costs at most `most`, without those `seen`.

    They are written to `found` (MOST_STEPS, 2), and marked as seen in `seen` (W+OWN, W+OWN). Returns their number.
    """
    postures, extras, cost = lattice.postures, lattice.extras, lattice.cost
    known, moves, step = postures.configurations, postures.moves, postures.step
    weight, limit, onward, squares = np.float32(lattice.weight), np.float32(most), work.onward, work.squares
    (size, width), nodes = moves.shape, cost.shape[1]
    count, costs, base, end = 0, work.costs[depth], work.base, work.slopes
    square = np.float32(slopes_of(lattice, depth, depth, base))
    slopes_of(lattice, depth, depth + 1, end)
    for b in range(np.uint64(nodes)):
        end[b] = onward[depth + 1, b] + cost[depth + 1, b] - end[b]
    for a in range(np.uint64(nodes)):
        base[a] = costs[a] + base[a] + square
    least, first, likely, few = least_in(end), least_in(base), work.origins, 0
    closed = lattice.closed[lattice.masks[depth]]
    for b in range(nodes):
        if first + end[b] <= limit:
            likely[few] = b
            few += 1
    for a in range(nodes):
        start = base[a]
        if not start + least <= limit:
            continue
        for i in range(few):
            b = likely[i]
            if not start + end[b] <= limit or seen[a, b] or closed[a, b] or a == b:
                continue
            if b >= width:
                own, posture = extras[depth + 1, b - width], extras[depth, max(a - width, 0)]
                posture = known[a] if a < width else posture
                move = np.float32(squared_distance(own, posture))
                move = move if move <= step * step else _INFINITE
            else:
                move = moves[a, b] if a < size else squares[depth, a - width, b]
            if start + weight * move + end[b] <= limit:
                seen[a, b] = True
                found[count, 0], found[count, 1] = a, b
                count += 1
                if count == MOST_EDGES:
                    return count
    return count


@helper
def _posed_between(scratch: Scratch, lattice: Lattice, depth: int, steps: Longs, first: int, part: int) -> None:
    """Sixteen steps' postures on their way, from the step `first` on, at one of the looks between, into the room.

    The lanes beyond the steps (K, 2) repeat the last.
    """
    postures, extras, share, lanes = lattice.postures, lattice.extras, ON_EDGE[part], scratch.checks.lanes
    known, limb, pairs, between = postures.configurations, postures.limb, postures.pairs, postures.between
    configurations, room, filled = scratch.configurations, scratch.limb, min(steps.shape[0] - first, BLOCK)
    (size, width), radii = postures.moves.shape, limb.radii
    for n in range(filled):
        a, b = steps[first + n, 0], steps[first + n, 1]
        pair = pairs[a, b] if a < size and b < size else -1
        if pair >= 0:
            on_way = between[pair, part if a < b else BETWEEN - 1 - part]
            for c in range(lanes.shape[0]):
                for i in range(6):
                    lanes[c, i, n] = on_way[c, i]
        else:
            start = known[a] if a < width else extras[depth, a - width]
            end = known[b] if b < width else extras[depth + 1, b - width]
            for i in range(start.shape[0]):
                configurations[0, i] = start[i] + share * (end[i] - start[i])
            pose_into(limb, room, configurations, _ONE, n, lanes)
    for c in range(lanes.shape[0]):
        for i in range(6):
            for n in range(filled, BLOCK):
                lanes[c, i, n] = lanes[c, i, filled - 1]
        for n in range(BLOCK):
            lanes[c, 6, n] = radii[c]


@helper
def close_edges(
    scratch: Scratch,
    lattice: Lattice,
    depth: int,
    steps: Longs,
    carrier: tuple[Floats, Floats],
    obstacles: Nearby,
    motion_margin: float,
) -> int:
    """Close those of the steps (K, 2) that touch on the way; returns the capsules checked.

    The `carrier` are the frames that carry the limb during the interval: places (SWEEP+1, 3), turns (SWEEP+1, 4).
    """
    out, closed, checks, many = scratch.found, lattice.closed[lattice.masks[depth]], 0, steps.shape[0]
    reach, (places, turns) = lattice.postures.reach, carrier
    within, near, framed = scratch.checks, scratch.near, scratch.framed
    for part in range(BETWEEN):
        sample = (part + 1) * SWEEP // (BETWEEN + 1)
        place, turn = places[sample], turns[sample]
        count = around(obstacles, place, reach, near)
        if count == 0:
            continue
        for b in range(count):
            move_into(near, b, place, turn, framed, b)
        for first in range(0, many, BLOCK):
            _posed_between(scratch, lattice, depth, steps, first, part)
            out[:] = _INFINITE
            checks += capsule_clearances_in(within, framed, count, out)
            for k in range(first, min(first + BLOCK, many)):
                for c in range(out.shape[0]):
                    if out[c, k - first] < motion_margin:
                        closed[steps[k, 0], steps[k, 1]] = True
    return checks
