"""The clearance kernels against a naive twin, and against coal."""

import coal
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.clearance import clearance, clearance_of, pairwise_clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from sampled import sampled

Floats = NDArray[np.float64]


def naive_distance(a: Floats, b: Floats, row: Floats) -> float:
    """Distance of segment a-b from the box by ternary search on the convex distance along it, float64."""
    start, step = row[3:12].reshape(3, 3) @ (a - row[:3]), row[3:12].reshape(3, 3) @ (b - a)

    def distance(t: float) -> float:
        point = start + t * step
        return float(np.linalg.norm(point - np.clip(point, -row[12:15], row[12:15])))

    low, high = 0.0, 1.0
    for _ in range(120):
        left, right = low + (high - low) / 3.0, high - (high - low) / 3.0
        low, high = (low, right) if distance(left) < distance(right) else (left, high)
    return min(distance(0.0), distance(0.5 * (low + high)), distance(1.0))


def naive_pairwise(segments: Floats, radii: Floats, boxes: Obstacles) -> Floats:
    capsules, _, count = segments.shape
    out = np.empty((capsules, len(boxes), count))
    for c in range(capsules):
        for b, row in enumerate(boxes.standing.rows):
            for i in range(count):
                out[c, b, i] = naive_distance(segments[c, :3, i], segments[c, 3:, i], row) - radii[c]
    return out


def coal_distance(a: Floats, b: Floats, radius: float, boxes: Obstacles, index: int) -> float:
    """Distance of a capsule from a box, by coal; negative where they overlap."""
    capsule = coal.Capsule(radius, float(np.linalg.norm(b - a)))
    turn = quaternion.to_matrix(quaternion.between([0.0, 0.0, 1.0], b - a))
    box = coal.Box(*(2.0 * boxes.half_sizes[index]))
    place = coal.Transform3s(quaternion.to_matrix(boxes.rotations[index]), boxes.centers[index])
    result = coal.DistanceResult()
    return float(
        coal.distance(capsule, coal.Transform3s(turn, 0.5 * (a + b)), box, place, coal.DistanceRequest(), result)
    )


