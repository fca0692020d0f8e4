"""The proof that a course is feasible: a motion of the whole body that passes it with room to spare."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.gauntlet.line import CourseLine, steady_walk
from elbowroom.experiment.gauntlet.motion import UpperBodyMotion

Floats = NDArray[np.float64]

RATE = 240.0  # samples a second


@dataclass(frozen=True, eq=False)
class Certificate:
    """A walk through a course.

    Every pose keeps `margin` from every obstacle, between the samples too; so do its waist and arms with the pelvis at
    any height between those of a stand and of the lowest moment of a stride, that is at any pace and in any phase.
    """

    margin: float  # metres
    speed: float  # m/s, after the start
    times: Floats  # (K,) seconds, `RATE` a second
    way: Floats  # (K,) metres along the course's line
    roots: Floats  # (K, 7) root states
    uppers: Floats  # (K, LOCAL) radians

    @property
    def configurations(self) -> Floats:
        """The configurations `q` (K, DOF)."""
        return np.concatenate([self.roots[:, :3], self.uppers], axis=1)


def certify(line: CourseLine, motion: UpperBodyMotion, speed: float, margin: float) -> Certificate:
    """The walk along a line with a body motion, sampled densely; whoever calls sees to it that it keeps the margin."""
    walk = steady_walk(line, speed, RATE)
    return Certificate(margin, speed, walk.times, walk.way, walk.states, motion.at(walk.way))
