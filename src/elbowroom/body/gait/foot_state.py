"""The state of the feet in a row behind the root's: where each is, and what all that moves them does with it.

A foot is FOOT numbers, in the axes of the root: where it is, flat, how it is pitched and lifted, how much of its swing
is over, and how fast it goes.
"""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from elbowroom.body.root import FOOT, ROOT_STATE, WITH_FEET
from elbowroom.jit import exact_kernel, inner_exact_kernel

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

# Places of a foot's numbers: x, z, yaw of the flat foot in the root's frame, pitch, lift above the ground, how much of
# its swing is over (0: it stands), the velocity of x, z and yaw over the ground, in the axes of the root, and how fast
# what it stands on or swings over rises.
X, Z, YAW, PITCH, LIFT, SWING, VELOCITY, RISING = 0, 1, 2, 3, 4, 5, 6, 9

FLAT = 1e-9  # radians, metres
LIFT_RATE = 1.5  # m/s: no foot is lifted or lowered faster; a recorded one is
_ROLL_RATE, _SLAP = 14.0, 6.0  # rad/s: nor tilted; nor do the toes of one that stands on its heel come down
_STILL = 1e-3  # m/s: below, the root rests


@inner_exact_kernel
def rests(root: Floats) -> bool:
    """Whether the root stands still."""
    return bool(abs(root[3]) + abs(root[4]) + abs(root[5]) < _STILL)


@inner_exact_kernel
def carry(before: Floats, root: Floats, out: Floats) -> None:
    """Both feet where they were in the world, as seen from another root."""
    turned = before[2] - root[2]
    c, s, cosine, sine = np.cos(turned), np.sin(turned), np.cos(root[2]), np.sin(root[2])
    dx, dz = before[0] - root[0], before[1] - root[1]
    left, ahead = dx * cosine - dz * sine, dx * sine + dz * cosine
    for i in range(ROOT_STATE):
        out[i] = root[i]
    for side in range(2):
        at = ROOT_STATE + FOOT * side
        for i in range(FOOT):
            out[at + i] = before[at + i]
        x, z, vx, vz = before[at + X], before[at + Z], before[at + VELOCITY], before[at + VELOCITY + 1]
        out[at + X], out[at + Z] = left + x * c + z * s, ahead - x * s + z * c
        out[at + YAW] = before[at + YAW] + turned
        out[at + VELOCITY], out[at + VELOCITY + 1] = vx * c + vz * s, -vx * s + vz * c


@exact_kernel
def position(phase: float, side: int) -> float:
    """Where in its cycle a foot is, 0 to 1."""
    cycle = phase + 0.5 * side
    return float(cycle - np.floor(cycle))


@inner_exact_kernel
def is_flat(foot: Floats) -> bool:
    """Whether a foot lies flat on the ground."""
    return bool(abs(foot[PITCH]) < FLAT and foot[LIFT] < FLAT)


@inner_exact_kernel
def land(foot: Floats) -> None:
    """Let a foot stand where it is."""
    foot[SWING] = foot[LIFT] = foot[RISING] = 0.0
    for i in range(3):
        foot[VELOCITY + i] = 0.0


@inner_exact_kernel
def tilt(foot: Floats, pitch: float, dt: float) -> None:
    """Pitch a foot towards what it should be, no faster than feet roll."""
    most = dt * (_SLAP if foot[PITCH] < 0.0 and foot[SWING] <= 0.0 else _ROLL_RATE)
    foot[PITCH] += min(max(pitch - foot[PITCH], -most), most)


def standing(rows: ArrayLike) -> Bools:
    """Which feet, left and right, stand in rows (..., WITH_FEET or more): (..., 2)."""
    feet = np.asarray(rows, np.float64)[..., ROOT_STATE:WITH_FEET]
    stands: Bools = feet[..., SWING::FOOT] <= 0.0
    return stands
