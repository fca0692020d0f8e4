"""The downhill simplex method against SciPy's, step by step the same."""

import numpy as np
import pytest
from scipy.optimize import minimize

from elbowroom.body.nelder_mead import least_point

SIZE, SPREAD = 1e-4, 1e-8


def valley(x: np.ndarray) -> float:
    """Rosenbrock's, with a kink."""
    return float(np.sum(100.0 * (x[1:] - x[:-1] ** 2) ** 2 + np.abs(1.0 - x[:-1])))


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("evaluations", [9, 60, 5000])
def test_it_finds_what_scipy_finds_to_the_last_bit(seed: int, evaluations: int) -> None:
    rng = np.random.default_rng(seed)
    size = int(rng.integers(2, 7))
    first = rng.normal(size=size)
    simplex = first + np.vstack([np.zeros(size), np.eye(size)])
    options = {"maxfev": evaluations, "initial_simplex": simplex, "xatol": SIZE, "fatol": SPREAD}
    judged = minimize(valley, first, method="Nelder-Mead", options=options).x
    assert least_point(valley, simplex, evaluations, SIZE, SPREAD).tobytes() == judged.tobytes()


def test_it_finds_the_bottom_of_a_bowl() -> None:
    middle = np.array([0.3, -0.2, 0.7])
    found = least_point(
        lambda x: float(np.sum((x - middle) ** 2)), np.vstack([np.zeros(3), np.eye(3)]), 1000, 1e-6, 1e-12
    )
    np.testing.assert_allclose(found, middle, atol=1e-5)
