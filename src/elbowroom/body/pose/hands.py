"""Relaxed hands: how the fingers rest while the arms are planned."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.skeleton import Skeleton
from elbowroom.geometry import quaternion

# Flexion in degrees of proximal, intermediate and distal joints in the functional resting position of the hand.
_FINGERS = {
    "Index": (18.0, 28.0, 12.0),
    "Middle": (24.0, 32.0, 14.0),
    "Ring": (28.0, 34.0, 15.0),
    "Little": (30, 34, 15),
}
_PHALANGES = ("Proximal", "Intermediate", "Distal")
_THUMB = {"ThumbMetacarpal": 8.0, "ThumbProximal": 10.0, "ThumbDistal": 12.0}  # adduction towards the index finger


def relaxed_rotations(skeleton: Skeleton) -> NDArray[np.float64]:
    """Local rotations (J, 4): the fingers that the skeleton has are lightly curled, all else is the identity.

    In T-pose the palms face down: fingers curl about Z, the thumb closes about Y.
    """
    out = np.tile(quaternion.IDENTITY, (len(skeleton.names), 1))
    for side, mirror in (("left", 1.0), ("right", -1.0)):
        for finger, angles in _FINGERS.items():
            for phalanx, angle in zip(_PHALANGES, angles, strict=True):
                _set(out, skeleton, f"{side}{finger}{phalanx}", 2, -mirror * angle)
        for bone, angle in _THUMB.items():
            _set(out, skeleton, side + bone, 1, mirror * angle)
    return out


def _set(out: NDArray[np.float64], skeleton: Skeleton, bone: str, axis: int, degrees: float) -> None:
    if skeleton.has(bone):
        out[skeleton.index(bone)] = quaternion.about_axis(axis, np.deg2rad(degrees))
