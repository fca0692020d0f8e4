"""More postures, only where the search is blocked: drawn evenly, taken in if they are free there and differ.

A graph of clips reaches what the clips show. Where a slice leaves no path, postures are drawn within the limits of the
joints, half of them all over and half near the goal (`drawn_postures`). Those that are free there, of obstacles and of
the body itself, are taken in, the ones nearest to the goal first, and none that is like another. They stay for the
plans to come until newer ones need their place.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.jit import exact_kernel

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
Indices = NDArray[np.int64]


class RefinementSettings(NamedTuple):
    """How many postures are drawn and taken in for a blocked slice."""

    drawn: int = 512
    taken: int = 24  # at most, of each group and slice
    apart: float = 0.2  # radians between any two
    near: float = 0.8  # radians to either side of the goal in which half of them are drawn
    slices: int = 3  # for which postures are drawn, from the blocked one on
    capacity: int = 64  # added postures that a group remembers


def chosen(postures: Floats, costs: Floats, known: Floats, apart: float, most: int) -> Indices:
    """Numbers of at most `most` postures (N, d), cheapest first, each `apart` from those before and from `known`."""
    numbers: Indices = _spread(postures, costs, np.argsort(costs, kind="stable"), known, apart, most)
    return numbers


@exact_kernel
def _spread(postures: Floats, costs: Floats, order: Indices, known: Floats, apart: float, most: int) -> Indices:
    """`chosen`, going through the postures in an order (N,)."""
    taken, count = np.empty(most, np.int64), 0
    for n in order:
        if count == most or costs[n] == np.inf:
            break
        differs = True
        for k in range(count + known.shape[0]):
            other, total = postures[taken[k]] if k < count else known[k - count], 0.0
            for i in range(postures.shape[1]):
                total += (postures[n, i] - other[i]) ** 2
            if total < apart * apart:
                differs = False
                break
        if differs:
            taken[count] = n
            count += 1
    return taken[:count]


class Pool:
    """The postures that were added to one group, the newest last; of bounded size."""

    def __init__(self, size: int, capacity: int) -> None:
        self._capacity = capacity
        self.postures: Floats = np.empty((0, size))

    def clear(self) -> bool:
        """Forget all; whether there were any."""
        held, self.postures = len(self.postures) > 0, self.postures[:0]
        return held

    def add(self, postures: Floats) -> bool:
        """Take in postures (N, d), in place of the oldest beyond the capacity; whether there were any."""
        if not len(postures):
            return False
        self.postures = np.concatenate([self.postures, postures[: self._capacity]])[-self._capacity :]
        return True