def random_boxes(rng: np.random.Generator, count: int) -> Obstacles:
    turns = quaternion.normalize(rng.normal(size=(count, 4)))
    turns[: count // 3] = quaternion.IDENTITY
    return Obstacles.boxes(rng.uniform(-1.0, 1.0, (count, 3)), turns, rng.uniform(0.02, 0.6, (count, 3)))


def random_segments(rng: np.random.Generator, capsules: int, count: int) -> Floats:
    """Capsule axes of human size; some parallel to an axis, some without length."""
    starts = rng.uniform(-1.5, 1.5, (capsules, 3, count))
    steps = rng.uniform(-0.4, 0.4, (capsules, 3, count))
    kind = rng.integers(0, 6, (capsules, count))
    for axis in range(3):
        steps[:, axis] = np.where((kind == axis) | (kind == 3), 0.0, steps[:, axis])
        steps[:, axis] = np.where((kind == 4) & (axis > 0), 0.0, steps[:, axis])
    # What the kernel sees, so that the judges are asked about the same axes.
    return np.concatenate([starts, starts + steps], axis=1).astype(np.float32).astype(np.float64)


@pytest.mark.parametrize("count", sampled([1, 16, 17, 15, 40], 3))
def test_pairs_equal_the_naive_twin(count: int) -> None:
    rng = np.random.default_rng(count)
    boxes, segments, radii = random_boxes(rng, 4), random_segments(rng, 3, count), rng.uniform(0.03, 0.2, 3)
    np.testing.assert_allclose(
        pairwise_clearance(segments, radii, boxes.standing), naive_pairwise(segments, radii, boxes), atol=2e-6
    )


@pytest.mark.parametrize("count", [1, 16, 511, 512, 513, 1100])
def test_the_least_is_the_least_of_the_pairs_and_one_posture_is_the_same_check(count: int) -> None:
    rng = np.random.default_rng(count)
    boxes, segments, radii = random_boxes(rng, 5), random_segments(rng, 4, count), rng.uniform(0.03, 0.2, 4)
    least = clearance(segments, radii, boxes.standing)
    np.testing.assert_array_equal(least, pairwise_clearance(segments, radii, boxes.standing).min(axis=(0, 1)))
    for i in range(0, count, 37):
        assert clearance_of(segments[:, :, i], radii, boxes.standing) == least[i]


def test_agrees_with_coal_on_random_capsules() -> None:
    rng = np.random.default_rng(7)
    boxes, segments, radii = random_boxes(rng, 12), random_segments(rng, 4, 25), rng.uniform(0.03, 0.2, 4)
    ours = pairwise_clearance(segments, radii, boxes.standing)
    checked = 0
    for c, b, i in np.ndindex(ours.shape):
        a, e = segments[c, :3, i], segments[c, 3:, i]
        if np.linalg.norm(e - a) < 1e-3:
            continue  # coal wants a capsule with a length; the naive twin judges these
        theirs = coal_distance(a, e, float(radii[c]), boxes, b)
        checked += 1
        if abs(theirs) > 1e-5:
            assert (ours[c, b, i] < 0.0) == (theirs < 0.0)
        if theirs > 0.0:
            assert ours[c, b, i] == pytest.approx(theirs, abs=1e-5)
    assert checked > 600


@pytest.mark.parametrize("gap", [1e-3, 1e-4, 2e-5, 1.1e-5])
def test_agrees_with_coal_next_to_touching(gap: float) -> None:
    """Boxes moved along the witness normal until a wanted gap, or overlap, is left."""
    rng = np.random.default_rng(11)
    boxes, segments, radius = random_boxes(rng, 60), random_segments(rng, 1, 60)[0], 0.07
    for i in range(60):
        a, b = segments[:3, i], segments[3:, i]
        row = boxes.standing.rows[i]
        distance = naive_distance(a, b, row)
        if distance < 0.01 or np.linalg.norm(b - a) < 1e-3:
            continue
        points = a + np.linspace(0.0, 1.0, 20001)[:, None] * (b - a)
        local = (points - row[:3]) @ row[3:12].reshape(3, 3).T
        offsets = local - np.clip(local, -row[12:15], row[12:15])
        best = np.argmin(np.linalg.norm(offsets, axis=1))
        normal = offsets[best] @ row[3:12].reshape(3, 3)
        normal /= np.linalg.norm(normal)
        for sign in (1.0, -1.0):
            shifted = boxes.centers[i] + normal * (distance - radius - sign * gap)
            near = Obstacles.boxes(shifted[None], boxes.rotations[i : i + 1], boxes.half_sizes[i : i + 1])
            ours = clearance_of(segments[None, :, i], np.array([radius]), near.standing)
            theirs = coal_distance(a, b, radius, near, 0)
            if abs(theirs) > 1e-5:
                assert (ours < 0.0) == (theirs < 0.0)
            assert abs(ours - theirs) < 1e-5


finite = st.floats(-3.0, 3.0, width=32)


@settings(max_examples=200, deadline=None)
@given(
    st.tuples(finite, finite, finite),
    st.tuples(finite, finite, finite),
    st.tuples(*[st.floats(0.0625, 2.0, width=32)] * 3),
)
def test_any_axis_against_an_upright_box(
    start: tuple[float, ...], end: tuple[float, ...], half: tuple[float, ...]
) -> None:
    box = Obstacles.boxes(np.zeros((1, 3)), quaternion.IDENTITY[None], np.array([half]))
    ours = clearance_of(np.array([[*start, *end]]), np.array([0.25]), box.standing)
    assert ours == pytest.approx(naive_distance(np.array(start), np.array(end), box.standing.rows[0]) - 0.25, abs=4e-6)


def test_an_axis_inside_a_box_has_minus_its_radius() -> None:
    box = Obstacles.boxes(np.zeros((1, 3)), quaternion.IDENTITY[None], np.ones((1, 3)))
    inside = np.array([[-0.5, 0.0, 0.0, 0.5, 0.2, 0.0]])
    through = np.array([[-5.0, 0.1, 0.2, 5.0, 0.1, 0.2]])
    for segment in (inside, through):
        assert clearance_of(segment, np.array([0.3]), box.standing) == pytest.approx(-0.3, abs=1e-6)


def test_nothing_in_the_way_is_infinitely_far() -> None:
    segments, radii, empty = np.zeros((2, 6, 5)), np.ones(2), Obstacles().standing
    assert np.all(np.isposinf(clearance(segments, radii, empty)))
    assert np.isposinf(clearance_of(segments[:, :, 0], radii, empty))
    assert pairwise_clearance(segments, radii, empty).shape == (2, 0, 5)
    box = random_boxes(np.random.default_rng(0), 1).standing
    assert np.all(np.isposinf(clearance(np.empty((0, 6, 4)), np.empty(0), box)))
    assert clearance(np.empty((2, 6, 0)), radii, box).shape == (0,)


def test_any_layout_of_the_arrays_gives_the_same() -> None:
    rng = np.random.default_rng(5)
    boxes, segments, radii = random_boxes(rng, 3), random_segments(rng, 2, 33), rng.uniform(0.03, 0.2, 2)
    expected = clearance(segments, radii, boxes.standing)
    strided = np.moveaxis(np.ascontiguousarray(np.moveaxis(segments, -1, 0)), 0, -1)
    np.testing.assert_array_equal(clearance(strided, radii, boxes.standing), expected)
