"""The walkable map is the clearance of a standing capsule, point by point."""

import numpy as np
import pytest

from elbowroom.world.obstacles.clearance import clearance, clearance_of
from elbowroom.world.scene import Scene
from elbowroom.world.walkable import (
    FARTHEST,
    MAX_CELLS,
    StanceCapsule,
    stance_segments,
    walkable_map,
    walkable_window,
)

LEGS = StanceCapsule(0.18, 0.1, 0.85)


@pytest.mark.parametrize("name", ["empty", "a", "d"])
def test_every_point_is_the_clearance_of_the_capsule_there(name: str) -> None:
    scene = Scene.load(name)
    grid = walkable_map(scene, *LEGS, cell=0.1)
    rng = np.random.default_rng(0)
    x0, z0 = grid.origin
    for i, j in rng.integers(0, grid.clearance.shape, (300, 2)):
        expected = clearance_of(
            stance_segments(LEGS, [x0 + 0.1 * j], [z0 + 0.1 * i])[..., 0], [LEGS.radius], scene.obstacles.standing
        )
        assert grid.clearance[i, j] == pytest.approx(min(expected, FARTHEST), abs=1e-5)


def test_a_turned_window_sees_the_same() -> None:
    scene = Scene.load("d")
    origin, heading, cell = (-0.7, 1.0), 0.6, 0.08
    window = walkable_window(scene.obstacles.standing, LEGS, origin, heading, (50, 40), cell)
    ahead, left = np.meshgrid(np.arange(50) * cell, np.arange(40) * cell, indexing="ij")
    x = origin[0] + ahead * np.sin(heading) + left * np.cos(heading)
    z = origin[1] + ahead * np.cos(heading) - left * np.sin(heading)
    expected = clearance(stance_segments(LEGS, x.ravel(), z.ravel()), [LEGS.radius], scene.obstacles.standing)
    np.testing.assert_allclose(window.clearance.ravel(), np.minimum(expected, FARTHEST), atol=1e-5)
    for i, j in [(3, 7), (30, 20), (48, 38)]:
        assert window.at(x[i, j], z[i, j]) == pytest.approx(window.clearance[i, j], abs=1e-5)


def test_between_points_the_map_is_off_by_less_than_a_cell() -> None:
    scene = Scene.load("a")
    grid = walkable_map(scene, *LEGS, cell=0.1)
    rng = np.random.default_rng(1)
    x, z = rng.uniform(-1.5, 1.5, 200), rng.uniform(0.0, 6.0, 200)
    exact = np.minimum(clearance(stance_segments(LEGS, x, z), [LEGS.radius], scene.obstacles.standing), FARTHEST)
    found = np.array([grid.at(*point) for point in zip(x, z, strict=True)])
    assert np.max(np.abs(found - exact)) < 0.1
    assert grid.at(50.0, 0.0) == -np.inf


def test_a_vast_ground_gets_coarser_cells() -> None:
    document = {**Scene.load("a").to_dict(), "ground": {"size": [1000, 1000]}}
    grid = walkable_map(Scene.from_dict(document), *LEGS, cell=0.1)
    assert grid.clearance.size <= MAX_CELLS
    assert grid.cell > 0.1
