"""The inverse of posing: which planning degrees of freedom a body's rotations come nearest to.

Rotations are since the T-pose, in its axes, shape (..., 4). What the degrees of freedom can express comes back exactly;
of anything else the waist keeps the rotation that is nearest, and an arm the directions of upper arm and forearm.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

_TWIST_WEIGHT = 0.02  # of the upper arm's own roll against the forearm's direction, whose weight is sin^2 of the elbow


def waist_angles(chest: Floats) -> Floats:
    """Bend and twist (..., 2) of the chest's rotation since the T-pose, relative to the pelvis.

    Of all `Ry(twist) Rx(bend)` the nearest: the scalar product of the two quaternions is a quadratic form in
    (cos bend/2, sin bend/2) once the best twist is put in, so its largest eigenvector is the answer.
    """
    x, y, z, w = np.moveaxis(chest, -1, 0)
    a, b, c = w * w + y * y, w * x - y * z, x * x + z * z
    half = 0.5 * np.arctan2(2.0 * b, a - c)
    cosine, sine = np.cos(half), np.sin(half)
    twist = 2.0 * np.arctan2(y * cosine - z * sine, x * sine + w * cosine)
    return np.stack([_wrapped(2.0 * half), _wrapped(twist)], axis=-1)


def chest_rotation(waist: Floats) -> Floats:
    """The chest's rotation (..., 4) for bend and twist (..., 2+)."""
    return quaternion.multiply(quaternion.about_axis(1, waist[..., 1]), quaternion.about_axis(0, waist[..., 0]))


def arm_angles(upper: Floats, lower: Floats, side: str) -> Floats:
    """Flexion, abduction, internal rotation and elbow (..., 4) of an arm.

    `upper` and `lower` are the rotations of upper arm and forearm since the T-pose relative to the chest; `side` is
    "left" or "right".
    """
    mirror = 1.0 if side == "left" else -1.0
    outwards = np.array([mirror, 0.0, 0.0])
    x, y, z = np.moveaxis(quaternion.rotate(upper, outwards), -1, 0)
    across = np.hypot(x, z)
    elevation = np.arctan2(across, -y)
    share = np.where(across > 1e-12, elevation / np.maximum(across, 1e-12), 1.0)
    flexion, abduction = share * z, mirror * share * x
    swing = _swing(flexion, mirror * abduction)
    back = quaternion.conjugate(swing)
    fx, fy, fz = np.moveaxis(quaternion.rotate(back, quaternion.rotate(lower, outwards)), -1, 0)
    elbow = np.arctan2(np.hypot(fx, fz), -fy)
    roll = quaternion.multiply(quaternion.multiply(back, upper), quaternion.about_axis(2, mirror * 0.5 * np.pi))
    angle = 2.0 * np.arctan2(roll[..., 1], roll[..., 3])
    weight = _TWIST_WEIGHT * (roll[..., 1] ** 2 + roll[..., 3] ** 2)
    bent = np.hypot(fx, fz)
    turn = np.arctan2(bent * fx + weight * np.sin(angle), bent * fz + weight * np.cos(angle))
    return np.stack([flexion, abduction, -mirror * turn, elbow], axis=-1)


def arm_directions(arm: Floats, side: str) -> tuple[Floats, Floats]:
    """Unit directions (..., 3) of upper arm and forearm in the chest's axes for arm configurations (..., 4)."""
    mirror = 1.0 if side == "left" else -1.0
    flexion, abduction, internal, elbow = np.moveaxis(np.asarray(arm, np.float64), -1, 0)
    swing, zero = _swing(flexion, mirror * abduction), np.zeros_like(flexion)
    turn = -mirror * internal
    bent = np.stack([np.sin(elbow) * np.sin(turn), -np.cos(elbow), np.sin(elbow) * np.cos(turn)], axis=-1)
    hanging = np.stack([zero, zero - 1.0, zero], axis=-1)
    return quaternion.rotate(swing, hanging), quaternion.rotate(swing, bent)


def _swing(flexion: Floats, outwards: Floats) -> Floats:
    return quaternion.from_rotation_vector(np.stack([-flexion, np.zeros_like(flexion), outwards], axis=-1))


def _wrapped(angle: Floats) -> Floats:
    """The same angle within half a turn."""
    return np.arctan2(np.sin(angle), np.cos(angle))
