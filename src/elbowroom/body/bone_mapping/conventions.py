"""How well-known tools name the bones of a humanoid, as exact tables.

Sources: the rigs as the tools write them (Mixamo, Unreal Engine's mannequin, Rigify, 3ds Max Biped and Valve, Daz
Genesis and Poser, KayKit, MakeHuman, mocap files of the CMU database, Sony mocopi, SMPL) and, for VRM, Unity and
Godot, their documented humanoid profiles.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache

FINGERS = ("Thumb", "Index", "Middle", "Ring", "Little")
THUMB = ("Metacarpal", "Proximal", "Distal")
FINGER = ("Proximal", "Intermediate", "Distal")

_PREFIX = re.compile(r"^(mixamorig\d*|valvebipedbip\d+|bip\d+|character\d+|jbip|def|org)(?=[a-z])")


@dataclass(frozen=True, eq=False)
class Convention:
    """The names of one tool; `{}` is the side, alternatives are parted by `|`, the earlier goes first."""

    name: str
    sides: tuple[str, str]
    middle: Mapping[str, str]  # hips, neck, head, jaw
    spine: str  # from the pelvis up
    limbs: Mapping[str, str]  # bone without its side -> names
    fingers: Mapping[str, str] = field(default_factory=dict)  # finger -> names up to the number
    phalanges: tuple[str, str, str] = ("1", "2", "3")


_TORSO = {"neck": "Neck", "head": "Head", "jaw": "Jaw"}
_JOINTS = {
    "Shoulder": "{}Collar",
    "UpperArm": "{}Shoulder",
    "LowerArm": "{}Elbow",
    "Hand": "{}Wrist",
    "UpperLeg": "{}Hip",
    "LowerLeg": "{}Knee",
    "Foot": "{}Ankle",
}

CONVENTIONS = (
    Convention(
        "VRM, Unity, Godot",
        ("Left", "Right"),
        {"hips": "Hips"} | _TORSO,
        "Spine|Chest|UpperChest",
        {
            "Shoulder": "{}Shoulder",
            "UpperArm": "{}UpperArm",
            "LowerArm": "{}LowerArm",
            "Hand": "{}Hand",
            "UpperLeg": "{}UpperLeg",
            "LowerLeg": "{}LowerLeg",
            "Foot": "{}Foot",
            "Toes": "{}Toes|{}ToeBase",
            "Eye": "{}Eye",
        },
        {finger: "{}" + finger for finger in FINGERS},
        ("Proximal", "Intermediate", "Distal"),
    ),
    Convention(
        "Mixamo",
        ("Left", "Right"),
        {"hips": "Hips"} | _TORSO,
        "LowerBack|Spine|Spine1|Spine2|Spine3",
        {
            "Shoulder": "{}Shoulder",
            "UpperArm": "{}Arm",
            "LowerArm": "{}ForeArm",
            "Hand": "{}Hand",
            "UpperLeg": "{}UpLeg",
            "LowerLeg": "{}Leg",
            "Foot": "{}Foot",
            "Toes": "{}ToeBase",
            "Eye": "{}Eye",
        },
        {finger: "{}Hand" + ("Pinky" if finger == "Little" else finger) for finger in FINGERS},
    ),
    Convention(
        "Unreal",
        ("_l", "_r"),
        {"hips": "pelvis", "neck": "neck_01", "head": "head", "jaw": "jaw"},
        "spine_01|spine_02|spine_03|spine_04|spine_05",
        {
            "Shoulder": "clavicle{}",
            "UpperArm": "upperarm{}",
            "LowerArm": "lowerarm{}",
            "Hand": "hand{}",
            "UpperLeg": "thigh{}",
            "LowerLeg": "calf{}",
            "Foot": "foot{}",
            "Toes": "ball{}",
            "Eye": "eye{}",
        },
        {finger: ("pinky" if finger == "Little" else finger.lower()) for finger in FINGERS},
        ("_01{}", "_02{}", "_03{}"),
    ),
    Convention(
        "Rigify",
        (".L", ".R"),
        {
            "hips": "DEF-hips|DEF-spine",
            "neck": "DEF-neck|DEF-spine.004",
            "head": "DEF-head|DEF-spine.006|DEF-spine.005",
            "jaw": "DEF-jaw",
        },
        "DEF-spine.001|DEF-spine.002|DEF-spine.003",
        {
            "Shoulder": "DEF-shoulder{}",
            "UpperArm": "DEF-upper_arm{}",
            "LowerArm": "DEF-forearm{}",
            "Hand": "DEF-hand{}",
            "UpperLeg": "DEF-thigh{}",
            "LowerLeg": "DEF-shin{}",
            "Foot": "DEF-foot{}",
            "Toes": "DEF-toe{}",
            "Eye": "DEF-eye{}",
        },
        {"Thumb": "DEF-thumb"}
        | {f: "DEF-f_" + ("pinky" if f == "Little" else f.lower()) for f in FINGERS if f != "Thumb"},
        (".01{}", ".02{}", ".03{}"),
    ),
    Convention(
        "Biped",
        ("L ", "R "),
        {"hips": "Bip01 Pelvis", "neck": "Bip01 Neck|Bip01 Neck1", "head": "Bip01 Head|Bip01 Head1"},
        "Bip01 Spine|Bip01 Spine1|Bip01 Spine2|Bip01 Spine3|Bip01 Spine4",
        {
            "Shoulder": "Bip01 {}Clavicle",
            "UpperArm": "Bip01 {}UpperArm",
            "LowerArm": "Bip01 {}Forearm",
            "Hand": "Bip01 {}Hand",
            "UpperLeg": "Bip01 {}Thigh",
            "LowerLeg": "Bip01 {}Calf",
            "Foot": "Bip01 {}Foot",
            "Toes": "Bip01 {}Toe0",
        },
        {finger: f"Bip01 {{}}Finger{number}" for number, finger in enumerate(FINGERS)},
        ("", "1", "2"),
    ),
    Convention(
        "Daz, Poser",
        ("l", "r"),
        {"hips": "hip", "neck": "neckLower|neck1|neck", "head": "head", "jaw": "lowerJaw"},
        "abdomenLower|abdomen|abdomen2|abdomenUpper|spine1|spine2|spine3|spine4|chestLower|chest|chestUpper",
        {
            "Shoulder": "{}Collar|{}_shoulder",
            "UpperArm": "{}ShldrBend|{}Shldr|{}_upperarm",
            "LowerArm": "{}ForearmBend|{}ForeArm|{}_forearm",
            "Hand": "{}Hand",
            "UpperLeg": "{}ThighBend|{}Thigh",
            "LowerLeg": "{}Shin",
            "Foot": "{}Foot",
            "Toes": "{}Toe|{}Toes",
            "Eye": "{}Eye|{}eftEye|{}ightEye",
        },
        {"Thumb": "{}Thumb", "Index": "{}Index", "Middle": "{}Mid", "Ring": "{}Ring", "Little": "{}Pinky"},
    ),
    Convention(
        "KayKit",
        (".l", ".r"),
        {"hips": "hips", "head": "head"},
        "spine|chest",
        {
            "UpperArm": "upperarm{}",
            "LowerArm": "lowerarm{}",
            "Hand": "wrist{}",
            "UpperLeg": "upperleg{}",
            "LowerLeg": "lowerleg{}",
            "Foot": "foot{}",
            "Toes": "toes{}",
        },
    ),
    Convention(
        "MakeHuman",
        (".L", ".R"),
        {"hips": "root", "neck": "neck01|Neck", "head": "head", "jaw": "jaw"},
        "spine05|spine04|spine03|spine02|spine01|Spine1|Spine2|Spine3",
        {
            "Shoulder": "clavicle{}",
            "UpperArm": "upperarm01{}|UpArm{}",
            "LowerArm": "lowerarm01{}|LoArm{}",
            "Hand": "wrist{}|Hand{}",
            "UpperLeg": "upperleg01{}|UpLeg{}",
            "LowerLeg": "lowerleg01{}|LoLeg{}",
            "Foot": "foot{}",
            "Toes": "toe1-1{}|Toe{}",
            "Eye": "eye{}",
        },
        {finger: f"finger{number}-" for number, finger in enumerate(FINGERS, start=1)},
        ("1{}", "2{}", "3{}"),
    ),
    Convention(
        "mocap joints (CMU, Cgspeed)",
        ("Left", "Right"),
        {"hips": "Hips"} | _TORSO,
        "Chest|Chest2|Chest3|Chest4|CS_BVH",
        _JOINTS | {"Toes": "{}Toe"},
    ),
    Convention(
        "mocopi",
        ("l_", "r_"),
        {"hips": "root", "neck": "neck_1", "head": "head"},
        "torso_1|torso_2|torso_3|torso_4|torso_5|torso_6|torso_7",
        {
            "Shoulder": "{}shoulder",
            "UpperArm": "{}up_arm",
            "LowerArm": "{}low_arm",
            "Hand": "{}hand",
            "UpperLeg": "{}up_leg",
            "LowerLeg": "{}low_leg",
            "Foot": "{}foot",
            "Toes": "{}toes",
        },
    ),
    Convention(
        "SMPL",
        ("L_", "R_"),
        {"hips": "Pelvis"} | _TORSO,
        "Spine1|Spine2|Spine3",
        _JOINTS | {"Toes": "{}Foot"},
    ),
    Convention(
        "VRoid",
        ("L_", "R_"),
        {"hips": "J_Bip_C_Hips", "neck": "J_Bip_C_Neck", "head": "J_Bip_C_Head"},
        "J_Bip_C_Spine|J_Bip_C_Chest|J_Bip_C_UpperChest",
        {
            "Shoulder": "J_Bip_{}Shoulder",
            "UpperArm": "J_Bip_{}UpperArm",
            "LowerArm": "J_Bip_{}LowerArm",
            "Hand": "J_Bip_{}Hand",
            "UpperLeg": "J_Bip_{}UpperLeg",
            "LowerLeg": "J_Bip_{}LowerLeg",
            "Foot": "J_Bip_{}Foot",
            "Toes": "J_Bip_{}ToeBase",
        },
        {finger: "J_Bip_{}" + finger for finger in FINGERS},
    ),
)


def plain(name: str) -> str:
    """A name without namespace (`Armature|`, `mixamorig:`), prefix, capitals and separators."""
    last = re.split(r"[:|]", name)[-1].lower()
    return _PREFIX.sub("", re.sub(r"[^a-z0-9]", "", last))


@cache
def spellings(convention: Convention) -> dict[str, tuple[str, ...]]:
    """Bone -> its plain names; the spine bones are left out, since any number of nodes may share them."""
    table = {bone: _plain_all(names, "") for bone, names in convention.middle.items()}
    for side, token in zip(("left", "right"), convention.sides, strict=True):
        table |= {side + bone: _plain_all(names, token) for bone, names in convention.limbs.items()}
        for finger, stem in convention.fingers.items():
            phalanges = THUMB if finger == "Thumb" else FINGER
            for bone, number in zip(phalanges, convention.phalanges, strict=True):
                own = bone if convention.phalanges == FINGER else number
                names = _plain_all(stem + own, token) + _plain_all(stem + number, token)
                table[f"{side}{finger}{bone}"] = names
    return table


@cache
def spine_names(convention: Convention) -> frozenset[str]:
    """The plain names of its spine."""
    return frozenset(_plain_all(convention.spine, ""))


def _plain_all(names: str, side: str) -> tuple[str, ...]:
    return tuple(plain(name.replace("{}", side)) for name in names.split("|"))
