"""What a tile passes by is farther than what is known already, and most of what is far is passed by."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.geometry import quaternion
from elbowroom.jit import kernel
from elbowroom.world.obstacles.clearance import clearance, pairwise_clearance
from elbowroom.world.obstacles.layout import LANES, PER_METRE, TILE, Nearby
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.passing_by import apart_from, boxes_round
from elbowroom.world.obstacles.rows import bounds_of
from elbowroom.world.obstacles.shapes import Box, Cylinder

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]

AROUND = 60


@kernel
def apart(near: Nearby, tiles: Floats32, squares: Floats32) -> Floats32:
    """How far obstacles lie outside of what the first tile reaches, for who is no kernel."""
    sides = boxes_round(near).sides
    out = np.empty(sides.shape[1], np.float32)
    apart_from(tiles, 0, squares, sides, out)
    return out


@kernel
def boxes(near: Nearby) -> tuple[Floats32, bool]:
    """The boxes round obstacles, and whether any of these is dear, for who is no kernel."""
    found = boxes_round(near)
    return found.sides, found.dear


def obstacles(rng: np.random.Generator) -> Nearby:
    """Boxes and cylinders, small among all that is about them."""
    turns, sizes = quaternion.normalize(rng.normal(size=(AROUND, 4))), rng.uniform(0.04, 0.6, (AROUND, 3))
    shapes = [Box((x, y, z)) if n % 2 else Cylinder(0.5 * x, y) for n, (x, y, z) in enumerate(sizes.tolist())]
    names = tuple(str(n) for n in range(AROUND))
    return Obstacles(tuple(shapes), rng.uniform(-2.0, 2.0, (AROUND, 3)), turns, names, ground=-9.0).standing


def limbs(rng: np.random.Generator) -> Floats32:
    """Sixteen axes (1, 6, LANES) of one capsule in postures that are near each other."""
    begin, step = rng.uniform(-1.0, 1.0, (3, 1)), rng.uniform(-0.3, 0.3, (3, 1))
    begins = begin + rng.uniform(-0.05, 0.05, (3, LANES))
    return np.concatenate([begins, begins + step])[None].astype(np.float32)


@pytest.mark.parametrize("known", [0.02, 0.3])
def test_what_is_passed_by_is_farther_than_what_is_known(known: float) -> None:
    rng, passed, far = np.random.default_rng(3), 0, 0
    for _ in range(20):
        near, axes = obstacles(rng), limbs(rng)
        squares, tiles = np.full(LANES, (known * PER_METRE) ** 2, np.float32), np.zeros(TILE, np.float32)
        tiles[: 6 * LANES] = axes[0].ravel()
        nearest = pairwise_clearance(axes, np.zeros(1), near)[0].min(axis=1)
        passes = apart(near, tiles, squares) > 0.0
        assert np.all(nearest[passes] > known)
        passed, far = passed + int(passes.sum()), far + int((nearest > known).sum())
    assert passed > 0.8 * far


def test_who_asks_for_little_is_told_the_same_among_many() -> None:
    rng = np.random.default_rng(4)
    for farthest in (0.0, 0.05, 0.4):
        near, axes = obstacles(rng), limbs(rng)
        told = clearance(axes, np.full(1, 0.06), near, farthest)
        all_told = pairwise_clearance(axes, np.full(1, 0.06), near).min(axis=(0, 1))
        np.testing.assert_array_equal(told, np.minimum(all_told, np.float32(farthest)))


def test_boxes_round_obstacles_are_a_little_larger_than_they_must_be() -> None:
    near = obstacles(np.random.default_rng(7))
    low, high = bounds_of(near)
    sides, _ = boxes(near)
    for spare in (low - sides[:3].T, sides[3:].T - high):
        assert np.all((spare > 0.9e-3) & (spare < 1.1e-3))


def test_boxes_are_looked_into_at_once_and_nothing_else_is() -> None:
    rng = np.random.default_rng(6)
    turns = quaternion.normalize(rng.normal(size=(AROUND, 4)))
    cheap = Obstacles.boxes(rng.uniform(-2.0, 2.0, (AROUND, 3)), turns, rng.uniform(0.02, 0.3, (AROUND, 3)))
    assert not boxes(cheap.standing)[1]
    assert boxes(obstacles(rng))[1]


def test_nothing_is_passed_by_while_nothing_is_known() -> None:
    rng = np.random.default_rng(5)
    tiles = np.zeros(TILE, np.float32)
    tiles[: 6 * LANES] = limbs(rng)[0].ravel()
    assert np.all(apart(obstacles(rng), tiles, np.full(LANES, np.inf, np.float32)) <= 0.0)
