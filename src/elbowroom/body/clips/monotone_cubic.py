"""Curves through key values that do not overshoot: monotone piecewise cubics.

Tangents after F. N. Fritsch & J. Butland, "A method for constructing local monotone piecewise cubic interpolants",
SIAM J. Sci. Stat. Comput. 5 (1984): zero at a local extremum, else a weighted harmonic mean of the neighbouring slopes;
at the ends the three-point formula, held back where it would overshoot (C. Moler, "Numerical Computing with MATLAB",
section 3.4). Written out here because importing SciPy's takes longer than all the rest of a start.
"""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


class MonotoneCubic:
    """The curve through values (K, d), K >= 2, at increasing times (K,)."""

    def __init__(self, times: Floats, values: Floats) -> None:
        self._times, self._values = np.asarray(times, np.float64), np.asarray(values, np.float64)
        self._tangents = _tangents(np.diff(self._times)[:, None], np.diff(self._values, axis=0))

    @property
    def cubics(self) -> tuple[Floats, Floats]:
        """The times (K,), and the segments' coefficients (4, K-1, d): of the time since each began, cubed first."""
        width, tangents = np.diff(self._times)[:, None], self._tangents
        rise, m, n = np.diff(self._values, axis=0), width * tangents[:-1], width * tangents[1:]
        rows = (m + n - 2.0 * rise) / width**3, (3.0 * rise - 2.0 * m - n) / width**2, tangents[:-1], self._values[:-1]
        return self._times, np.ascontiguousarray(np.stack(rows))

    def __call__(self, at: Floats) -> Floats:
        """Values (..., d) at times `at` (...); beyond the ends the last cubics go on."""
        k = np.clip(np.searchsorted(self._times, at, side="right") - 1, 0, len(self._times) - 2)
        width = (self._times[k + 1] - self._times[k])[..., None]
        u = (at - self._times[k])[..., None] / width
        a, b, m, n = self._values[k], self._values[k + 1], width * self._tangents[k], width * self._tangents[k + 1]
        curve: Floats = a + u * (m + u * (3.0 * (b - a) - 2.0 * m - n + u * (2.0 * (a - b) + m + n)))
        return curve


def _tangents(steps: Floats, rises: Floats) -> Floats:
    """Tangents (K, d) for steps (K-1, 1) between the times and rises (K-1, d) of the values."""
    slopes = rises / steps
    if len(slopes) == 1:
        return np.repeat(slopes, 2, axis=0)
    before, after = steps[:-1], steps[1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = 3.0 * (before + after) / ((2.0 * after + before) / slopes[:-1] + (after + 2.0 * before) / slopes[1:])
    inner = np.where(slopes[:-1] * slopes[1:] > 0.0, mean, 0.0)
    first = _end_tangent(steps[0], steps[1], slopes[0], slopes[1])
    last = _end_tangent(steps[-1], steps[-2], slopes[-1], slopes[-2])
    return np.concatenate([first[None], inner, last[None]])


def _end_tangent(step: Floats, next_step: Floats, slope: Floats, next_slope: Floats) -> Floats:
    tangent = ((2.0 * step + next_step) * slope - step * next_slope) / (step + next_step)
    steep = (np.sign(slope) != np.sign(next_slope)) & (np.abs(tangent) > 3.0 * np.abs(slope))
    end: Floats = np.where(np.sign(tangent) != np.sign(slope), 0.0, np.where(steep, 3.0 * slope, tangent))
    return end
