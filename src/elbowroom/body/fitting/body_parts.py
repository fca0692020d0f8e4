"""The parts of a body, each with its own points: what the bones of a hand move is the hand, toes belong to the foot."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.capsules import Capsules
from elbowroom.body.dof import DofGroup
from elbowroom.body.fitting.proportions import last_spine
from elbowroom.body.skeleton import Skeleton

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

SIDES = ("left", "right")
PELVIS = "pelvis"
TRUNK = ("abdomen", "torso", "chest")
_LIMB_PARTS = {
    "UpperLeg": "Thigh",
    "LowerLeg": "Shin",
    "Foot": "Foot",
    "Toes": "Foot",
    "UpperArm": "UpperArm",
    "LowerArm": "Forearm",
    "Hand": "Hand",
}
_FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
_HEAD = {"neck": "neck", "head": "head", "jaw": "head", "leftEye": "head", "rightEye": "head"}


@dataclass(frozen=True, eq=False)
class BodyPoints:
    """The surface of an avatar, each point with the joint that moves it."""

    positions: Floats  # (P, 3) metres, in the skeleton's frame
    joints: Ints  # (P,) index of the joint

    def scaled(self, factor: float) -> "BodyPoints":
        """The points of an avatar so many times as large."""
        return BodyPoints(factor * self.positions, self.joints)


def part_of_points(skeleton: Skeleton, capsules: Capsules, points: BodyPoints) -> Ints:
    """The capsule (P,) that each point belongs to, -1 for none: fingers to the hand, toes to the foot, jaw to the head.

    Where one spine bone carries several capsules of the trunk, its points are shared out by height.
    """
    names = {name: index for index, name in enumerate(capsules.names)}
    of_joint = np.array([names.get(_part_name(bone), -1) for bone in skeleton.names], dtype=np.int64)
    parts = of_joint[points.joints]
    shoulders = [skeleton.names.index(f"{s}Shoulder") for s in SIDES if skeleton.has(f"{s}Shoulder")]
    top = skeleton.index(last_spine(skeleton))
    bearer = np.where(np.isin(points.joints, shoulders), top, points.joints)
    trunk = [names[name] for name in TRUNK if name in names]
    for joint in {int(capsules.joints[part]) for part in trunk}:
        own = [part for part in trunk if capsules.joints[part] == joint]
        heights = 0.5 * (capsules.starts + capsules.ends)[own, 1] + skeleton.positions[joint, 1]
        borders = 0.5 * (heights[1:] + heights[:-1])
        mine = bearer == joint
        parts[mine] = np.array(own)[np.searchsorted(borders, points.positions[mine, 1])]
    return parts


def leans_on(capsules: Capsules, part: int) -> tuple[str, ...]:
    """The parts that may hold what belongs to a part, since they move alike in the poses a fit knows: those of legs.

    The pelvis leans on the waist too. Other parts lean on none.
    """
    if capsules.groups[part] is not DofGroup.ROOT:
        return ()
    legs = tuple(capsules.names[leg] for leg in capsules.of(DofGroup.ROOT))
    return (*legs, TRUNK[0]) if capsules.names[part] == PELVIS else legs


def _part_name(bone: str) -> str:
    side = next((side for side in SIDES if bone.startswith(side)), "")
    rest = bone.removeprefix(side)
    if bone == "hips":
        return PELVIS
    if rest.startswith(_FINGERS):
        return f"{side}Hand"
    return _HEAD.get(bone, side + _LIMB_PARTS.get(rest, ""))
