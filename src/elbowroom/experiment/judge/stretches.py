"""Poses in stretches of a few neighbours: what is far from all the body's places in one is not looked at pose by pose.

A point that a joint carries at a distance d from it is, at each pose of a stretch, at most as far from where it is at
the middle one as the joint has moved, and d times the spectral norm of what its rotation matrix has changed. That norm
is 2 sin(angle / 2): the Frobenius norm over the root of 2.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.judge.poses import Posed

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

_LONG = 8  # poses
_ROUNDING = 1e-9  # metres


class Stretches(NamedTuple):
    """N poses in S stretches."""

    poses: int  # N
    middles: Ints  # (S,) the pose in the middle of each
    moved: Floats  # (S, J) metres that a joint is away from where it is there, at most
    turned: Floats  # (S, J) metres by which what it carries 1 m away is farther from there, at most

    def rows(self, which: Ints) -> Ints:
        """The poses (s, any) of some stretches (s,); those of the last one may be told twice."""
        rows: Ints = np.minimum(which[:, None] * _LONG + np.arange(_LONG), self.poses - 1)
        return rows

    def away(self, joints: Ints, distances: Floats) -> Floats:
        """How far (S, n) points that joints (n,) carry so far (n,) from them are at most from where they are there."""
        away: Floats = self.moved[:, joints] + distances * self.turned[:, joints] + _ROUNDING
        return away


def stretches_of(posed: Posed) -> Stretches:
    """Poses in their order, so many at once."""
    count = len(posed.positions)
    starts = np.arange(0, count, _LONG)
    middles = np.minimum(starts + _LONG // 2, count - 1)
    moved, turned = np.zeros((2, len(starts), posed.positions.shape[1]))
    for after in range(_LONG):
        rows = np.minimum(starts + after, count - 1)
        np.maximum(moved, _squares(posed.positions[rows] - posed.positions[middles], 1), out=moved)
        np.maximum(turned, _squares(posed.rotations[rows] - posed.rotations[middles], 2), out=turned)
    return Stretches(count, middles, np.sqrt(moved), np.sqrt(0.5 * turned))


def _squares(values: Floats, axes: int) -> Floats:
    """The sums of the squares of arrays over their last axes."""
    flat = values.reshape(*values.shape[:-axes], -1)
    squares: Floats = np.einsum("sji,sji->sj", flat, flat)
    return squares
