"""Hip, knee and ankle in the plane in which a leg swings, in the signs of gait laboratories."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.skeleton import Skeleton
from elbowroom.experiment.judge.poses import Posed

Floats = NDArray[np.float64]

JOINTS = ("hip", "knee", "ankle")


def leg_angles(joints: Posed, skeleton: Skeleton, side: str) -> dict[str, Floats]:
    """Flexion of hip and knee and dorsiflexion of the ankle, degrees (N,), by the lines from joint to joint.

    The hip's is that of the thigh against the pelvis; the knee's is 0 where thigh and shin are in line, the ankle's
    where the shin stands upright on the sole.
    """
    places, turns = joints
    bones = ("hips", f"{side}UpperLeg", f"{side}LowerLeg", f"{side}Foot")
    hips, thigh, shin, foot = (skeleton.index(bone) for bone in bones)
    upper, lower = places[:, shin] - places[:, thigh], places[:, foot] - places[:, shin]
    in_pelvis = _seen_from(turns[:, hips], upper)
    in_thigh = _seen_from(turns[:, thigh], np.stack([upper, lower], axis=1))
    a, b = in_thigh[:, 0], in_thigh[:, 1]
    in_foot = _seen_from(turns[:, foot], -lower)
    return {
        "hip": np.degrees(np.arctan2(in_pelvis[:, 2], -in_pelvis[:, 1])),
        "knee": np.degrees(np.arctan2(a[:, 1] * b[:, 2] - a[:, 2] * b[:, 1], a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2])),
        "ankle": np.degrees(np.arctan2(in_foot[:, 2], in_foot[:, 1])),
    }


def _seen_from(turns: Floats, vectors: Floats) -> Floats:
    """Vectors (N, 3) or (N, M, 3) of the world in frames with rotations (N, 3, 3)."""
    seen: Floats = np.einsum("nij,n...i->n...j", turns, vectors)
    return seen
