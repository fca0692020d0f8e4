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
Goal = tuple[float, float]  # what a number is or should be, and how fast that changes

# Places of a foot's numbers: x, z, yaw of the flat foot in the root's frame, pitch, lift above the ground, how much of
# its swing is over (0: it stands), the velocity of x, z and yaw over the ground, in the axes of the root, how fast
# what it stands on or swings over rises, and how fast its pitch and its lift change.
X, Z, YAW, PITCH, LIFT, SWING, VELOCITY, RISING, ROLLING, LIFTING = 0, 1, 2, 3, 4, 5, 6, 9, 10, 11

FLAT = 1e-9  # radians, metres
_SLIGHT = 1e-4  # radians, metres, and that a second: so much is as good as none
LIFT_RATE = 1.5  # m/s: no foot that glides is lifted or lowered faster
_ROLL_RATE = 10.0  # rad/s: nor tilted
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
    foot[SWING] = foot[LIFT] = foot[RISING] = foot[LIFTING] = 0.0
    for i in range(3):
        foot[VELOCITY + i] = 0.0


@inner_exact_kernel
def eased(is_now: Goal, before: Goal, now: Goal, soon: float, dt: float) -> Goal:
    """A number of a foot `dt` later, and how fast it changes then: it goes on with its goals of before and now.

    Without a jump of its rate: what it is beside its goal fades as by a critically damped spring, the sooner the
    greater `soon`, 1/s.
    """
    beside, rate = is_now[0] - before[0], is_now[1] - before[1]
    left, led = np.exp(-soon * dt), rate + soon * beside
    beside, rate = (beside + led * dt) * left, (rate - soon * led * dt) * left
    if abs(beside) < _SLIGHT and abs(rate) < _SLIGHT:
        return now
    return now[0] + beside, now[1] + rate


@inner_exact_kernel
def tilt(foot: Floats, pitch: float, dt: float) -> None:
    """Pitch a foot that glides towards what it should be, no faster than feet roll."""
    was, most = foot[PITCH], dt * _ROLL_RATE
    foot[PITCH] += min(max(pitch - foot[PITCH], -most), most)
    foot[ROLLING] = (foot[PITCH] - was) / dt if dt > 0.0 else 0.0


def standing(rows: ArrayLike) -> Bools:
    """Which feet, left and right, stand in rows (..., WITH_FEET or more): (..., 2)."""
    feet = np.asarray(rows, np.float64)[..., ROOT_STATE:WITH_FEET]
    stands: Bools = feet[..., SWING::FOOT] <= 0.0
    return stands
