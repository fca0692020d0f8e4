"""What can be said about a rate or a mean from a finite number of trials."""

import math
from collections.abc import Sequence
from statistics import NormalDist
from typing import NamedTuple

import numpy as np


class Interval(NamedTuple):
    """A confidence interval."""

    low: float
    high: float


def wilson(successes: int, trials: int, confidence: float = 0.95) -> Interval:
    """The interval of a success rate; (0, 1) without any trial.

    E. B. Wilson, "Probable inference, the law of succession, and statistical inference", J. Am. Stat. Assoc. 22 (1927).
    Raises ValueError unless 0 <= successes <= trials and 0 < confidence < 1.
    """
    if not (0 <= successes <= trials and 0.0 < confidence < 1.0):
        raise ValueError(f"{successes} of {trials} successes, confidence {confidence}")
    if trials == 0:
        return Interval(0.0, 1.0)
    z = NormalDist().inv_cdf(0.5 + 0.5 * confidence)
    rate, weight = successes / trials, z * z / trials
    centre = (rate + 0.5 * weight) / (1.0 + weight)
    half = z * math.sqrt(rate * (1.0 - rate) / trials + 0.25 * weight / trials) / (1.0 + weight)
    low = 0.0 if successes == 0 else max(0.0, centre - half)
    high = 1.0 if successes == trials else min(1.0, centre + half)
    return Interval(low, high)


def mean_interval(values: Sequence[float], confidence: float = 0.95) -> Interval:
    """The interval of a mean by Student's t; infinite with fewer than two values."""
    if len(values) < 2:
        return Interval(-math.inf, math.inf)
    from scipy.special import stdtrit  # slow to import, and `scipy.stats` seconds slower

    t = float(stdtrit(len(values) - 1, 0.5 + 0.5 * confidence))
    half = t * float(np.std(values, ddof=1)) / math.sqrt(len(values))
    mean = float(np.mean(values))
    return Interval(mean - half, mean + half)


def percentile(values: Sequence[float], percent: float) -> float:
    """The percentile of some values, between neighbours linear; not a number without any."""
    return float(np.percentile(np.asarray(values, np.float64), percent)) if len(values) else math.nan


def ratio_interval(
    numerators: Sequence[float],
    denominators: Sequence[float],
    rng: np.random.Generator,
    confidence: float = 0.95,
    resamples: int = 2000,
) -> Interval:
    """The interval of sum / sum over trials, by the percentile bootstrap (Efron 1979), which draws pairs.

    Infinite with fewer than two trials, or where the denominators may add up to nothing.
    """
    if len(numerators) < 2:
        return Interval(-math.inf, math.inf)
    drawn = rng.integers(len(numerators), size=(resamples, len(numerators)))
    over = np.asarray(numerators, np.float64)[drawn].sum(axis=1)
    under = np.asarray(denominators, np.float64)[drawn].sum(axis=1)
    if not under.all():
        return Interval(-math.inf, math.inf)
    outside = 50.0 * (1.0 - confidence)
    low, high = np.percentile(over / under, [outside, 100.0 - outside])
    return Interval(float(low), float(high))
