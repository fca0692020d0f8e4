"""Intervals against SciPy and against what they promise."""

import math

import numpy as np
import pytest
from scipy import stats

from elbowroom.experiment.statistics import mean_interval, ratio_interval, wilson


@pytest.mark.parametrize("confidence", [0.5, 0.95, 0.999])
@pytest.mark.parametrize(("successes", "trials"), [(0, 1), (1, 1), (3, 20), (20, 20), (0, 20), (137, 200)])
def test_rates_are_wilsons(successes: int, trials: int, confidence: float) -> None:
    judge = stats.binomtest(successes, trials).proportion_ci(confidence, method="wilson")
    assert wilson(successes, trials, confidence) == pytest.approx((judge.low, judge.high), abs=1e-9)


@pytest.mark.parametrize("confidence", [0.5, 0.95, 0.999])
@pytest.mark.parametrize("count", [2, 3, 20, 5000])
def test_means_are_students(count: int, confidence: float) -> None:
    values = np.random.default_rng(1).normal(3.0, 2.0, count)
    judge = stats.t.interval(confidence, count - 1, values.mean(), stats.sem(values))
    assert mean_interval(values.tolist(), confidence) == pytest.approx(judge, rel=1e-9)


def test_ratios_are_the_percentile_bootstrap() -> None:
    rng = np.random.default_rng(2)
    plans = rng.integers(10, 60, 20).astype(float)
    checks = plans * rng.lognormal(6.0, 0.7, 20)

    def ratio(over: np.ndarray, under: np.ndarray, axis: int = -1) -> np.ndarray:
        return np.asarray(over.sum(axis=axis) / under.sum(axis=axis))

    judge = stats.bootstrap(
        (checks, plans), ratio, paired=True, method="percentile", n_resamples=20000, rng=np.random.default_rng(3)
    ).confidence_interval
    ours = ratio_interval(checks.tolist(), plans.tolist(), np.random.default_rng(4), resamples=20000)
    assert ours == pytest.approx((judge.low, judge.high), rel=0.03)
    assert ours.low < checks.sum() / plans.sum() < ours.high
    assert ours == ratio_interval(checks.tolist(), plans.tolist(), np.random.default_rng(4), resamples=20000)


def test_a_constant_ratio_is_certain_and_one_trial_says_nothing() -> None:
    assert ratio_interval([2.0, 4.0, 6.0], [1.0, 2.0, 3.0], np.random.default_rng(0)) == pytest.approx((2.0, 2.0))
    assert ratio_interval([2.0], [1.0], np.random.default_rng(0)) == (-math.inf, math.inf)
    assert ratio_interval([2.0, 1.0], [0.0, 1.0], np.random.default_rng(0)) == (-math.inf, math.inf)
