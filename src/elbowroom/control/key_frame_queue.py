"""The key-frame queue {Q_root, Q_waist, Q_hl, Q_hr}: the buffer between planning and playback (paper, section 4.2)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL
from elbowroom.body.root import ROOT_STATE
from elbowroom.planning.interpolation import hermite, monotone_tangents
from elbowroom.planning.root_path import RootPath, interpolate_root

Floats = NDArray[np.float64]

_SAME_TIME = 1e-9  # seconds


class KeyFrames(NamedTuple):
    """Key frames at increasing times."""

    times: Floats  # (m,) seconds
    roots: Floats  # (m, 7) root states
    uppers: Floats  # (m, 11) waist, left arm, right arm


class Playback(NamedTuple):
    """What the queue says for one moment."""

    root: Floats  # (7,)
    upper: Floats  # (11,)
    upper_velocity: Floats  # (11,) per second


class KeyFrameQueue:
    """Key frames that wait to be played, and the play head.

    A refill replaces what has not been played. Its path starts either at the next unplayed key frame (receding horizon:
    the interval in play goes on as it was), or at the play head itself (the motion is bent at once). In both cases the
    upper body goes on from where it is with the velocity it has.
    """

    def __init__(self, capacity: int, interval: float) -> None:
        self.capacity = capacity  # |Q|, key frames planned ahead
        self.interval = interval  # T_interval, seconds
        self.time = 0.0  # the play head, seconds
        self.clear()

    def clear(self) -> None:
        """Forget all key frames; the play head stays."""
        self._times = np.empty(0)
        self._roots = np.empty((0, ROOT_STATE))
        self._knots = np.empty(0)  # key times of the upper body, the first of them the moment of the refill
        self._uppers = np.empty((0, LOCAL))
        self._tangents = np.empty((0, LOCAL))
        self.start_count()

    def start_count(self) -> None:
        """Count `consumed` from here."""
        self._counted_from = self.time

    @property
    def consumed(self) -> float:
        """Key frames' worth of motion played since the last `start_count`, a real number."""
        return (self.time - self._counted_from) / self.interval

    @property
    def empty(self) -> bool:
        """Whether nothing is left to play."""
        return len(self._times) == 0 or self.time >= self._times[-1] - _SAME_TIME

    @property
    def fill(self) -> int:
        """Unplayed key frames, up to |Q|: after a refill |Q| lie beyond the one that is played towards."""
        return min(int(np.count_nonzero(self._times > self.time + _SAME_TIME)), self.capacity)

    def unplayed(self) -> KeyFrames:
        """The key frames that are still to come."""
        keys, knots = self._times > self.time + _SAME_TIME, self._knots > self.time + _SAME_TIME
        return KeyFrames(self._times[keys], self._roots[keys], self._uppers[knots])

    def refill(self, path: RootPath, uppers: Floats, now: Playback) -> None:
        """Replace what has not been played by key frames along `path`, `uppers` (n+1, 11) at its key times.

        `path` starts at the next unplayed key frame or at the play head; `now` is what is shown at the play head.
        """
        times = path.start_time + path.interval * np.arange(len(path.states))
        played = self._times <= self.time + _SAME_TIME
        keep_last = times[0] > self.time + _SAME_TIME  # the interval in play needs the key frame where it began
        before = slice(int(played.sum()) - 1, int(played.sum())) if keep_last else slice(0, 0)
        coming = times > self.time + _SAME_TIME
        self._times = np.concatenate([self._times[before], times])
        self._roots = np.concatenate([self._roots[before], path.states])
        self._knots = np.concatenate([[self.time], times[coming]])
        self._uppers = np.concatenate([now.upper[None], uppers[coming]])
        self._tangents = monotone_tangents(self._knots, self._uppers, now.upper_velocity)
        self.start_count()

    def advance(self, dt: float) -> None:
        """Move the play head by `dt` seconds."""
        self.time += dt

    def sample(self) -> Playback:
        """Root and upper body at the play head: C1 in time, across refills too; the queue has key frames."""
        upper, velocity = hermite(self._knots, self._uppers, self._tangents, self.time)
        return Playback(self._root(self.time), upper, velocity)

    def roots_until(self, time: float, count: int) -> Floats:
        """Root states (count, 7) at equal steps from the play head to `time`, which is not among them.

        None, (0, 7), if that time has come; the queue must reach to `time`.
        """
        if time <= self.time + _SAME_TIME:
            return np.empty((0, ROOT_STATE))
        return np.stack([self._root(self.time + i / count * (time - self.time)) for i in range(count)])

    def _root(self, time: float) -> Floats:
        last = len(self._times) - 1
        k = max(int(np.searchsorted(self._times, time, side="right")) - 1, 0)
        if k >= last:
            return np.array(self._roots[last])
        share = max((time - self._times[k]) / self.interval, 0.0)
        state: Floats = interpolate_root(self._roots[k], self._roots[k + 1], share, self.interval)
        return state
