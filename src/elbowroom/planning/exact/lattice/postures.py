"""The postures of one local group, frozen: where their capsules are, and which follows which within a key interval.

Lanes of the vector loops are postures, sixteen to a block. A block holds postures that are near to each other, and for
each capsule a ball that holds it in all sixteen: what the ball is clear of, none of them touches.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.by_reference import by_reference
from elbowroom.jit import exact_kernel
from elbowroom.planning.model.limb import Limb, pose
from elbowroom.planning.model.self_contact import clear_of_trunk
from elbowroom.planning.paper.activity_graph import squared_distance

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Longs = NDArray[np.int64]
Ints = NDArray[np.int32]

BLOCK = 16  # lanes of the widest vector register
BETWEEN = 5  # samples of an edge, at equal parts of a key interval
_TIMES = np.arange(1, BETWEEN + 1) / (BETWEEN + 1.0)
ON_EDGE = _TIMES**2 * (3.0 - 2.0 * _TIMES)  # the share of the edge done then: it begins and ends at rest
_SPARE = 0.15  # metres: a posture between the known ones may reach so much farther


@by_reference
class Postures(NamedTuple):
    """Postures of a limb and the edges between them, staying among them; none is longer than `step`."""

    limb: Limb
    configurations: Floats  # (V, d) radians
    columns: Floats32  # (d, W) the same by components; W = 16 B, the last repeated
    segments: Floats32  # (C, 6, V) capsules in the limb's frame, metres
    lanes: Floats32  # (B, C, 7, 16) the same by blocks, with radii; the last block repeats the last posture
    balls: Floats  # (B, C, 4) centre and radius
    moves: Floats32  # (V, W) squared length of each edge, infinite where there is none
    spans: Longs  # (V, 2) the first lane of the first block that an edge leads to, and the end of the last
    pairs: Ints  # (V, V) number of the pair that an edge joins; -1 for none and for staying
    between: Floats32  # (P, BETWEEN, C, 6) capsules on the edge from the lower number of a pair to the higher
    step: float  # radians
    reach: float  # metres: no capsule gets farther from the limb's frame


def postures_of(limb: Limb, configurations: Floats, step: float, *, ordered: bool = False) -> Postures:
    """Join `configurations` (V, d) that are at most `step` apart, unless the edge leads through the trunk.

    They come in another order, in which neighbours share a block, unless they are `ordered`.
    """
    known = np.ascontiguousarray(configurations, np.float64)
    points = known if ordered else known[_neighbourly(pose(limb, known))]
    segments = pose(limb, points)
    ends = segments.transpose(0, 2, 1).reshape(-1, 3)
    reach = float(np.linalg.norm(ends, axis=1).max()) + float(limb.radii.max()) + _SPARE
    lanes, balls = blocks_of(segments, limb.radii)
    low, high = _near_pairs(points, step * step)
    samples = [pose(limb, points[low] + share * (points[high] - points[low])) for share in ON_EDGE]
    clear = np.all([clear_of_trunk(sample, limb.trunk, limb.allowed) for sample in samples], axis=0)
    between = np.ascontiguousarray(np.stack(samples)[..., clear].transpose(3, 0, 1, 2))
    low, high = low[clear], high[clear]
    moves, pairs = _edges(points, low, high, len(lanes) * BLOCK)
    filled = np.minimum(np.arange(len(lanes) * BLOCK), len(points) - 1)
    columns = np.ascontiguousarray(points[filled].T, np.float32)
    return Postures(
        limb, points, columns, segments, lanes, balls, moves, spans_of(moves), pairs, between, float(step), reach
    )


def _neighbourly(segments: Floats32) -> NDArray[np.int64]:
    """An order (V,) in which blocks of sixteen hold postures with capsules near to each other: halved again and again
    where they spread most."""
    places = segments.transpose(2, 0, 1).reshape(segments.shape[2], -1)

    def order(members: NDArray[np.int64]) -> list[int]:
        if len(members) <= BLOCK:
            return [int(member) for member in members]
        widest = int(np.argmax(np.ptp(places[members], axis=0)))
        ranked = members[np.argsort(places[members, widest], kind="stable")]
        half = (len(ranked) // 2 + BLOCK - 1) // BLOCK * BLOCK
        return order(ranked[:half]) + order(ranked[half:])

    return np.array(order(np.arange(len(places))), np.int64)


def blocks_of(segments: Floats32, radii: Floats32) -> tuple[Floats32, Floats]:
    """Capsules (C, 6, V) as `lanes` (B, C, 7, 16) and their `balls` (B, C, 4)."""
    count, _, size = segments.shape
    blocks = (size + BLOCK - 1) // BLOCK
    at = np.minimum(np.arange(blocks * BLOCK), size - 1).reshape(blocks, BLOCK)
    lanes = np.empty((blocks, count, 7, BLOCK), np.float32)
    lanes[:, :, :6] = segments[:, :, at].transpose(2, 0, 1, 3)
    lanes[:, :, 6] = radii[:, None]
    ends = lanes[:, :, :6].astype(np.float64).reshape(blocks, count, 2, 3, BLOCK)
    centers = 0.5 * (ends.max(axis=(2, 4)) + ends.min(axis=(2, 4)))
    apart = np.linalg.norm(ends - centers[:, :, None, :, None], axis=3).max(axis=(2, 3))
    return lanes, np.concatenate([centers, (apart + radii)[..., None]], axis=2)


@exact_kernel
def _near_pairs(points: Floats, reach: float) -> tuple[Ints, Ints]:
    """All pairs low < high at most the root of `reach` apart."""
    count, size = 0, points.shape[0]
    low, high = np.empty(size * size // 2, np.int32), np.empty(size * size // 2, np.int32)
    for i in range(size):
        for j in range(i + 1, size):
            if squared_distance(points[i], points[j]) <= reach:
                low[count], high[count] = i, j
                count += 1
    return low[:count].copy(), high[:count].copy()


def _edges(points: Floats, low: Ints, high: Ints, width: int) -> tuple[Floats32, Ints]:
    """The tables `moves` (V, width) and `pairs` (V, V) of `Postures`, for pairs low < high of points (V, d)."""
    moves = np.full((len(points), width), np.inf, np.float32)
    pairs = np.full((len(points), len(points)), -1, np.int32)
    squares = np.sum((points[high] - points[low]) ** 2, axis=1)
    stay = np.arange(len(points))
    moves[stay, stay] = 0.0
    moves[low, high], moves[high, low] = squares, squares
    pairs[low, high], pairs[high, low] = np.arange(len(low)), np.arange(len(low))
    return moves, pairs


def spans_of(moves: Floats32) -> Longs:
    """The `spans` (V, 2) of edges with squared lengths `moves` (V, W): outside of them there are none."""
    reached = np.any(np.isfinite(moves).reshape(len(moves), -1, BLOCK), axis=2)
    ends = reached.shape[1] - np.argmax(reached[:, ::-1], axis=1)
    return np.stack([np.argmax(reached, axis=1), ends], axis=1) * BLOCK
