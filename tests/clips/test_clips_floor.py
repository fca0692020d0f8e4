"""The floor under a captured motion."""

import numpy as np
import pytest

from elbowroom.clips.floor import plane_below


@pytest.mark.parametrize("slope", [(0.0, 0.0), (0.012, -0.008), (0.02, 0.01)])
def test_a_sloping_floor_is_found_under_steps(slope: tuple[float, float]) -> None:
    rng = np.random.default_rng(0)
    places = np.column_stack([np.linspace(-3, 3, 400), np.zeros(400), 2.0 * np.sin(np.linspace(0, 3, 400))])
    ground = 0.3 + places[:, [0, 2]] @ slope
    points = places + np.outer(ground + 0.05 * np.maximum(rng.uniform(-1, 1, 400), 0.0), [0, 1, 0])
    assert np.abs(plane_below(points, places) - ground).max() < 0.01


def test_who_stays_in_place_stands_level() -> None:
    rng = np.random.default_rng(1)
    points = np.column_stack(
        [0.02 * rng.standard_normal(200), rng.uniform(0, 0.1, 200), 0.02 * rng.standard_normal(200)]
    )
    assert np.ptp(plane_below(points, points)) < 1e-3


def test_a_stair_is_no_floor() -> None:
    places = np.column_stack([np.linspace(0, 4, 200), np.zeros(200), np.zeros(200)])
    points = places + np.outer(np.linspace(0, 2, 200), [0, 1, 0])
    assert np.ptp(plane_below(points, places)) == 0.0
