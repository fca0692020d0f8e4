"""Every shape's kernel against a float64 twin and against coal: at random, next to touching, and where it is hard."""

from collections.abc import Iterable
from itertools import groupby
from operator import attrgetter

import coal
import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.experiment.judge.obstacles import Obstacle
from elbowroom.experiment.judge.obstacles import obstacles_of as judged_obstacles
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.clearance import clearance, clearance_of, pairwise_clearance
from elbowroom.world.obstacles.closest_points import closest_points
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import joined, number_of, one_of
from elbowroom.world.obstacles.shapes import Box, Capsule, Cylinder, Shape, Sphere
from judged_bodies import scene_with
from sampled import sampled
from shapes import RANDOM, box_hull, obstacles_of, random_hull, some_obstacles

Floats = NDArray[np.float64]

KINDS = tuple(RANDOM)
HARD: dict[str, Shape] = {
    "1 cm sphere": Sphere(0.005),
    "20 m sphere": Sphere(10.0),
    "1 cm cylinder": Cylinder(0.005, 0.01),
    "disc": Cylinder(0.5, 0.002),
    "20 m pole": Cylinder(0.05, 20.0),
    "20 m rail": Capsule(0.03, 20.0),
    "flat hull": box_hull((0.4, 0.0006, 0.3)),
    "1 cm hull": box_hull((0.005, 0.005, 0.005)),
    "20 m hull": box_hull((10.0, 0.2, 8.0)),
    "needle hull": box_hull((0.001, 0.6, 0.001)),
    "tetrahedron": random_hull(np.random.default_rng(5), 4),
    "128 points": random_hull(np.random.default_rng(6), 128),
}


def axes(rng: np.random.Generator, count: int, around: Floats | None = None) -> Floats:
    """Axes (6, N) of human size as the kernels see them; some parallel to an axis, some without length."""
    starts, steps = rng.uniform(-1.2, 1.2, (3, count)), rng.uniform(-0.4, 0.4, (3, count))
    kind = rng.integers(0, 6, count)
    for axis in range(3):
        steps[axis] = np.where((kind == axis) | (kind == 3) | ((kind == 4) & (axis > 0)), 0.0, steps[axis])
    if around is not None:
        starts += around[:, None]
    return np.concatenate([starts, starts + steps]).astype(np.float32).astype(np.float64)


def twin(segment: Floats, obstacles: Obstacles) -> Floats:
    """Distances (B,) of an axis, float64."""
    on_axis, on_obstacle = closest_points(segment, obstacles.standing)
    gaps: Floats = np.linalg.norm(on_axis - on_obstacle, axis=1)
    return gaps


def coal_distance(segment: Floats, radius: float, pieces: Iterable[Obstacle]) -> float:
    """Distance of a capsule from an obstacle, which a mesh is in pieces, negative where they overlap, by coal."""
    length = float(np.linalg.norm(segment[3:] - segment[:3]))
    turn = quaternion.to_matrix(quaternion.between([0.0, 0.0, 1.0], segment[3:] - segment[:3]))
    place = coal.Transform3s(turn, 0.5 * (segment[:3] + segment[3:]))
    request, capsule = coal.DistanceRequest(), coal.Capsule(radius, length)
    distances = [
        coal.distance(capsule, place, piece.shape, piece.place, request, coal.DistanceResult()) for piece in pieces
    ]
    return float(min(distances))


@pytest.mark.parametrize("kind", KINDS)
def test_distances_are_the_twins_and_coals(kind: str) -> None:
    rng = np.random.default_rng(KINDS.index(kind))
    obstacles = obstacles_of([RANDOM[kind](rng) for _ in range(12)], rng)
    judges = [list(pieces) for _, pieces in groupby(judged_obstacles(scene_with(obstacles)), attrgetter("name"))]
    assert len(judges) == len(obstacles)
    segments, radius, checked = axes(rng, 80), 0.12, 0
    ours = pairwise_clearance(segments[None], [radius], obstacles.standing)[0]
    for i, segment in enumerate(segments.T):
        # The twin ends some 1e-6 of the axis away from the nearest point, which counts only where the two touch.
        np.testing.assert_allclose(ours[:, i], twin(segment, obstacles) - radius, atol=3e-6)
        if np.linalg.norm(segment[3:] - segment[:3]) < 1e-3:
            continue  # coal wants a capsule with a length
        for b, judge in enumerate(judges):
            theirs = coal_distance(segment, radius, judge)
            checked += 1
            if abs(theirs) > 1e-5:
                assert (ours[b, i] < 0.0) == (theirs < 0.0)
            if theirs > 0.0:
                assert ours[b, i] == pytest.approx(theirs, abs=1e-5)
    assert checked > 250
    assert np.any(ours < 0.0)


