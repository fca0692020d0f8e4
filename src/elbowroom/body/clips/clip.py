"""Motion clips: prepared motion of one group of degrees of freedom, the paper's animation curves."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body.clips.monotone_cubic import MonotoneCubic
from elbowroom.body.dof import DofGroup

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class MotionClip:
    """Configurations of one group at increasing times; between them a monotone cubic (F. N. Fritsch & J. Butland 1984).

    A looping clip's last configuration equals its first.
    """

    name: str
    group: DofGroup
    times: Floats  # (K,) seconds (arm swing: strides), increasing
    configurations: Floats  # (K, d) radians
    loop: bool = False

    @property
    def duration(self) -> float:
        """Length of the clip, in the unit of its times."""
        return float(self.times[-1] - self.times[0])

    @cached_property
    def _curve(self) -> MonotoneCubic:
        if not self.loop:
            return MonotoneCubic(self.times, self.configurations)
        before, after = self.times[-3:-1] - self.duration, self.times[1:3] + self.duration
        times = np.concatenate([before, self.times, after])
        rows = np.concatenate([self.configurations[-3:-1], self.configurations, self.configurations[1:3]])
        return MonotoneCubic(times, rows)

    @cached_property
    def cubics(self) -> tuple[Floats, Floats]:
        """Where the segments of the curve begin and end (S+1,), and their coefficients (4, S, d), highest power first.

        A loop's segments begin before its start and end after its end.
        """
        return self._curve.cubics

    def sample(self, t: ArrayLike) -> Floats:
        """Configurations (..., d) at times `t` (...): a loop goes on for ever, any other clip rests at its ends."""
        time, start = np.asarray(t, np.float64), float(self.times[0])
        if self.loop:
            time = start + np.mod(time - start, self.duration)
        else:
            time = np.clip(time, start, float(self.times[-1]))
        configurations: Floats = self._curve(time)
        return configurations

    def resample(self, k: int) -> Floats:
        """Configurations (k, d) at `k` equal time steps, both ends included; a loop's end, its start again, is not."""
        times = np.linspace(self.times[0], self.times[-1], k, endpoint=not self.loop)
        return self.sample(times)
