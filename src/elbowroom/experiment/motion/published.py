"""Published curves of the leg's joints in walking; where each number comes from is said in docs/motion.md."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# Knee flexion at free speed, degrees at every 2 % of a stride: means of Schwartz, Rozumalski & Trost, "The effect of
# walking speed on the gait of typically developing children", J. Biomech. 41 (2008) 1639.
KNEE = np.array([
    5.5, 7.9, 11.0, 14.4, 17.2, 18.9, 19.7, 19.6, 18.9, 18.0, 16.9, 15.7, 14.5, 13.2, 12.0, 10.8, 9.8, 8.8, 7.9, 7.2,
    6.8, 6.7, 7.1, 8.0, 9.5, 11.6, 14.4, 18.1, 22.6, 28.0, 34.1, 40.6, 47.0, 52.5, 56.8, 59.4, 60.5, 60.0, 58.2, 55.0,
    50.8, 45.5, 39.5, 32.9, 26.0, 19.0, 12.6, 7.5, 4.5, 3.8, 5.2,
])  # fmt: skip
KNEE_DEVIATION = 6.0  # degrees: one standard deviation between people (from memory: Winter 1991 has 5 to 8)


class Corridor(NamedTuple):
    """Where a joint's angle lies at some parts of a stride."""

    parts: Floats  # (K,) of a stride
    low: Floats  # (K,) degrees
    high: Floats  # (K,)


def _corridor(*ranges: tuple[float, float]) -> Corridor:
    low, high = np.degrees(np.array(ranges)).T
    return Corridor(np.arange(len(ranges)) / len(ranges), low, high)


def corridors() -> dict[str, Corridor]:
    """The range of 95 % of strides on level ground at 0.8 to 1.2 m/s, at 0, 25, 50 and 75 % of a stride.

    Of the data of Reznick et al., "Lower-limb kinematics and kinetics during continuously varying human locomotion",
    Scientific Data 8 (2021) 282, as summed up by LocoHub. The hip counts from the pelvis, which leans ahead there.
    """
    return {
        "hip": _corridor((0.35, 0.83), (-0.04, 0.53), (-0.36, 0.27), (0.25, 0.78)),
        "knee": _corridor((-0.05, 0.25), (0.02, 0.36), (-0.02, 0.30), (0.96, 1.26)),
        "ankle": _corridor((-0.15, 0.15), (0.05, 0.22), (0.15, 0.33), (-0.17, 0.09)),
    }


PELVIC_TILT = 10.0  # degrees that a pelvis leans ahead in those data (from memory: Perry); that of an avatar is upright