@pytest.mark.parametrize("name", sampled(HARD, 8))
def test_hard_shapes(name: str) -> None:
    """From a place on their surface: half of the axes touch or nearly; large ones have large coordinates."""
    rng = np.random.default_rng(len(name))
    shape = HARD[name]
    obstacles = Obstacles((shape,) * 4, np.zeros((4, 3)), quaternion.normalize(rng.normal(size=(4, 4))), ("thing",) * 4)
    _, surface = closest_points(np.tile(rng.normal(size=3) * 30.0, 2), obstacles.standing)
    segments = axes(rng, 100, surface[0])
    segments[3:, ::2] = segments[:3, ::2] + 0.1 * (segments[3:, ::2] - segments[:3, ::2])
    segments = segments.astype(np.float32).astype(np.float64)
    ours = pairwise_clearance(segments[None], [0.0], obstacles.standing)[0]
    rounding = 3e-6 if max(shape.half) < 2.0 and shape.rounding < 2.0 else 2e-5
    for i, segment in enumerate(segments.T):
        np.testing.assert_allclose(ours[:, i], twin(segment, obstacles), atol=rounding)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("gap", [pytest.param(1e-3, marks=pytest.mark.long), 1.1e-5])
def test_touching_or_not_is_told_next_to_touching(kind: str, gap: float) -> None:
    """Obstacles moved along the line between the nearest points, until a wanted gap, or overlap, is left."""
    rng = np.random.default_rng(11)
    obstacles, radius, checked = obstacles_of([RANDOM[kind](rng) for _ in range(16)], rng), 0.07, 0
    for i, segment in enumerate(axes(rng, 16).T):
        on_axis, on_obstacle = closest_points(segment, obstacles.standing)
        away = on_obstacle[i] - on_axis[i]
        distance = float(np.linalg.norm(away))
        if distance < 0.01 or np.linalg.norm(segment[3:] - segment[:3]) < 1e-3:
            continue
        for sign in (1.0, -1.0):
            center = obstacles.centers[i] - away / distance * (distance - radius - sign * gap)
            one = Obstacles(
                (obstacles.shapes[i],), center[None], obstacles.rotations[i : i + 1], ("thing",), ground=-9.0
            )
            ours = clearance_of(segment[None], [radius], one.standing)
            theirs = coal_distance(segment, radius, judged_obstacles(scene_with(one)))
            assert abs(theirs - sign * gap) < 1e-5
            assert (ours < 0.0) == (sign < 0.0)
            assert abs(ours - theirs) < 1e-5
            checked += 1
    assert checked > 8


@pytest.mark.parametrize("kind", KINDS)
def test_an_axis_inside_or_through_has_minus_its_radius(kind: str) -> None:
    rng = np.random.default_rng(3)
    for _ in range(20):
        obstacles = obstacles_of([RANDOM[kind](rng)], rng)
        row = obstacles.standing.rows[0]
        middle = row[:3]
        step = rng.normal(size=3)
        inside = np.concatenate([middle, middle + 1e-3 * step])
        through = np.concatenate([middle - 2.0 * step, middle + 2.0 * step])
        lengthless = np.tile(middle, 2)
        for segment in (inside, through, lengthless):
            expected = twin(segment, obstacles)[0] - 0.3
            assert clearance_of(segment[None], [0.3], obstacles.standing) == pytest.approx(expected, abs=3e-6)


def test_all_shapes_together_are_the_least_of_each() -> None:
    rng = np.random.default_rng(8)
    obstacles = some_obstacles(rng, 3)
    others = some_obstacles(rng, 2)
    segments, radii = np.stack([axes(rng, 530), axes(rng, 530)]), np.array([0.04, 0.1])
    pairs = pairwise_clearance(segments, radii, obstacles.standing)
    np.testing.assert_array_equal(clearance(segments, radii, obstacles.standing), pairs.min(axis=(0, 1)))
    standing = obstacles.standing
    singles = np.array([clearance(segments, radii, one_of(standing, b)) for b in range(number_of(standing))])
    np.testing.assert_array_equal(clearance(segments, radii, obstacles.standing), singles.min(axis=0))
    for i in range(0, 530, 41):
        assert clearance_of(segments[:, :, i], radii, obstacles.standing) == pairs[:, :, i].min()
    without_hulls = Obstacles(others.shapes[:8], others.centers[:8], others.rotations[:8], others.standing_names[:8])
    both = joined(obstacles.standing, without_hulls.standing)  # kinds in any order
    expected = np.minimum(
        clearance(segments, radii, obstacles.standing), clearance(segments, radii, without_hulls.standing)
    )
    np.testing.assert_array_equal(clearance(segments, radii, both), expected)


def test_a_hull_that_is_a_box_is_as_far_as_the_box() -> None:
    rng = np.random.default_rng(4)
    half = (0.2, 0.5, 0.1)
    nearly = quaternion.about_axis(1, 2e-4)  # axes are parallel to edges, or nearly
    for turn in (quaternion.normalize(rng.normal(size=4)), quaternion.IDENTITY, nearly):
        hull = Obstacles((box_hull(half),), np.zeros((1, 3)), turn[None], ("hull",))
        box = Obstacles((Box((0.4, 1.0, 0.2)),), np.zeros((1, 3)), turn[None], ("box",))
        segments = axes(rng, 2000)[None]
        found, expected = clearance(segments, [0.0], hull.standing), clearance(segments, [0.0], box.standing)
        far = expected > 0.01  # nearer than that, rounding along parallel edges counts more: capsules are thicker
        np.testing.assert_allclose(found[far], expected[far], atol=1e-6)
        np.testing.assert_allclose(found, expected, atol=2e-5)
