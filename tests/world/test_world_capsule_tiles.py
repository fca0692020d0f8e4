"""The innermost kernel: whatever the axis, one formula, and only the pairs that are listed."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.clearance import pairwise_clearance
from elbowroom.world.obstacles.layout import LANES, PER_METRE, ROW, TILE
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.pairs.tiles import fill_tile_rows, lower_squares, lower_to_squares

Floats = NDArray[np.float64]


def distances(segments: Floats, row: Floats) -> Floats:
    """Distances (N,) of axes (6, N) from a box, float64: the least over all break points of the distance's slope and
    the places between two of them where the slope is zero."""
    turn, half = row[3:12].reshape(3, 3), row[12:15, None]
    start, step = turn @ (segments[:3] - row[:3, None]), turn @ (segments[3:] - segments[:3])

    def beyond(t: Floats) -> Floats:
        at = start + t * step
        return np.asarray(at - np.clip(at, -half, half))

    def slope(t: Floats) -> Floats:
        return np.asarray((beyond(t) * step).sum(axis=0))

    with np.errstate(divide="ignore", invalid="ignore"):
        meets = np.concatenate([(half - start) / step, (-half - start) / step])
    count = meets.shape[1]
    inner = np.clip(np.where(np.isfinite(meets), meets, 0.0), 0.0, 1.0)
    stops = np.sort(np.concatenate([np.zeros((1, count)), inner, np.ones((1, count))]), axis=0)
    least = np.full(count, np.inf)
    for low, high in zip(stops, [*stops[1:], stops[-1]], strict=True):
        rises = np.maximum(slope(high) - slope(low), 1e-300)
        for t in (low, np.clip(low - slope(low) * (high - low) / rises, low, high)):
            least = np.minimum(least, np.linalg.norm(beyond(t), axis=0))
    return least


@pytest.mark.parametrize("length", [30.0, 2.0, 0.4, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-12, 0.0])
@pytest.mark.parametrize("upright", [True, False])
def test_axes_of_any_length_and_slope(length: float, upright: bool) -> None:
    rng = np.random.default_rng(7)
    count, boxes = 3000, 6
    starts, steps = rng.uniform(-1.2, 1.2, (3, count)), rng.uniform(-length, length, (3, count))
    steps[:, ::2] *= 10.0 ** rng.uniform(-9.0, 0.0, (3, count))[:, ::2]  # nearly along a face, or an edge
    turns = quaternion.normalize(rng.normal(size=(boxes, 4)))
    turns[:] = quaternion.IDENTITY if upright else turns
    some = Obstacles.boxes(rng.uniform(-1.0, 1.0, (boxes, 3)), turns, rng.uniform(1e-4, 0.6, (boxes, 3)))
    segments = np.concatenate([starts, starts + steps]).astype(np.float32)
    found = pairwise_clearance(segments[None], np.zeros(1), some.standing)[0]
    rounding = 1e-6 * max(1.0, length)
    for b, row in enumerate(some.standing.rows):
        np.testing.assert_allclose(found[b], distances(segments.astype(np.float64), row), atol=rounding, rtol=0.0)


def test_only_the_listed_pairs_count() -> None:
    rng = np.random.default_rng(1)
    tiles, boxes = rng.uniform(-1.0, 1.0, (4, 7, LANES)).astype(np.float32), 3
    turns = quaternion.normalize(rng.normal(size=(boxes, 4)))
    near = Obstacles.boxes(rng.uniform(-1.0, 1.0, (boxes, 3)), turns, rng.uniform(0.05, 0.3, (boxes, 3))).standing
    rows = np.empty(boxes * ROW, np.float32)
    fill_tile_rows(near.rows, boxes, rows)
    pairs = np.array([[2, 1], [0, 0], [2, 2], [1, 1]])
    squares = np.full((4, LANES), np.inf, np.float32)
    lower_squares(tiles.reshape(4 * TILE), rows, near.packed, pairs, 3, squares.reshape(-1))
    assert np.all(np.isposinf(squares[[1, 3]]))
    metres = np.full((4, LANES), np.inf, np.float32)
    for tile in range(4):
        lower_to_squares(squares[tile], 0.0, metres[tile])
    every = pairwise_clearance(tiles[:, :6], np.zeros(4), near)
    np.testing.assert_array_equal(metres[0], every[0, 0])
    np.testing.assert_array_equal(metres[2], every[2, 1:].min(axis=0))
    np.testing.assert_allclose(np.sqrt(squares[0]), metres[0] * PER_METRE, rtol=1e-6)
