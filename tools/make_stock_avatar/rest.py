"""Where the joints are: an adult of 1.72 m in T-pose, facing +Z, the left hand towards +X, the soles at y = 0.

Segment lengths follow Drillis and Contini (1966) for this stature, the head a little larger for a friendlier figure.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bones import PARENTS

EYE_CENTRE = (0.0332, 1.5900, 0.0622)  # metres, left
WRIST = 0.69  # x of the left wrist, metres
ARM_HEIGHT = 1.40  # y of the outstretched arms, metres

_CENTRE = {
    "hips": (0.0, 0.945, 0.0),
    "spine": (0.0, 1.035, -0.004),
    "chest": (0.0, 1.145, -0.010),
    "upperChest": (0.0, 1.265, -0.014),
    "neck": (0.0, 1.432, -0.020),
    "head": (0.0, 1.510, -0.006),
}

_LEFT = {
    "Eye": EYE_CENTRE,
    "Shoulder": (0.028, 1.395, -0.012),
    "UpperArm": (0.165, ARM_HEIGHT, -0.015),
    "LowerArm": (0.445, ARM_HEIGHT, -0.015),
    "Hand": (WRIST, ARM_HEIGHT, -0.012),
    "UpperLeg": (0.088, 0.900, 0.0),
    "LowerLeg": (0.092, 0.495, 0.004),
    "Foot": (0.096, 0.085, -0.018),
    "Toes": (0.101, 0.026, 0.105),
    "ThumbMetacarpal": (0.712, 1.391, 0.010),
    "ThumbProximal": (0.747, 1.380, 0.038),
    "ThumbDistal": (0.775, 1.373, 0.057),
    "IndexProximal": (0.782, 1.402, 0.020),
    "IndexIntermediate": (0.825, 1.400, 0.026),
    "IndexDistal": (0.851, 1.397, 0.029),
    "MiddleProximal": (0.786, 1.403, -0.003),
    "MiddleIntermediate": (0.833, 1.401, -0.001),
    "MiddleDistal": (0.862, 1.398, 0.000),
    "RingProximal": (0.781, 1.402, -0.026),
    "RingIntermediate": (0.825, 1.400, -0.029),
    "RingDistal": (0.852, 1.397, -0.031),
    "LittleProximal": (0.772, 1.399, -0.047),
    "LittleIntermediate": (0.806, 1.397, -0.054),
    "LittleDistal": (0.828, 1.394, -0.058),
}

FINGER_TIPS = {
    "Thumb": (0.800, 1.367, 0.072),
    "Index": (0.873, 1.393, 0.031),
    "Middle": (0.886, 1.394, 0.001),
    "Ring": (0.874, 1.393, -0.033),
    "Little": (0.847, 1.391, -0.062),
}

POSITIONS: dict[str, tuple[float, float, float]] = {
    **_CENTRE,
    **{f"left{bone}": p for bone, p in _LEFT.items()},
    **{f"right{bone}": (-p[0], p[1], p[2]) for bone, p in _LEFT.items()},
}

BONES: tuple[str, ...] = tuple(bone for bone in PARENTS if bone in POSITIONS)  # (J,) parents before children
INDEX: dict[str, int] = {bone: i for i, bone in enumerate(BONES)}


def joint(bone: str) -> NDArray[np.float64]:
    """The rest position (3,) of a joint, metres."""
    return np.array(POSITIONS[bone])


def finger_joints(finger: str) -> NDArray[np.float64]:
    """The three joints and the tip of a left finger, (4, 3), metres."""
    names = ("Metacarpal", "Proximal", "Distal") if finger == "Thumb" else ("Proximal", "Intermediate", "Distal")
    return np.array([POSITIONS[f"left{finger}{name}"] for name in names] + [FINGER_TIPS[finger]])
