"""C1 interpolation of upper-body key frames: cubic Hermite with tangents that do not overshoot.

Tangents after Fritsch & Carlson, "Monotone piecewise cubic interpolation", SIAM J. Numer. Anal. 17 (1980), in the form
of Fritsch & Butland (1984) for unequal spacing: zero at a local extremum, else a weighted harmonic mean of the
neighbouring slopes. The first tangent is given, because it is the velocity with which playback arrives: continuity is
worth more than monotony in that one segment.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import brief_exact_kernel, exact_kernel

Floats = NDArray[np.float64]


@brief_exact_kernel
def monotone_tangents(times: Floats, values: Floats, first: Floats) -> Floats:
    """Tangents (m, d) for key values (m, d), m >= 1, at increasing `times` (m,).

    The first is `first` (d,), the last zero: the curve ends at rest, because the last key frame is where motion would
    have to stop if nothing followed.
    """
    count, size = values.shape
    tangents = np.zeros((count, size))
    for i in range(size):
        tangents[0, i] = first[i]
    for k in range(1, count - 1):
        before, after = times[k] - times[k - 1], times[k + 1] - times[k]
        weight_before, weight_after = 2.0 * after + before, after + 2.0 * before
        for i in range(size):
            rise, next_rise = (values[k, i] - values[k - 1, i]) / before, (values[k + 1, i] - values[k, i]) / after
            if rise * next_rise > 0.0:
                tangents[k, i] = (weight_before + weight_after) / (weight_before / rise + weight_after / next_rise)
    return tangents


@exact_kernel
def hermite(times: Floats, values: Floats, tangents: Floats, time: float) -> tuple[Floats, Floats]:
    """Value (d,) and velocity (d,) at `time`; outside the key times the nearest key value, at rest."""
    last = len(times) - 1
    value, velocity = np.empty(values.shape[1]), np.empty(values.shape[1])
    if time >= times[last] or last == 0:
        for i in range(values.shape[1]):
            value[i], velocity[i] = values[last, i], 0.0
        return value, velocity
    k = 0
    while times[k + 1] <= time:
        k += 1
    width = times[k + 1] - times[k]
    u = max((time - times[k]) / width, 0.0)
    for i in range(values.shape[1]):
        a, b, m, n = values[k, i], values[k + 1, i], width * tangents[k, i], width * tangents[k + 1, i]
        value[i] = a + u * (m + u * (3.0 * (b - a) - 2.0 * m - n + u * (2.0 * (a - b) + m + n)))
        velocity[i] = (m + u * (2.0 * (3.0 * (b - a) - 2.0 * m - n) + u * 3.0 * (2.0 * (a - b) + m + n))) / width
    return value, velocity
