"""What one avatar is told of another: roughly where it will be for long, and its very body for a moment.

Plans keep clear of the boxes, which are larger than what they hold. Whether a pose touches is asked of the body.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.model.axis_distances import lower_to_body
from elbowroom.world.obstacles.tracks.moving import Moving

Floats = NDArray[np.float64]


class Walker(NamedTuple):
    """Who wants to go where."""

    place: Floats  # (2,) metres, x and z
    wanted: Floats  # (2,) of length 1, where to; zero of who wants to stand

    @property
    def walks(self) -> bool:
        """Whether it wants to go somewhere."""
        return bool(self.wanted @ self.wanted > 0.5)  # its length is 1 or 0


class Neighbour(NamedTuple):
    """Another avatar, as it plans to move."""

    walker: Walker  # where it is, and where it wants to go
    boxes: Moving  # that hold its parts
    times: Floats  # (m,) seconds, increasing: the moments whose bodies are known
    axes: Floats  # (m, C, 6) its capsules' axes then, in the world
    radii: Floats  # (C,) metres

    def at(self, time: float) -> Floats:
        """Its capsules' axes (C, 6) at a time: straight between two known moments, else as in the nearest."""
        place = float(np.interp(time, self.times, np.arange(len(self.times))))
        k = min(int(place), max(len(self.times) - 2, 0))
        after = min(k + 1, len(self.times) - 1)
        found: Floats = self.axes[k] + (place - k) * (self.axes[after] - self.axes[k])
        return found

    def travel(self, first: float, last: float) -> float:
        """No point of its body moves farther between two times, metres."""
        times = [first, *self.times[(self.times > first) & (self.times < last)].tolist(), last]
        ends = np.array([self.at(time) for time in times]).reshape(len(times), -1, 3)
        return float(np.linalg.norm(np.diff(ends, axis=0), axis=2).sum(axis=0).max(initial=0.0))

    def clearance(self, axes: NDArray[np.float32], radii: NDArray[np.float32], origin: Floats, time: float) -> float:
        """The least distance, metres, of capsules (C, 6, 1) that lie about `origin` (x, z) from its body at a time.

        Negative where they overlap.
        """
        body = self.at(time)
        body[:, 0::3] -= origin[0]
        body[:, 2::3] -= origin[1]
        allowed = (radii[:, None] + self.radii).astype(np.float32)
        out = np.full(axes.shape[2], np.inf, np.float32)
        lower_to_body(axes, body.astype(np.float32), allowed, np.ones(len(body), np.bool_), out)
        return float(out[0])
