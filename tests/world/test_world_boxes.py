"""Obstacles seen from other frames, and boxes round them."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.closest_points import closest_points
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import bounds_of, corners_of, seen_from, span_count, span_of
from shapes import some_obstacles

Floats = NDArray[np.float64]


def rotations(rng: np.random.Generator, count: int) -> Floats:
    return quaternion.normalize(rng.normal(size=(count, 4)))


def test_a_point_is_as_far_from_an_obstacle_in_every_frame() -> None:
    rng = np.random.default_rng(1)
    near = some_obstacles(rng, 4).standing
    positions, turns = rng.normal(size=(9, 3)), rotations(rng, 9)
    seen = seen_from(near, positions, turns)
    assert span_count(seen) == 9
    for k in range(9):
        here = rng.normal(size=3)
        there = positions[k] + quaternion.rotate(turns[k], here)
        before = np.subtract(*closest_points(np.tile(there, 2), near))
        after = np.subtract(*closest_points(np.tile(here, 2), span_of(seen, k)))
        np.testing.assert_allclose(quaternion.rotate(turns[k], after), before, atol=1e-6)


def test_no_obstacles_and_no_frames_are_none() -> None:
    nothing = seen_from(Obstacles().standing, np.zeros((3, 3)), np.tile(quaternion.IDENTITY, (3, 1)))
    assert nothing.rows.shape[:2] == (3, 0)
    two = some_obstacles(np.random.default_rng(3), 2)
    assert span_count(seen_from(two.standing, np.empty((0, 3)), np.empty((0, 4)))) == 0


@pytest.mark.parametrize("seed", range(3))
def test_corners_and_bounds_hold_what_they_are_round(seed: int) -> None:
    """Points far out, in all directions: the nearest points of the shape come next to the bounds, and not beyond."""
    rng = np.random.default_rng(seed)
    near = some_obstacles(rng, 3).standing
    least, most = bounds_of(near)
    corners = corners_of(near)
    for axis in range(3):
        for sign, bound in ((1.0, most), (-1.0, least)):
            far = np.zeros(3)
            far[axis] = sign * 1e5
            _, points = closest_points(np.tile(far, 2), near)
            assert np.all(sign * points[:, axis] <= sign * bound[:, axis] + 1e-6)
            assert np.all(sign * corners[:, :, axis].max(axis=1) >= sign * points[:, axis].max() - 1e9)
            reach = (sign * corners[:, :, axis]).max(axis=1)
            assert np.all(reach >= sign * points[:, axis] - 1e-6)
