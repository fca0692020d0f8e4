"""Which steps of one key interval touch: looked at in a batch where the search is blocked, the promising ones first."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.clearances import box_in_frame, boxes_around, capsule_clearances
from elbowroom.planning.exact.lattice import OWN, Lattice, Work, posture_of, slopes_of, squares_from
from elbowroom.planning.exact.postures import BETWEEN, BLOCK, Postures
from elbowroom.planning.exact.ways import SWEEP
from elbowroom.planning.limb import pose

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Bools = NDArray[np.bool_]
Ints = NDArray[np.int32]

MOST_STEPS = 128  # looked at in one go
_INFINITE = np.float32(np.inf)


@exact_kernel
def _distances(lattice: Lattice, depth: int, node: int, out: Floats32) -> None:
    """The squared distances (W+OWN,) of the nodes of a depth from one of them."""
    width = lattice.moves.shape[1]
    posture = posture_of(lattice, depth, node)
    squares_from(lattice.columns, posture, out[:width])
    for e in range(OWN):
        out[width + e] = np.sum((lattice.own[depth, e] - posture) ** 2)


@exact_kernel
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


@exact_kernel
def promising(lattice: Lattice, work: Work, depth: int, most: float, seen: Bools) -> Ints:
    """The steps (K, 2) of a key interval through which a way might go that costs at most `most`, without those `seen`.

    They are marked as seen in `seen` (W+OWN, W+OWN).
    """
    size, nodes, weight = lattice.postures.shape[0], lattice.price.shape[1], np.float32(lattice.weight)
    width, limit = nodes - OWN, np.float32(most)
    found, count = np.empty((MOST_STEPS, 2), np.int32), 0
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
                move = np.float32(np.sum((lattice.own[depth + 1, b - width] - posture_of(lattice, depth, a)) ** 2))
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


@exact_kernel
def _posed_between(postures: Postures, lattice: Lattice, depth: int, steps: Ints, part: int, lanes: Floats32) -> None:
    """The capsules (C, 7, K) of every step's posture at `part` of its way."""
    size = lattice.postures.shape[0]
    share = (part + 1.0) / (BETWEEN + 1.0)
    configuration = np.empty((1, lattice.goals.shape[1]))
    for k in range(lanes.shape[2]):
        a, b = steps[min(k, steps.shape[0] - 1)]
        pair = postures.pairs[a, b] if a < size and b < size else -1
        if pair >= 0:
            lanes[:, :6, k] = postures.between[pair, part if a < b else BETWEEN - 1 - part]
        elif k < steps.shape[0]:
            start = posture_of(lattice, depth, a)
            configuration[0] = start + share * (posture_of(lattice, depth + 1, b) - start)
            lanes[:, :6, k] = pose(postures.limb, configuration)[:, :, 0]
        else:
            lanes[:, :6, k] = lanes[:, :6, k - 1]
    for c in range(lanes.shape[0]):
        lanes[c, 6, :] = postures.limb.radii[c]


@exact_kernel
def close_steps(
    postures: Postures,
    lattice: Lattice,
    depth: int,
    steps: Ints,
    places: Floats,
    turns: Floats,
    boxes: Floats,
    skin: float,
) -> int:
    """Close those of `steps` (K, 2) that touch half-way or at a quarter of the way; returns the capsules checked.

    `places` (SWEEP+1, 3) and `turns` (SWEEP+1, 4) are the frames that carry the limb during the interval.
    """
    width = (steps.shape[0] + BLOCK - 1) // BLOCK * BLOCK
    count_of_capsules = postures.limb.radii.shape[0]
    lanes = np.empty((count_of_capsules, 7, width), np.float32)
    out = np.empty((count_of_capsules, BLOCK), np.float32)
    near, moved, closed = np.empty_like(boxes), np.empty_like(boxes), lattice.closed[lattice.masks[depth]]
    checks = 0
    for part in range(BETWEEN):
        look = (part + 1) * SWEEP // (BETWEEN + 1)
        count = boxes_around(boxes, places[look], postures.reach, near)
        if count == 0:
            continue
        for b in range(count):
            box_in_frame(near[b], places[look], turns[look], moved[b])
        _posed_between(postures, lattice, depth, steps, part, lanes)
        for block in range(0, width, BLOCK):
            out[:] = _INFINITE
            piece = lanes[:, :, block : block + BLOCK].copy()
            checks += capsule_clearances(piece, moved, count, out)
            for k in range(block, min(block + BLOCK, steps.shape[0])):
                for c in range(count_of_capsules):
                    if out[c, k - block] < skin:
                        closed[steps[k, 0], steps[k, 1]] = _INFINITE
    return checks
