"""The curve through a path's key postures: how fast it passes each of them, and what that asks of the joints.

Cubic Hermite segments, as `interpolation.hermite` plays them. The velocity at a key posture is the mean of the slopes
before and after it. With slopes s and their changes d = s' - s, the acceleration at a segment's ends is then
(2 d - d')/h and (2 d' - d)/h, so it is never more than three times the greatest change of slope over an interval:
half of what tangents cost that are zero at every bend. Such a curve may swing past its key postures, by at most 4/27 of
the interval times the velocities at both ends; that is part of what is proven free. Where it could leave the range of
a joint, or where it has turned out to touch, the tangents are monotone, zero at every bend (F. N. Fritsch & J. Butland,
SIAM J. Sci. Stat. Comput. 5, 1984): they pass nothing.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel, helper

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

_SAMPLES = 16  # parts of an interval at whose ends its speed is sampled
# Of velocity times interval: a segment whose ends are so far inside a joint's range leaves it nowhere.
_PAST = 8.0 / 27.0


@exact_kernel
def smooth_tangents(values: Floats, interval: float, first: Floats, limits: Floats, stiff: Bools) -> Floats:
    """Velocities (m, d) at key values (m, d), `interval` seconds apart, within the joints' `limits` (d, 2).

    The first is `first` (d,), the last zero: the curve ends at rest. Where `stiff` (m,), nothing is swung past.
    """
    count, size = values.shape
    tangents = np.zeros((count, size))
    for i in range(size):
        tangents[0, i] = first[i]
    for k in range(1, count - 1):
        for i in range(size):
            rise = (values[k, i] - values[k - 1, i]) / interval
            next_rise = (values[k + 1, i] - values[k, i]) / interval
            mean = 0.5 * (rise + next_rise)
            past = _PAST * interval * abs(mean)
            if (
                stiff[k]
                or min(values[k - 1, i], values[k, i], values[k + 1, i]) - past < limits[i, 0]
                or (max(values[k - 1, i], values[k, i], values[k + 1, i]) + past > limits[i, 1])
            ):
                mean = 2.0 * rise * next_rise / (rise + next_rise) if rise * next_rise > 0.0 else 0.0
            tangents[k, i] = mean
    return tangents


@exact_kernel
def peak_acceleration(a: Floats, velocity: Floats, b: Floats, next_velocity: Floats, interval: float) -> float:
    """The greatest acceleration of a segment over all components together: at one of its ends, it changes linearly."""
    first, last = 0.0, 0.0
    for i in range(a.shape[0]):
        slope = (b[i] - a[i]) / interval
        first += ((6.0 * slope - 4.0 * velocity[i] - 2.0 * next_velocity[i]) / interval) ** 2
        last += ((2.0 * velocity[i] + 4.0 * next_velocity[i] - 6.0 * slope) / interval) ** 2
    return float(np.sqrt(max(first, last)))


@helper
def _middle(a: Floats, velocity: Floats, b: Floats, next_velocity: Floats, interval: float, i: int) -> float:
    """The second of three Bezier points of a component's velocity."""
    return float(3.0 * (b[i] - a[i]) / interval - velocity[i] - next_velocity[i])


@exact_kernel
def peak_speed(a: Floats, velocity: Floats, b: Floats, next_velocity: Floats, interval: float) -> float:
    """A speed, over all components together, that a segment nowhere exceeds; from rest to rest 0.4 % more than it has.

    Its velocity is a parabola: between two samples it leaves the chord by at most |second derivative| h^2/8.
    """
    most, bend = 0.0, 0.0
    for i in range(a.shape[0]):
        bend += (velocity[i] - 2.0 * _middle(a, velocity, b, next_velocity, interval, i) + next_velocity[i]) ** 2
    for sample in range(_SAMPLES + 1):
        late = sample / _SAMPLES
        early, square = 1.0 - late, 0.0
        for i in range(a.shape[0]):
            middle = _middle(a, velocity, b, next_velocity, interval, i)
            rate = early * early * velocity[i] + 2.0 * early * late * middle + late * late * next_velocity[i]
            square += rate * rate
        most = max(most, square)
    return float(np.sqrt(most) + np.sqrt(bend) / (4.0 * _SAMPLES * _SAMPLES))
