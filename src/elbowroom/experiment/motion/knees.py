"""How suddenly knees move: a leg that is let go, or caught, in one frame has a knee that snaps."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.skeleton import Skeleton
from elbowroom.experiment.motion.angles import leg_angles
from elbowroom.experiment.motion.walked import RATE, Walked

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Knees:
    """The knees in the walks of one case: nearly all frames have less."""

    speed: float  # degrees a second, in 99 % of the frames
    acceleration: float  # degrees/s², in 99.5 % of them
    fastest: float  # degrees a second, in all of them


def flexions(walked: Walked, skeleton: Skeleton) -> tuple[Floats, Floats]:
    """The left and the right knee of a walk from where it is settled, degrees (N,)."""
    span = walked.settled()
    left, right = (leg_angles(walked.joints, skeleton, side)["knee"][span] for side in ("left", "right"))
    return left, right


def knees(bent: Sequence[Floats], rate: float = RATE) -> Knees:
    """The figures of some knees together, whose flexion (N,), degrees, is seen so many times a second."""
    speeds = rate * np.abs(np.concatenate([np.diff(own) for own in bent]))
    accelerations = rate**2 * np.abs(np.concatenate([np.diff(own, 2) for own in bent]))
    return Knees(float(np.percentile(speeds, 99.0)), float(np.percentile(accelerations, 99.5)), float(speeds.max()))
