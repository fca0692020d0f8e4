"""Which nodes of a slice some obstacles close: those that touch them, at the moments around the key time."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.planning.exact.joint.clearances import clearances_under
from elbowroom.planning.exact.joint.step import PRODUCT, JointStep
from elbowroom.world.obstacles.layout import Nearby

Bools = NDArray[np.bool_]


class Closed(NamedTuple):
    """The nodes that some obstacles close: waists, and both arms under each waist."""

    waist: Bools  # (W,)
    left: Bools  # (W, L)
    right: Bools  # (W, R)

    @property
    def any(self) -> bool:
        """Whether there are such."""
        return any(bool(nodes.any()) for nodes in self)


class SliceNodes:
    """The nodes of one slice under the waists that count."""

    def __init__(self, step: JointStep, depth: int, waists: Bools) -> None:
        """Only under `waists` (W,) are children looked at."""
        self._step, self._depth, self._waists = step, depth, waists
        around = step.around
        self._pelvis = around.places[depth][None], around.turns[depth][None]
        self._chests = step.chests(depth, step.configurations(0, depth))

    def closed_by(self, obstacles: Nearby) -> Closed:
        """What some obstacles close, all of them together."""
        step, depth, one = self._step, self._depth, np.ones(1, np.bool_)
        clear, _ = clearances_under(step.lanes(0, depth), *self._pelvis, obstacles, one)
        waist: Bools = clear[0, : len(self._waists)] < step.nodes[0].margins[depth]
        arms, under = [], self._waists & ~waist
        for g in range(1, len(step.nodes)):
            child = step.nodes[g]
            found, _ = clearances_under(step.lanes(g, depth), *self._chests, obstacles, under)
            closed: Bools = found[:, : child.base.shape[1]] < child.margins[depth]
            if g in PRODUCT:
                arms.append(closed)
            else:
                waist |= (closed | ~np.isfinite(child.base[depth])).all(axis=1)
        return Closed(waist, *arms)
