"""Which steps of one key interval touch: looked at in a batch where the search is blocked, the promising ones first."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_inner_kernel, inlined
from elbowroom.planning.activity_graph import squared_distance
from elbowroom.planning.exact.clearances import box_in_frame, boxes_around, capsule_clearances
from elbowroom.planning.exact.lattice import OWN, Lattice, Work, posture_of, slopes_of, squares_from
from elbowroom.planning.exact.postures import BETWEEN, BLOCK, ON_WAY, Postures
from elbowroom.planning.exact.ways import SWEEP
from elbowroom.planning.limb import Limb, pose

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Ints = NDArray[np.int32]
Longs = NDArray[np.int64]

MOST_STEPS = 128  # looked at in one go
_INFINITE = np.float32(np.inf)


@exact_inner_kernel
def _distances(lattice: Lattice, depth: int, node: int, out: Floats32) -> None:
    """The squared distances (W+OWN,) of the nodes of a depth from one of them."""
    width = lattice.moves.shape[1]
    posture = posture_of(lattice, depth, node)
    squares_from(lattice.columns, posture, out[:width])
    for e in range(OWN):
        out[width + e] = squared_distance(lattice.own[depth, e], posture)


@exact_inner_kernel
def ban_near(lattice: Lattice, depth: int, source: int, target: int, radius: float) -> None:
    """Close a step, and those whose ends together are within `radius` of its; not the last plan's other steps."""
    nodes, most = lattice.price.shape[1], np.float32(radius * radius)
    before, after = np.empty(nodes, np.float32), np.empty(nodes, np.float32)
    _distances(lattice, depth, source, before)
    _distances(lattice, depth + 1, target, after)
    kept, closed = lattice.kept[depth + 1], lattice.closed[lattice.masks[depth]]
    for node in range(nodes):
        if before[node] <= most:
            row, spared = closed[node], closed[node, kept]
            for other in range(nodes):
                if before[node] + after[other] <= most:
                    row[other] = _INFINITE
            if depth == 0 or node == lattice.kept[depth]:
                row[kept] = spared
    closed[source, target] = _INFINITE


@exact_inner_kernel
def promising(lattice: Lattice, work: Work, depth: int, most: float, seen: Bools) -> Longs:
    """The steps (K, 2) of a key interval through which a way might go that costs at most `most`, without those `seen`.

    They are marked as seen in `seen` (W+OWN, W+OWN).
    """
    size, nodes, weight = lattice.postures.shape[0], lattice.price.shape[1], np.float32(lattice.weight)
    width, limit = nodes - OWN, np.float32(most)
    found, count = np.empty((MOST_STEPS, 2), np.int64), 0
    costs, base, end = work.costs[depth], np.empty(nodes, np.float32), np.empty(nodes, np.float32)
    square = np.float32(slopes_of(lattice, depth, depth, base))
    slopes_of(lattice, depth, depth + 1, end)
    for b in range(np.uint64(nodes)):
        end[b] = work.left[depth + 1, b] + lattice.price[depth + 1, b] - end[b]
    least, closed = end.min(), lattice.closed[lattice.masks[depth]]
    for a in range(nodes):
        start = costs[a] + base[a] + square
        if not start + least <= limit:
            continue
        for b in range(nodes):
            if not start + end[b] <= limit or seen[a, b] or closed[a, b] == _INFINITE or a == b:
                continue
            if b >= width:
                own = lattice.own[depth + 1, b - width]
                move = np.float32(squared_distance(own, posture_of(lattice, depth, a)))
                move = move if move <= lattice.step * lattice.step else _INFINITE
            else:
                move = lattice.moves[a, b] if a < size else work.squares[depth, a - width, b]
            if start + weight * move + end[b] <= limit:
                seen[a, b] = True
                found[count, 0], found[count, 1] = a, b
                count += 1
                if count == MOST_STEPS:
                    return found
    return found[:count]


@inlined
def _posed_between(
    limb: Limb, pairs: Ints, between: Floats32, lattice: Lattice, depth: int, steps: Longs, part: int, lanes: Floats32
) -> None:
    """The capsules (C, 6, K) of every step's posture on its way, at one of the looks between."""
    size = lattice.postures.shape[0]
    share = ON_WAY[part]
    configuration, last = np.empty((1, lattice.goals.shape[1])), steps.shape[0] - 1
    for k in range(lanes.shape[2]):
        a, b = steps[min(k, last), 0], steps[min(k, last), 1]
        pair = pairs[a, b] if a < size and b < size else -1
        if pair >= 0:
            on_way = between[pair, part if a < b else BETWEEN - 1 - part]
            for c in range(lanes.shape[0]):
                for i in range(6):
                    lanes[c, i, k] = on_way[c, i]
        elif k <= last:
            start, end = posture_of(lattice, depth, a), posture_of(lattice, depth + 1, b)
            for i in range(configuration.shape[1]):
                configuration[0, i] = start[i] + share * (end[i] - start[i])
            posed = pose(limb, configuration)
            for c in range(lanes.shape[0]):
                for i in range(6):
                    lanes[c, i, k] = posed[c, i, 0]
        else:
            for c in range(lanes.shape[0]):
                for i in range(6):
                    lanes[c, i, k] = lanes[c, i, last]


@exact_inner_kernel
def _take(lanes: Floats32, radii: Floats32, first: int, piece: Floats32) -> None:
    """Sixteen lanes and their radii into `piece` (C, 7, 16)."""
    for c in range(piece.shape[0]):
        for n in range(BLOCK):
            for i in range(6):
                piece[c, i, n] = lanes[c, i, first + n]
            piece[c, 6, n] = radii[c]


@exact_inner_kernel
def close_steps(
    postures: Postures,
    lattice: Lattice,
    depth: int,
    steps: Longs,
    places: Floats,
    turns: Floats,
    boxes: Floats,
    skin: float,
) -> int:
    """Close those of `steps` (K, 2) that touch on the way; returns the capsules checked.

    `places` (SWEEP+1, 3) and `turns` (SWEEP+1, 4) are the frames that carry the limb during the interval.
    """
    limb, pairs, between, reach = postures.limb, postures.pairs, postures.between, postures.reach
    width, radii = (steps.shape[0] + BLOCK - 1) // BLOCK * BLOCK, limb.radii
    lanes = np.empty((radii.shape[0], 6, width), np.float32)
    piece, out = np.empty((radii.shape[0], 7, BLOCK), np.float32), np.empty((radii.shape[0], BLOCK), np.float32)
    near, moved, closed = np.empty_like(boxes), np.empty_like(boxes), lattice.closed[lattice.masks[depth]]
    checks = 0
    for part in range(BETWEEN):
        look = (part + 1) * SWEEP // (BETWEEN + 1)
        place, turn = places[look], turns[look]
        count = boxes_around(boxes, place, reach, near)
        if count == 0:
            continue
        for b in range(count):
            box_in_frame(near[b], place, turn, moved[b])
        _posed_between(limb, pairs, between, lattice, depth, steps, part, lanes)
        for block in range(0, width, BLOCK):
            out[:] = _INFINITE
            _take(lanes, radii, block, piece)
            checks += capsule_clearances(piece, moved, count, out)
            for k in range(block, min(block + BLOCK, steps.shape[0])):
                for c in range(radii.shape[0]):
                    if out[c, k - block] < skin:
                        closed[steps[k, 0], steps[k, 1]] = _INFINITE
    return checks
