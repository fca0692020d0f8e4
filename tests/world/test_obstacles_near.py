"""The broad phase leaves out nothing that is near, and the door's questions are answered as by looking at all."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.around_body import clearances_around
from elbowroom.world.obstacles.broad_phase import grids_of, meeting
from elbowroom.world.obstacles.clearance import clearance_of, pairwise_clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import about, bounds_of, is_empty
from elbowroom.world.obstacles.shapes import Sphere
from elbowroom.world.obstacles.tracks.moving import Moving, Track
from elbowroom.world.scene import Scene
from shapes import box_hull, some_obstacles

Floats = NDArray[np.float64]


def rectangles(rng: np.random.Generator, count: int, spread: float) -> tuple[Floats, Floats]:
    """Of all sizes, from millimetres to kilometres."""
    middle, size = rng.normal(size=(count, 2)) * spread, 10.0 ** rng.uniform(-3.0, 3.0, (count, 2))
    return middle - size, middle + size


@pytest.mark.parametrize("spread", [1.0, 30.0, 9000.0])
def test_what_meets_a_rectangle_is_found_and_nothing_else(spread: float) -> None:
    rng = np.random.default_rng(int(spread))
    least, most = rectangles(rng, 600, spread)
    grids = grids_of(least, most)
    for low, high in zip(*rectangles(rng, 200, spread), strict=True):
        expected = np.flatnonzero(np.all((least <= high) & (most >= low), axis=1))
        np.testing.assert_array_equal(meeting(grids, tuple(low), tuple(high)), expected)
    assert len(meeting(grids_of(least[:0], most[:0]), (-1.0, -1.0), (1.0, 1.0))) == 0


def test_bounds_that_only_just_meet_do() -> None:
    grids = grids_of(np.array([[0.0, 0.0], [1.0, 1.0]]), np.array([[1.0, 1.0], [3.0, 3.0]]))
    assert meeting(grids, (1.0, 1.0), (1.0, 1.0)).tolist() == [0, 1]
    assert meeting(grids, (-2.0, -2.0), (0.0, 0.0)).tolist() == [0]


def many(rng: np.random.Generator) -> Obstacles:
    """Obstacles of every shape far apart, at 300 m from the origin, and one that moves."""
    some = some_obstacles(rng, 40)
    far = np.array([300.0, 0.0, -200.0])
    centers = some.centers * [25.0, 1.0, 25.0] + far
    track = Track(
        "ball", Sphere(0.2), np.array([0.0, 10.0]), np.array([far, far + np.array([9.0, 1.0, 0.0])]), np.zeros(2)
    )
    return Obstacles(some.shapes, centers, some.rotations, some.standing_names, Moving((track,)))


def test_the_least_clearance_and_the_nearest_are_those_of_all() -> None:
    rng = np.random.default_rng(2)
    obstacles = many(rng)
    for _ in range(60):
        origin, time = np.array([300.0, -200.0]) + rng.uniform(-40.0, 40.0, 2), float(rng.uniform(0.0, 12.0))
        starts = rng.uniform([-0.5, 0.0, -0.5], [0.5, 1.8, 0.5], (4, 3))
        axes = np.concatenate([starts, starts + rng.uniform(-0.4, 0.4, (4, 3))], axis=1).astype(np.float32)
        radii = rng.uniform(0.03, 0.1, 4)
        everything = about(obstacles.at(time), origin[0], origin[1])
        found = obstacles.clearance(axes[:, :, None], radii, origin, time)
        assert found == pytest.approx(clearance_of(axes, radii, everything), abs=1e-6)
        nearest = obstacles.nearest(axes, radii, origin, time)
        assert nearest is not None
        gaps = pairwise_clearance(axes[:, :, None], radii, everything)[:, :, 0]
        assert nearest.distance == pytest.approx(gaps.min(), abs=1e-6)
        assert gaps[nearest.capsule, nearest.obstacle] == pytest.approx(gaps.min(), abs=1e-6)
        away = float(np.linalg.norm(nearest.on_axis - nearest.on_obstacle)) - radii[nearest.capsule]
        assert away == pytest.approx(nearest.distance, abs=1e-4)


def test_each_capsule_of_a_body_is_as_far_as_is_said_or_farther() -> None:
    rng, exact, left_out = np.random.default_rng(4), 0, 0
    obstacles = many(rng)
    for _ in range(200):
        x, z = np.array([300.0, -200.0]) + rng.uniform(-12.0, 12.0, 2)
        starts = rng.uniform([-0.5, 0.0, -0.5], [0.5, 1.8, 0.5], (4, 3))
        axes = np.concatenate([starts, starts + rng.uniform(-0.4, 0.4, (4, 3))], axis=1).astype(np.float32)[:, :, None]
        radii = rng.uniform(0.03, 0.1, 4).astype(np.float32)
        floors = rng.choice([-np.inf, *rng.uniform(0.0, 1.5, 2)], 4)
        found = clearances_around(obstacles.about_bodies, axes, radii, x, z, floors, np.inf)
        gaps = pairwise_clearance(axes, radii, about(obstacles.standing, x, z))[:, :, 0]
        tops = bounds_of(obstacles.standing)[1][:, 1]
        expected = np.where(tops > floors[:, None], gaps, np.inf).min(axis=1)
        assert np.all(found <= expected + 1e-6)
        assert found.min() == pytest.approx(expected.min(), abs=1e-6)
        near = expected < 0.4
        np.testing.assert_allclose(found[near], expected[near], atol=1e-6)
        capped = clearances_around(obstacles.about_bodies, axes, radii, x, z, floors, 0.1)
        np.testing.assert_allclose(np.minimum(capped, 0.1), np.minimum(expected, 0.1), atol=1e-6)
        exact, left_out = exact + int(near.sum()), left_out + int((gaps.min(axis=1) < expected).sum())
    assert exact > 10
    assert left_out > 10
    nothing = Obstacles().about_bodies
    assert np.isposinf(clearances_around(nothing, axes, radii, 0.0, 0.0, np.zeros(4), np.inf)).all()


def test_nothing_is_infinitely_far() -> None:
    axes = np.zeros((1, 6, 1), np.float32)
    assert np.isposinf(Obstacles().clearance(axes, [0.1], (0.0, 0.0), 0.0))
    assert Obstacles().nearest(axes[:, :, 0], [0.1], (0.0, 0.0), 0.0) is None
    assert is_empty(Obstacles().near((-9.0, -9.0), (9.0, 9.0)))


def test_what_is_along_a_way_stands_there_or_sweeps_it() -> None:
    rng = np.random.default_rng(3)
    obstacles, times = many(rng), np.linspace(1.0, 4.0, 7)
    ground = (295.0, -205.0), (306.0, -195.0)
    found = obstacles.along(times, ground)
    least, most = bounds_of(obstacles.standing)
    over = (least[:, 0] <= 306.0) & (most[:, 0] >= 295.0) & (least[:, 2] <= -195.0) & (most[:, 2] >= -205.0)
    assert found.numbers.tolist() == [*np.flatnonzero(over).tolist(), len(least)]
    assert found.spans.rows.shape[:2] == (6, len(found.numbers))
    assert found.moments.rows.shape[:2] == (7, len(found.numbers))
    assert len(set(found.stamps.tolist())) == 6
    for k in range(6):  # what moves is within what it sweeps
        for time in np.linspace(times[k], times[k + 1], 5):
            swept = bounds_of(type(obstacles.standing)(found.spans.rows[k, -1:], obstacles.standing.packed))
            there = bounds_of(obstacles.moving.at(float(time)))
            assert np.all(swept[0] <= there[0] + 1e-9)
            assert np.all(swept[1] >= there[1] - 1e-9)
    elsewhere = obstacles.along(times, ((0.0, 0.0), (1.0, 1.0)))
    assert not len(elsewhere.numbers)
    assert not elsewhere.stamps.any()


def test_kernels_are_handed_what_is_along_a_way_in_order() -> None:
    """In order in memory, where only some of all that moves comes by: else they would be compiled again in a walk."""
    obstacles, rng = Scene.load("traffic").obstacles, np.random.default_rng(1)
    for _ in range(60):
        (x, z), half = rng.uniform(-5.0, 8.0, 2), float(rng.choice([1.0, 4.0, 20.0]))
        found = obstacles.along(np.linspace(0.0, 2.4, 17), ((x - half, z - half), (x + half, z + half)))
        assert all(each.rows.flags.c_contiguous for each in (found.spans, found.moments))


def test_a_moving_hull_is_where_its_points_are() -> None:
    hull = box_hull((0.2, 0.3, 0.1))
    shifted = type(hull)(tuple((x + 1.0, y + 0.5, z) for x, y, z in hull.points))
    track = Track(
        "cart", shifted, np.array([0.0, 2.0]), np.array([[5.0, 0.0, 5.0], [7.0, 0.0, 5.0]]), np.array([0.0, 1.0])
    )
    obstacles = Obstacles(moving=Moving((track,)))
    for time in (0.0, 0.7, 2.0):
        (center,), (yaw,) = track.poses([time])
        corners = center + quaternion.rotate(quaternion.about_axis(1, float(yaw)), shifted.array)
        away = np.tile(2.0 * corners - corners.mean(axis=0), 2)  # as far beyond each corner as the middle is inside
        for corner, segment in zip(corners, away, strict=True):
            found = obstacles.nearest(segment[None], [0.0], (0.0, 0.0), time)
            assert found is not None
            np.testing.assert_allclose(found.on_obstacle, corner, atol=1e-5)
