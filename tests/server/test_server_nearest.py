"""The nearest obstacle, against brute force."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from elbowroom.geometry import quaternion
from elbowroom.server.sessions.nearest import nearest
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene


def scene_of(boxes: Obstacles) -> Scene:
    names = tuple(f"box {i}" for i in range(len(boxes)))
    return replace(Scene.load("empty"), obstacles=replace(boxes, standing_names=names))


def random_boxes(rng: np.random.Generator, count: int) -> Obstacles:
    turns = quaternion.normalize(rng.normal(size=(count, 4)))
    return Obstacles.boxes(rng.uniform(-1, 1, (count, 3)), turns, rng.uniform(0.05, 0.6, (count, 3)))


@given(seed=st.integers(0, 2**32 - 1))
def test_points_and_distance_agree_with_many_samples(seed: int) -> None:
    rng = np.random.default_rng(seed)
    boxes, radii = random_boxes(rng, 3), rng.uniform(0.02, 0.2, 4)
    segments = rng.uniform(-2, 2, (4, 6)).astype(np.float32)
    found = nearest(segments, radii, tuple("abcd"), scene_of(boxes), 0.0)
    assert found is not None
    share = np.linspace(0, 1, 501)[:, None]
    gaps = np.empty((4, 3))
    for c, segment in enumerate(segments.astype(float)):
        points = segment[:3] + share * (segment[3:] - segment[:3])
        for b in range(3):
            inside = quaternion.rotate(quaternion.conjugate(boxes.rotations[b]), points - boxes.centers[b])
            beyond = inside - np.clip(inside, -boxes.half_sizes[b], boxes.half_sizes[b])
            gaps[c, b] = np.linalg.norm(beyond, axis=1).min() - radii[c]
    assert found.distance == pytest.approx(gaps.min(), abs=0.01)
    c, b = "abcd".index(found.capsule), int(found.obstacle[-1])
    assert gaps[c, b] == pytest.approx(gaps.min(), abs=0.01)
    between = float(np.linalg.norm(np.subtract(found.on_body, found.on_obstacle)))
    assert between == pytest.approx(max(found.distance, 0.0), abs=1e-3)


def test_without_obstacles_nothing_is_near() -> None:
    none = Obstacles()
    assert nearest(np.zeros((1, 6), np.float32), np.ones(1), ("head",), scene_of(none), 0.0) is None
