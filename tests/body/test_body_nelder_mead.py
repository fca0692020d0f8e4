"""The downhill simplex method against SciPy's, step by step the same, and the volume that it makes least."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize

from elbowroom.body.fitting.nelder_mead import Ends, PointsToHold, least_volume, volume
from sampled import sampled

SIZE, SPREAD = 1e-4, 1e-8


def some(seed: int) -> tuple[np.ndarray, PointsToHold]:
    """A first simplex, and points to be held."""
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(int(rng.integers(4, 200)), 3)) * rng.uniform(0.02, 0.5, 3)
    first = rng.normal(size=6) * 0.3
    rank = int(rng.integers(0, len(points)))
    return first + np.vstack([np.zeros(6), 0.2 * np.eye(6)]), PointsToHold(points, rank, 0.01)


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("evaluations", [9, 60, 300, 5000])
def test_it_finds_what_scipy_finds_to_the_last_bit(seed: int, evaluations: int) -> None:
    simplex, held = some(seed)
    options = {"maxfev": evaluations, "initial_simplex": simplex, "xatol": SIZE, "fatol": SPREAD}
    judged = minimize(volume, simplex[0], args=(held,), method="Nelder-Mead", options=options).x
    assert least_volume(simplex, held, Ends(evaluations, SIZE, SPREAD)).tobytes() == judged.tobytes()


@pytest.mark.parametrize("seed", sampled(range(12), 4))
def test_the_volume_is_that_of_the_capsule_that_holds_so_many_points(seed: int) -> None:
    simplex, held = some(seed)
    start, end = simplex[1, :3], simplex[1, 3:]
    along = np.linspace(0.0, 1.0, 20_001)[:, None]
    away = sorted(float(np.linalg.norm(start + along * (end - start) - point, axis=1).min()) for point in held.points)
    radius = max(away[held.rank] - held.slack, 0.0)
    expected = math.pi * radius**2 * (float(np.linalg.norm(end - start)) + 4.0 / 3.0 * radius)
    assert math.isclose(volume(simplex[1], held), expected, rel_tol=1e-4, abs_tol=1e-12)
