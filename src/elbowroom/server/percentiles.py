"""Percentiles of some hundred numbers, many times a second: as NumPy's, without arrays."""

from collections.abc import Iterable


def percentiles(values: Iterable[float], *percents: float) -> list[float]:
    """The values below which so many percent of the values are, straight in between; zeros where there are none."""
    ordered = sorted(values) or [0.0]
    return [_between(ordered, 0.01 * percent * (len(ordered) - 1)) for percent in percents]


def _between(ordered: list[float], place: float) -> float:
    below = min(int(place), len(ordered) - 1)
    above = min(below + 1, len(ordered) - 1)
    return ordered[below] + (place - below) * (ordered[above] - ordered[below])
