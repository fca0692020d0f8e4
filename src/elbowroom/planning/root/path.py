"""The paper's f(t): where the root goes in the next moments, and exactly how it moves between two key frames."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body.gait.stride import climbing_rate
from elbowroom.body.root import HEIGHT, RootState
from elbowroom.jit import exact_kernel, inner_exact_kernel

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class RootPath:
    """Root states at equally spaced key times; between them the root moves as `interpolate_root` says."""

    start_time: float  # seconds
    interval: float  # seconds between key times
    states: Floats  # (n+1, 7) as in `RootState`

    @property
    def horizon(self) -> int:
        """The number n of key intervals."""
        return len(self.states) - 1

    @cached_property
    def times(self) -> Floats:
        """The key times (n+1,), seconds."""
        times: Floats = self.start_time + self.interval * np.arange(len(self.states), dtype=np.float64)
        return times

    def until(self, horizon: int) -> "RootPath":
        """The first key intervals."""
        return RootPath(self.start_time, self.interval, self.states[: horizon + 1])

    def time_of(self, number: int) -> float:
        """The time of one key frame, as in `times`."""
        return self.start_time + self.interval * number

    def at(self, time: float) -> RootState:
        """The state at a time, which is moved into the path's own duration if need be."""
        return RootState(*self.sample(np.array([time]))[0].tolist())

    def sample(self, times: ArrayLike) -> Floats:
        """States (N, 7) at times (N,), which are moved into the path's own duration if need be."""
        return sample_states(self.states, self.interval, np.asarray(times, np.float64) - self.start_time)


@exact_kernel
def interpolate_root(a: Floats, b: Floats, u: float, interval: float) -> Floats:
    """The root state (7,) at the part `u` in [0, 1] of a key interval of `interval` seconds from state `a` to `b`.

    Place and heading follow the cubic Hermite curves through both states' places and velocities; the velocities are
    those curves' derivatives, in the axes of the heading reached. The gait phase runs from `a` to `b` at a rate that
    changes linearly between the cadences of the two states, so it never runs backwards. The height goes as places do.
    How fast the ground climbs is told over some way (`motion`), so on a stair it is even, and changes linearly too: the
    curve of the height has a wave for every tread. What the feet stand on is left for who puts them there.
    """
    out = np.empty(a.shape[0])
    interpolate_between(a, b, rates_at(a, b), u, interval, out)
    return out


@inner_exact_kernel
def rates_at(a: Floats, b: Floats) -> tuple[float, float, float, float, float, float]:
    """Velocities along world x and z in state `a` and in `b`, and the strides per second there."""
    ax, az = _ground_velocity(a)
    bx, bz = _ground_velocity(b)
    return ax, az, bx, bz, _strides(a), _strides(b)


@inner_exact_kernel
def _strides(state: Floats) -> float:
    climb = state[HEIGHT + 1] if state.shape[0] > HEIGHT else 0.0
    return float(climbing_rate(state[3], state[4], state[5], climb))


@inner_exact_kernel
def interpolate_between(
    a: Floats, b: Floats, rates: tuple[float, float, float, float, float, float], u: float, interval: float, out: Floats
) -> None:
    """`interpolate_root` between two states with the `rates_at` them, written to `out` (7,)."""
    ax, az, bx, bz, first, last = rates
    out[0], vx = _hermite(a[0], ax, b[0], bx, u, interval)
    out[1], vz = _hermite(a[1], az, b[1], bz, u, interval)
    out[2], out[5] = _hermite(a[2], a[5], b[2], b[5], u, interval)
    sine, cosine = np.sin(out[2]), np.cos(out[2])
    out[3], out[4] = vx * sine + vz * cosine, vx * cosine - vz * sine
    done = u
    if first + last > 0.0:
        done = u * (2.0 * first + (last - first) * u) / (first + last)
    out[6] = a[6] + (b[6] - a[6]) * done
    if out.shape[0] > HEIGHT:
        out[HEIGHT:] = 0.0
        if a.shape[0] > HEIGHT:
            out[HEIGHT], _ = _hermite(a[HEIGHT], a[HEIGHT + 1], b[HEIGHT], b[HEIGHT + 1], u, interval)
            out[HEIGHT + 1] = a[HEIGHT + 1] + u * (b[HEIGHT + 1] - a[HEIGHT + 1])


@inner_exact_kernel
def _ground_velocity(state: Floats) -> tuple[float, float]:
    """Velocity along world x and z."""
    sine, cosine = np.sin(state[2]), np.cos(state[2])
    return state[3] * sine + state[4] * cosine, state[3] * cosine - state[4] * sine


@inner_exact_kernel
def _hermite(a: float, slope_a: float, b: float, slope_b: float, u: float, interval: float) -> tuple[float, float]:
    """Value and rate of change of the cubic from `a` to `b` with the given rates at its ends."""
    rest = 1.0 - u
    ta, tb = slope_a * interval, slope_b * interval
    value = rest * rest * ((1.0 + 2.0 * u) * a + u * ta) + u * u * ((3.0 - 2.0 * u) * b - rest * tb)
    slope = 6.0 * u * rest * (b - a) + rest * (rest - 2.0 * u) * ta + u * (u - 2.0 * rest) * tb
    return value, slope / interval


@exact_kernel
def ground_covered(states: Floats) -> tuple[float, float, float, float]:
    """The rectangle that holds the places of states (N, 7): least and greatest x, least and greatest z."""
    low_x, high_x, low_z, high_z = np.inf, -np.inf, np.inf, -np.inf
    for n in range(states.shape[0]):
        low_x, high_x = min(low_x, states[n, 0]), max(high_x, states[n, 0])
        low_z, high_z = min(low_z, states[n, 1]), max(high_z, states[n, 1])
    return low_x, high_x, low_z, high_z


@exact_kernel
def sample_states(states: Floats, interval: float, times: Floats) -> Floats:
    """States (N, 7) at `times` (N,) after the first of `states` (n+1, 7); the ends hold outside."""
    out = np.empty((times.shape[0], states.shape[1]))
    last = states.shape[0] - 1
    for i in range(times.shape[0]):
        position = min(max(times[i] / interval, 0.0), float(last))
        if last == 0:
            for j in range(states.shape[1]):
                out[i, j] = states[0, j]
        else:
            k = min(int(position), last - 1)
            a, b = states[k], states[k + 1]
            interpolate_between(a, b, rates_at(a, b), position - k, interval, out[i])
    return out
