"""The key-frame queue {Q_root, Q_waist, Q_hl, Q_hr}: the buffer between planning and playback (paper, section 4.2)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL
from elbowroom.body.root import ROOT_STATE
from elbowroom.jit import brief_exact_kernel
from elbowroom.planning.interpolation import hermite, monotone_tangents
from elbowroom.planning.root.path import RootPath, interpolate_root
from elbowroom.planning.stillness import is_still

Floats = NDArray[np.float64]

_SAME_TIME = 1e-9  # seconds
_WHOLE = 1.0 - 1e-9  # of the pace of the plan


class KeyFrames(NamedTuple):
    """Key frames at increasing times."""

    times: Floats  # (m,) seconds
    roots: Floats  # (m, 7) root states
    uppers: Floats  # (m, LOCAL) the local groups side by side


class Playback(NamedTuple):
    """What the queue says for one moment."""

    root: Floats  # (7,)
    upper: Floats  # (LOCAL,)
    upper_velocity: Floats  # (LOCAL,) per second


class KeyFrameQueue:
    """Key frames that wait to be played, and the play head.

    A new motion is spliced in where it starts: until then everything is played exactly as it was, root and upper body,
    and there it goes on with the velocity that it has. So what is shown does not depend on when a plan was ready, as
    long as it was ready before its start is played.

    The key frames can be played slower than they were planned: what has not been played moves into the future, and the
    poses stay the same.
    """

    def __init__(self, capacity: int, interval: float) -> None:
        self.capacity = capacity  # |Q|, key frames planned ahead
        self.interval = interval  # T_interval, seconds
        self.time = 0.0  # the play head, seconds
        self.delay = 0.0  # seconds that were lost by playing slower
        self._rate = 1.0
        self.clear()

    def clear(self) -> None:
        """Forget all key frames; the play head stays."""
        self._times = np.empty(0)
        self._roots = np.empty((0, ROOT_STATE))
        self._uppers = np.empty((0, LOCAL))
        self._velocities = np.empty((0, LOCAL))
        self._ends_moving = False
        self.start_count()

    def start_count(self) -> None:
        """Count `consumed` from here."""
        self._counted_from = self.time

    @property
    def consumed(self) -> float:
        """Key frames' worth of motion played since the last `start_count`, a real number."""
        return (self.time - self._counted_from) / self.interval

    @property
    def left(self) -> float:
        """Seconds of motion that are left to play."""
        return float(self._times[-1]) - self.time if len(self._times) else 0.0

    @property
    def empty(self) -> bool:
        """Whether nothing is left to play."""
        return self.left <= _SAME_TIME

    @property
    def ends_moving(self) -> bool:
        """Whether the root still moves at the last key frame."""
        return self._ends_moving

    @property
    def fill(self) -> int:
        """Unplayed key frames, up to |Q|: after a refill |Q| lie beyond the one that is played towards."""
        return min(len(self._times) - self._next(), self.capacity)

    def unplayed(self) -> KeyFrames:
        """The key frames that are still to come."""
        following = self._next()
        return KeyFrames(self._times[following:], self._roots[following:], self._uppers[following:])

    def ahead(self) -> Floats:
        """Seconds from now and root states (m, 8) of the key frames that are still to come."""
        return _coming(self._times, self._roots, self.time)

    def _next(self) -> int:
        """The number of the first key frame that is still to come."""
        return first_after(self._times, self.time)

    def splice(self, path: RootPath, uppers: Floats, velocity: Floats, velocities: Floats | None = None) -> None:
        """From the start of `path` on, play it with the upper body `uppers` (n+1, LOCAL) at its key times.

        The path starts at the play head or later, in the state that `at` gives for its start; `velocity` (LOCAL,) is
        the upper body's there. `velocities` (n+1, LOCAL) are those at all key times, where the planner has chosen them.
        """
        times = path.times
        kept = self._kept_until(times[0])
        curve = monotone_tangents(times, uppers, velocity) if velocities is None else velocities.copy()
        curve[0] = velocity
        self._times = np.concatenate([self._times[kept], times])
        self._roots = np.concatenate([self._roots[kept], path.states])
        self._uppers = np.concatenate([self._uppers[kept], uppers])
        self._velocities = np.concatenate([self._velocities[kept], curve])
        self._ends_moving = not is_still(path.states[-1, 3:6])
        self.start_count()

    def _kept_until(self, time: float) -> slice:
        """The key frames from the last one played until, and without, the one at `time`; none where it is now."""
        if time <= self.time + _SAME_TIME:
            return slice(0, 0)
        return slice(max(self._next() - 1, 0), int(np.count_nonzero(self._times < time - _SAME_TIME)))

    def advance(self, dt: float, rate: float = 1.0) -> None:
        """Move the play head by `dt` seconds, in which `rate` times as many seconds of the motion are played."""
        self.time += dt
        self._rate = rate
        if rate < _WHOLE:
            lost = (1.0 - rate) * dt
            self.delay += lost
            self._times = self._times + lost

    def sample(self) -> Playback:
        """Root and upper body at the play head, C1 in time across splices too; the queue has key frames."""
        planned = self.at(self.time)
        if self._rate >= _WHOLE:
            return planned
        root = planned.root.copy()
        root[3:6] *= self._rate
        return Playback(root, planned.upper, self._rate * planned.upper_velocity)

    def at(self, time: float) -> Playback:
        """What the motion has at `time`, played as it was planned; at its end the root still has its velocity."""
        return Playback(*_motion_at(self._times, self._roots, self._uppers, self._velocities, time))


@brief_exact_kernel
def first_after(times: Floats, time: float) -> int:
    """The number of the first of increasing times that is later than another."""
    number = 0
    while number < len(times) and times[number] <= time + _SAME_TIME:
        number += 1
    return number


@brief_exact_kernel
def _coming(times: Floats, roots: Floats, time: float) -> Floats:
    """The seconds from a time and the roots (m, 8) of key frames that are later."""
    first = first_after(times, time)
    coming = np.empty((len(times) - first, 1 + ROOT_STATE))
    for n in range(len(coming)):
        coming[n, 0], coming[n, 1:] = times[first + n] - time, roots[first + n]
    return coming


@brief_exact_kernel
def _motion_at(
    times: Floats, roots: Floats, uppers: Floats, velocities: Floats, time: float
) -> tuple[Floats, Floats, Floats]:
    """Root, upper body and its velocity at a time, between key frames or on the last."""
    k, last = 0, times.shape[0] - 1
    while k < last and times[k + 1] <= time + _SAME_TIME:
        k += 1
    if abs(times[k] - time) <= _SAME_TIME or k == last:
        return roots[k].copy(), uppers[k].copy(), velocities[k].copy()
    interval = times[k + 1] - times[k]
    share = max((time - times[k]) / interval, 0.0)
    upper, velocity = hermite(times, uppers, velocities, time)
    return interpolate_root(roots[k], roots[k + 1], share, interval), upper, velocity
