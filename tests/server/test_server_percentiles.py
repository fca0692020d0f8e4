"""Percentiles are those of NumPy."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from elbowroom.server.percentiles import percentiles

PERCENTS = (0, 1, 50, 95, 99, 100)


@given(st.lists(st.floats(0.0, 1e3), min_size=1, max_size=300))
def test_they_are_those_of_numpy(values: list[float]) -> None:
    assert percentiles(values, *PERCENTS) == pytest.approx(np.percentile(values, PERCENTS).tolist())


def test_of_nothing_they_are_zero() -> None:
    assert percentiles([], 50, 99) == [0.0, 0.0]
