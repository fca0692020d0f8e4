"""How one walker's own hips and chest go with the stride, as a recorded walk shows it: harmonics of the gait phase.

They take the place of published gait (`living`) in a walk ahead or back. At the speed of the recording they are those
recorded; slower they shrink to none, faster they grow a little, as the recorded arms do (`clips.swing`).
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.carriage import POSING
from elbowroom.body.root import WITH_FEET
from elbowroom.jit import exact_kernel

Floats = NDArray[np.float64]

HARMONICS = 4  # of the stride: what is quicker is no walk but noise
GROWTH, WIDEST = 1.1, 1.25  # m/s: how a swing grows with the speed; and times as wide as recorded, at most


class OwnStride(NamedTuple):
    """A recorded stride of hips and chest, its phase 0 at the left heel's strike."""

    harmonics: Floats  # (1 + 2 HARMONICS, POSING): mean, cosine and sine of each; standard leg's metres, radians
    speed: float  # m/s of the recorded walk; 0: nobody was recorded


PUBLISHED = OwnStride(np.zeros((1 + 2 * HARMONICS, POSING)), 0.0)


@exact_kernel
def carry_as_recorded(own: OwnStride, part: float, forward: float, scale: float, phase: float, out: Floats) -> None:
    """Change how a row (SHOWN,) is carried, by a `part` of the way, to how the recorded walker is, `forward` in m/s.

    `scale` is that of the legs. Backward the stride runs half a stride ahead, as the legs do.
    """
    gain = (1.0 - math.exp(-abs(forward) / GROWTH)) / (1.0 - math.exp(-own.speed / GROWTH))
    gain, angle = min(gain, WIDEST), 2.0 * math.pi * (phase if forward >= 0.0 else phase + 0.5)
    for i in range(POSING):
        value = own.harmonics[0, i]
        for k in range(1, HARMONICS + 1):
            value += own.harmonics[2 * k - 1, i] * math.cos(k * angle) + own.harmonics[2 * k, i] * math.sin(k * angle)
        size = scale if i < 3 else 1.0  # aside, up and ahead are lengths
        out[WITH_FEET + i] += part * (gain * size * value - out[WITH_FEET + i])
