"""A body between two frames as the judge has it, who turns joints by the shortest arcs."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.judge.capsule_shapes import CapsuleShapes
from elbowroom.experiment.judge.motion import Moments, ShownMotion
from elbowroom.experiment.judge.poses import Poser

Floats = NDArray[np.float64]


def shown_ends(humanoid: Humanoid, roots: Floats, uppers: Floats, shares: Floats) -> Floats:
    """The ends (C, 2, 3, N) of all capsules in the world, at `shares` (N,) of the time between two frames.

    They have root states (2, 7 or more) and upper bodies (2, LOCAL).
    """
    q, zeros = np.concatenate([roots[:, :3], uppers], axis=1), np.zeros(len(shares), np.int64)
    moments = Moments(zeros, zeros + 1, shares, shares / 60.0)
    placed = CapsuleShapes(humanoid).placed(Poser(humanoid).at(ShownMotion.at_rate(q, roots), moments))
    ends = np.stack([placed.middles - placed.half_axes, placed.middles + placed.half_axes])
    out: Floats = ends.transpose(2, 0, 3, 1)
    return out
