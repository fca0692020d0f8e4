"""How one walker's own hips and chest go with the stride, as a recorded walk shows it: harmonics of the gait phase.

They take the place of published gait (`living`) in a walk ahead or back. At the speed of the recording they are those
recorded; slower they shrink to none, faster they grow a little, as the recorded arms do (`clips.swing`).
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.carriage import POSING, UP
from elbowroom.body.gait.cycle import GaitShape, foot_poses
from elbowroom.body.root import ROOT_STATE, WITH_FEET
from elbowroom.jit import inner_exact_kernel

Floats = NDArray[np.float64]

HARMONICS = 4  # of the stride: what is quicker is no walk but noise
_HIP, _ANKLE, _THIGH, _SHIN = 0, 3, 8, 9  # columns of `GaitShape.legs`
_HIGHEST = 0.1  # metres of a standard leg that hips are carried up or down
GROWTH, WIDEST = 1.1, 1.25  # m/s: how a swing grows with the speed; and times as wide as recorded, at most


class OwnStride(NamedTuple):
    """A recorded stride of hips and chest, its phase 0 at the left heel's strike."""

    harmonics: Floats  # (1 + 2 HARMONICS, POSING): mean, cosine and sine of each; standard leg's metres, radians
    speed: float  # m/s of the recorded walk; 0: nobody was recorded


PUBLISHED = OwnStride(np.zeros((1 + 2 * HARMONICS, POSING)), 0.0)


def harmonics_of(rows: Floats) -> Floats:
    """The harmonics (1 + 2 HARMONICS, ...) of rows (n, ...) at even phases of a stride."""
    waves = np.fft.rfft(rows, axis=0)[: HARMONICS + 1] / len(rows)
    made = np.zeros((1 + 2 * HARMONICS, *rows.shape[1:]))
    made[0], made[1::2], made[2::2] = waves[0].real, 2.0 * waves[1:].real, -2.0 * waves[1:].imag
    return made


def within(harmonics: Floats, most: float) -> Floats:
    """Harmonics (1 + 2 HARMONICS,), made smaller together where they could come to more."""
    size = float(np.hypot(harmonics[1::2], harmonics[2::2]).sum() + abs(harmonics[0]))
    return harmonics * min(1.0, most / max(size, 1e-9))


def at_height(own: OwnStride, heights: Floats, lowerings: Floats, gait: GaitShape) -> OwnStride:
    """The stride on some legs with its hips as high over the feet that stand as they were recorded.

    `heights` (n,) at even phases are those of the hips beside a straight standing leg, metres of a standard leg;
    `lowerings` (n,) what planning keeps of them.
    """
    roots, legs = np.zeros((len(heights), ROOT_STATE)), gait.legs
    roots[:, 3], roots[:, 6] = own.speed, np.arange(len(heights)) / len(heights)
    drops = foot_poses(legs, gait.scale, roots)[1] + gait.half_leg * lowerings
    straight = (legs[:, _THIGH] + legs[:, _SHIN] + legs[:, _ANKLE + 1] - legs[:, _HIP + 1]).mean()
    made = own.harmonics.copy()
    made[:, UP - WITH_FEET] = within(harmonics_of(heights + (straight + drops) / gait.scale), _HIGHEST)
    return own._replace(harmonics=made)


@inner_exact_kernel
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
