"""Upper-body interpolation: through every key, C1, no overshoot, judged by SciPy where both mean the same curve."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from elbowroom.planning.interpolation import hermite, monotone_tangents


def random_keys(seed: int, count: int, size: int = 4) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    times = np.cumsum(rng.uniform(0.01, 0.3, count))
    return times, rng.normal(size=(count, size)), rng.normal(size=size)


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 10_000), st.integers(3, 9))
def test_inner_tangents_are_those_of_fritsch_and_butland(seed: int, count: int) -> None:
    times, values, first = random_keys(seed, count)
    judge = PchipInterpolator(times, values).derivative()(times)
    tangents = monotone_tangents(times, values, first)
    np.testing.assert_allclose(tangents[1:-1], judge[1:-1], atol=1e-12)
    np.testing.assert_array_equal(tangents[0], first)
    np.testing.assert_array_equal(tangents[-1], 0.0)


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 10_000), st.integers(2, 9), st.floats(0.0, 1.0))
def test_the_curve_is_the_cubic_hermite_spline(seed: int, count: int, share: float) -> None:
    times, values, first = random_keys(seed, count)
    tangents = monotone_tangents(times, values, first)
    time = times[0] + share * (times[-1] - times[0])
    value, velocity = hermite(times, values, tangents, time)
    judge = CubicHermiteSpline(times, values, tangents)
    np.testing.assert_allclose(value, judge(time), atol=1e-12)
    np.testing.assert_allclose(velocity, judge(time, 1), atol=1e-9)


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 10_000), st.integers(2, 9))
def test_no_overshoot_after_the_first_segment(seed: int, count: int) -> None:
    times, values, first = random_keys(seed, count)
    tangents = monotone_tangents(times, values, first)
    for k in range(1, count - 1):
        low, high = np.minimum(values[k], values[k + 1]), np.maximum(values[k], values[k + 1])
        for time in np.linspace(times[k], times[k + 1], 12):
            value, _ = hermite(times, values, tangents, time)
            assert (value >= low - 1e-9).all()
            assert (value <= high + 1e-9).all()


@pytest.mark.parametrize("count", [1, 2, 5])
def test_past_the_end_the_last_key_stands_still(count: int) -> None:
    times, values, first = random_keys(1, count)
    value, velocity = hermite(times, values, monotone_tangents(times, values, first), times[-1] + 1.0)
    np.testing.assert_array_equal(value, values[-1])
    np.testing.assert_array_equal(velocity, 0.0)
