"""The monotone cubic against SciPy's, and the laws for which it is there."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from elbowroom.body.clips.monotone_cubic import MonotoneCubic


def keys(seed: int, count: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    values = rng.normal(size=(count, 3))
    values[rng.random((count, 3)) < 0.2] = 0.5  # some neighbours are equal
    return np.cumsum(rng.uniform(0.01, 1.0, count)), values


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 10_000), st.integers(2, 9))
def test_it_is_the_curve_of_scipy(seed: int, count: int) -> None:
    times, values = keys(seed, count)
    at = np.linspace(times[0], times[-1], 57)
    np.testing.assert_allclose(MonotoneCubic(times, values)(at), PchipInterpolator(times, values)(at), atol=1e-12)


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 10_000), st.integers(2, 9))
def test_it_meets_its_keys_and_never_leaves_their_range(seed: int, count: int) -> None:
    times, values = keys(seed, count)
    curve = MonotoneCubic(times, values)
    np.testing.assert_allclose(curve(times), values, atol=1e-12)
    for k in range(count - 1):
        between = curve(np.linspace(times[k], times[k + 1], 20))
        assert (between >= np.minimum(values[k], values[k + 1]) - 1e-12).all()
        assert (between <= np.maximum(values[k], values[k + 1]) + 1e-12).all()


def test_any_shape_of_times_will_do() -> None:
    times, values = keys(0, 5)
    curve = MonotoneCubic(times, values)
    assert curve(np.array(times[1])).shape == (3,)
    assert curve(np.full((2, 4), times[1])).shape == (2, 4, 3)
