"""What the exact planner's kernels leave out is far away, and what they keep is the clearance that others find."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.geometry import quaternion
from elbowroom.planning.exact.lattice.postures import BLOCK, blocks_of
from elbowroom.world.obstacles.blocks import COMFORT, capsule_clearances, lower_blocks
from elbowroom.world.obstacles.clearance import pairwise_clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import joined, move_into, room_for

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
FAR = np.float32(1e3)


def random_boxes(rng: np.random.Generator, count: int) -> Obstacles:
    turns = quaternion.normalize(rng.normal(size=(count, 4)))
    return Obstacles.boxes(rng.uniform(-0.9, 0.9, (count, 3)), turns, rng.uniform(0.02, 0.2, (count, 3)))


def neighbours(rng: np.random.Generator, capsules: int, count: int) -> Floats32:
    """Capsules (C, 6, N) of postures that are near to each other, as a block's are."""
    start, step = rng.uniform(-0.5, 0.5, (capsules, 3, 1)), rng.uniform(-0.3, 0.3, (capsules, 3, 1))
    ends = np.concatenate([start, start + step], axis=1) + rng.uniform(-0.05, 0.05, (capsules, 6, count))
    return ends.astype(np.float32)


def as_near_as_asked(found: Floats32, truth: Floats32) -> None:
    asked = truth < COMFORT
    assert 0.05 < asked.mean() < 0.95
    np.testing.assert_array_equal(found[asked], truth[asked])
    assert np.all(found[~asked] >= COMFORT)
    assert np.all((found == truth) | (found == FAR) | (found > truth))


@pytest.mark.parametrize(("postures", "boxes"), [(1, 3), (16, 1), (100, 7), (700, 40)])
def test_blocks_have_the_least_of_the_pairs_wherever_it_is_asked_for(postures: int, boxes: int) -> None:
    rng = np.random.default_rng(postures)
    found, truth, checks, pairs = [], [], 0, 0
    for _ in range(30 if postures < 100 else 3):
        parts = [neighbours(rng, 3, min(BLOCK, postures - begin)) for begin in range(0, postures, BLOCK)]
        segments, radii = np.concatenate(parts, axis=2), rng.uniform(0.03, 0.08, 3).astype(np.float32)
        lanes, balls = blocks_of(segments, radii)
        near = random_boxes(rng, boxes).standing
        spare = joined(near, random_boxes(np.random.default_rng(0), 2).standing)  # behind the count, not looked at
        out = np.full((len(lanes), BLOCK), FAR, np.float32)
        checks += lower_blocks(lanes, balls, spare, boxes, out)
        pairs += lanes.shape[0] * lanes.shape[1] * boxes * BLOCK
        found.append(out.ravel()[:postures])
        truth.append(pairwise_clearance(segments, radii, near).min(axis=(0, 1)))
    assert checks % BLOCK == 0
    assert 0 < checks < pairs
    as_near_as_asked(np.concatenate(found), np.concatenate(truth))


def test_capsules_have_their_own_clearance_wherever_it_is_asked_for() -> None:
    rng = np.random.default_rng(3)
    found, truth, checks = [], [], 0
    for _ in range(40):
        segments, radii = neighbours(rng, 4, BLOCK), rng.uniform(0.03, 0.08, 4).astype(np.float32)
        lanes = np.concatenate([segments, np.broadcast_to(radii[:, None, None], (4, 1, BLOCK))], axis=1)
        near = random_boxes(rng, 5).standing
        out = np.full((4, BLOCK), FAR, np.float32)
        checks += capsule_clearances(np.ascontiguousarray(lanes), near, 5, out)
        found.append(out)
        truth.append(pairwise_clearance(segments, radii, near).min(axis=1))
    assert 0 < checks < 40 * 4 * 5 * BLOCK
    as_near_as_asked(np.concatenate(found), np.concatenate(truth))


def test_nothing_near_lowers_nothing() -> None:
    segments, radii = neighbours(np.random.default_rng(1), 2, 20), np.full(2, 0.05, np.float32)
    lanes, balls = blocks_of(segments, radii)
    away = Obstacles.boxes([[9.0, 0.0, 0.0]], [quaternion.IDENTITY], [[0.3, 0.3, 0.3]]).standing
    out = np.full((len(lanes), BLOCK), FAR, np.float32)
    assert lower_blocks(lanes, balls, away, 1, out) == 0
    assert lower_blocks(lanes, balls, away, 0, out) == 0
    assert np.all(out == FAR)


def test_a_box_in_a_frame_is_as_far_as_it_was() -> None:
    rng = np.random.default_rng(5)
    near = random_boxes(rng, 6).standing
    moved = room_for(near, 6)
    place, turn = rng.uniform(-1.0, 1.0, 3), quaternion.normalize(rng.normal(size=4))
    for b in range(6):
        move_into(near, b, place, turn, moved, b)
    segments = neighbours(rng, 3, 30).astype(np.float64)
    ends = segments.reshape(3, 2, 3, 30).transpose(0, 1, 3, 2) - place
    inside = quaternion.rotate(quaternion.conjugate(turn), ends.reshape(-1, 3)).reshape(3, 2, 30, 3)
    seen = inside.transpose(0, 1, 3, 2).reshape(3, 6, 30)
    radii = np.full(3, 0.05)
    np.testing.assert_allclose(
        pairwise_clearance(seen, radii, moved), pairwise_clearance(segments, radii, near), atol=2e-6
    )
