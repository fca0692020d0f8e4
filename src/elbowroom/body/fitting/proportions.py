"""Skeleton and collision body of average adult proportions, for tests and for files without a mesh.

Joint heights and segment lengths: R. Drillis & R. Contini, "Body segment parameters" (1966), as printed in D. A.
Winter, "Biomechanics and Motor Control of Human Movement", fractions of stature. Widths and girths: means over men and
women of C. C. Gordon et al., "2012 Anthropometric Survey of U.S. Army Personnel" (ANSUR II, 2014), divided by the mean
stature of 1.69 m; a limb's radius is its girth / 2 pi, averaged over the segment.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bones import PARENTS, SPINE
from elbowroom.body.capsules import Capsules
from elbowroom.body.dof import group_of_bone
from elbowroom.body.humanoid import AvatarMeta, Humanoid
from elbowroom.body.skeleton import Skeleton

Floats = NDArray[np.float64]

_HEAD_HEIGHT = 0.885  # of stature: the skull's joint, between the ears

# Joints in T-pose as fractions of stature: x (left), y (up), z (forward); the right side is mirrored.
_MIDDLE = {
    "hips": (0.0, 0.545, 0.0),
    "spine": (0.0, 0.585, 0.0),
    "chest": (0.0, 0.655, 0.0),
    "upperChest": (0.0, 0.730, 0.0),
    "neck": (0.0, 0.835, 0.0),
    "head": (0.0, _HEAD_HEIGHT, 0.004),
}
_LEFT = {
    "Shoulder": (0.020, 0.812, 0.0),
    "UpperArm": (0.105, 0.815, 0.0),  # biacromial breadth 0.2275, joint some 2 cm inside
    "LowerArm": (0.291, 0.815, 0.0),  # upper arm 0.186
    "Hand": (0.437, 0.815, 0.0),  # forearm 0.146
    "UpperLeg": (0.050, 0.530, 0.0),
    "LowerLeg": (0.050, 0.285, 0.0),  # thigh 0.245
    "Foot": (0.050, 0.039, 0.0),  # shin 0.246
    "Toes": (0.050, 0.012, 0.075),  # ball of the foot
}

# Radii and lengths of the collision body, fractions of stature.
_PELVIS = (0.068, 0.034)  # radius (buttock depth 24 cm / 2), half length of the axis (hip breadth 34.6 cm)
_ABDOMEN = (0.063, 0.028)  # waist depth 22.8 cm, waist breadth 31.3 cm
_TORSO = (0.066, 0.024)  # chest depth without breasts, chest breadth 27.7 cm
_CHEST = (0.053, 0.048)  # at the height of the armpits: up to the shoulder joints
_NECK = 0.034  # neck girth 36 cm
_HEAD = 0.055  # head breadth 15.1 cm, head length 19.4 cm
_UPPER_ARM = 0.029  # biceps girth 33 cm, less towards the elbow
_FOREARM = 0.023  # forearm girth 28.7 cm, wrist girth 16.6 cm
_HAND = 0.021  # hand girth 20 cm
_HAND_LENGTH = 0.092  # hand 0.108 (Winter), less for relaxed fingers
_THIGH = 0.047  # thigh girth 62 cm, lower thigh 40 cm
_SHIN = 0.030  # calf girth 38 cm, ankle girth 22 cm
_FOOT = 0.020  # height of the instep
_HEEL = 0.040  # heel behind the ankle
_TOE = 0.112  # toe tip before the ankle: foot length 0.152 (Winter)


def proportional_skeleton(height: float = 1.72) -> Skeleton:
    """The skeleton of an adult of this stature in metres: all VRM body bones, no fingers."""
    points = dict(_MIDDLE)
    for bone, (x, y, z) in _LEFT.items():
        points[f"left{bone}"], points[f"right{bone}"] = (x, y, z), (-x, y, z)
    names = tuple(points)
    parents = [-1 if parent is None else names.index(parent) for parent in (PARENTS[name] for name in names)]
    return Skeleton(names, np.array(parents, np.int64), height * np.array(list(points.values())))


def proportional_humanoid(height: float = 1.72) -> Humanoid:
    """A humanoid of average proportions and this stature in metres, without file or mesh."""
    skeleton = proportional_skeleton(height)
    meta = AvatarMeta(title="Average proportions", licence="CC0-1.0")
    return Humanoid("proportional", skeleton, proportional_capsules(skeleton), meta=meta)


def stature(skeleton: Skeleton) -> float:
    """Estimated stature in metres: the head joint is at 0.885 of it."""
    return skeleton.height / _HEAD_HEIGHT


def last_spine(skeleton: Skeleton) -> str:
    """The highest spine bone that the skeleton has: what neck and shoulders hang on."""
    return next(bone for bone in reversed(SPINE) if skeleton.has(bone))


def proportional_capsules(skeleton: Skeleton) -> Capsules:
    """Capsules of average girth on any skeleton that has at least the bones which VRM requires."""
    size = stature(skeleton)
    parts = _leg_parts(skeleton, size) + _trunk_parts(skeleton, size) + _arm_parts(skeleton, size)
    joints = np.array([skeleton.index(bone) for _, bone, *_ in parts], np.int64)
    rest = skeleton.positions[joints]
    return Capsules(
        names=tuple(part[0] for part in parts),
        joints=joints,
        starts=np.array([part[2] for part in parts]) - rest,
        ends=np.array([part[3] for part in parts]) - rest,
        radii=np.array([part[4] for part in parts]) * size,
        groups=tuple(group_of_bone(part[1]) for part in parts),
    )


# Name, carrying bone, start and end in the T-posed body, radius / stature.
_Part = tuple[str, str, Floats, Floats, float]


def _lateral(centre: Floats, half: float) -> tuple[Floats, Floats]:
    sideways = np.array([half, 0.0, 0.0])
    return centre + sideways, centre - sideways


def _leg_parts(skeleton: Skeleton, size: float) -> list[_Part]:
    at = _positions(skeleton)
    hips = 0.5 * (at["leftUpperLeg"] + at["rightUpperLeg"])
    parts: list[_Part] = [("pelvis", "hips", *_lateral(hips, _PELVIS[1] * size), _PELVIS[0])]
    for name, bone, end, radius in (("Thigh", "UpperLeg", "LowerLeg", _THIGH), ("Shin", "LowerLeg", "Foot", _SHIN)):
        for side in ("left", "right"):
            parts.append((side + name, side + bone, at[side + bone], at[side + end], radius))
    for side in ("left", "right"):
        ankle = at[f"{side}Foot"]
        sole = np.array([ankle[0], _FOOT * size, ankle[2]])
        heel = sole - np.array([0.0, 0.0, (_HEEL - _FOOT) * size])
        toe = sole + np.array([0.0, 0.0, (_TOE - _FOOT) * size])
        parts.append((f"{side}Foot", f"{side}Foot", heel, toe, _FOOT))
    return parts


def _trunk_parts(skeleton: Skeleton, size: float) -> list[_Part]:
    at = _positions(skeleton)
    low = 0.5 * (at["leftUpperLeg"] + at["rightUpperLeg"])
    high = 0.5 * (at["leftUpperArm"] + at["rightUpperArm"])
    top = last_spine(skeleton)
    middle = next(bone for bone in ("chest", "spine") if skeleton.has(bone))
    reach = max(0.5 * float(at["leftUpperArm"][0] - at["rightUpperArm"][0]), 1e-3)
    parts: list[_Part] = []
    for name, bone, height, (radius, half) in (
        ("abdomen", "spine", 0.30, _ABDOMEN),
        ("torso", middle, 0.62, _TORSO),
        ("chest", top, 0.87, _CHEST),
    ):
        centre = low + height * (high - low)
        parts.append((name, bone, *_lateral(centre, min(half * size, 0.7 * reach)), radius))
    # The shoulder joints go where the trunk takes them, so what they touch is for the waist to avoid.
    parts.append(("shoulders", top, at["leftUpperArm"], at["rightUpperArm"], _UPPER_ARM))
    neck = "neck" if skeleton.has("neck") else top
    root = at["neck"] if skeleton.has("neck") else 0.5 * (high + at["head"])
    crown = at["head"] + size * np.array([0.0, 1.0 - _HEAD_HEIGHT - _HEAD, 0.012])
    chin = at["head"] + size * np.array([0.0, 0.030, 0.012])
    parts.append(("neck", neck, root, at["head"], _NECK))
    parts.append(("head", "head", chin, crown, _HEAD))
    return parts


def _arm_parts(skeleton: Skeleton, size: float) -> list[_Part]:
    at = _positions(skeleton)
    parts: list[_Part] = []
    for side in ("left", "right"):
        shoulder, elbow, wrist = (at[f"{side}{bone}"] for bone in ("UpperArm", "LowerArm", "Hand"))
        along = (wrist - elbow) / max(float(np.linalg.norm(wrist - elbow)), 1e-9)
        tips = wrist + (_HAND_LENGTH - _HAND) * size * along
        parts.append((f"{side}UpperArm", f"{side}UpperArm", shoulder, elbow, _UPPER_ARM))
        parts.append((f"{side}Forearm", f"{side}LowerArm", elbow, wrist, _FOREARM))
        parts.append((f"{side}Hand", f"{side}Hand", wrist, tips, _HAND))
    return parts


def _positions(skeleton: Skeleton) -> dict[str, Floats]:
    return dict(zip(skeleton.names, skeleton.positions, strict=True))
