"""What is judged at once: some poses of a motion, and the ledger that what they are found to do is entered in."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.experiment.judge.ledger import Ledger, Nearness
from elbowroom.experiment.judge.poses import Posed

Floats = NDArray[np.float64]


class Case(NamedTuple):
    """N poses in their order; each is told by its place among them."""

    posed: Posed
    times: Floats  # (N,) seconds
    first: int  # the number of the first in the motion
    ledger: Ledger

    def part(self, rows: slice) -> "Case":
        """Some of the poses."""
        return Case(self.posed.part(rows), self.times[rows], self.first + rows.start, self.ledger)

    def enter(self, pose: int, part: str, obstacle: str, clearance: float) -> None:
        """Add how far a part of the body is from an obstacle, in metres."""
        self.ledger.enter(self.first + pose, Nearness(part, obstacle, float(self.times[pose]), clearance))
