"""The VRM 1.0 humanoid bone names: the names of joints everywhere inside.

Source: VRM 1.0 specification, `VRMC_vrm` humanoid (github.com/vrm-c/vrm-specification).
"""

_FINGERS = {
    "Thumb": ("Metacarpal", "Proximal", "Distal"),
    "Index": ("Proximal", "Intermediate", "Distal"),
    "Middle": ("Proximal", "Intermediate", "Distal"),
    "Ring": ("Proximal", "Intermediate", "Distal"),
    "Little": ("Proximal", "Intermediate", "Distal"),
}


def _side(side: str) -> dict[str, str]:
    limb = {
        f"{side}Shoulder": "upperChest",
        f"{side}UpperArm": f"{side}Shoulder",
        f"{side}LowerArm": f"{side}UpperArm",
        f"{side}Hand": f"{side}LowerArm",
        f"{side}UpperLeg": "hips",
        f"{side}LowerLeg": f"{side}UpperLeg",
        f"{side}Foot": f"{side}LowerLeg",
        f"{side}Toes": f"{side}Foot",
        f"{side}Eye": "head",
    }
    for finger, phalanges in _FINGERS.items():
        parent = f"{side}Hand"
        for phalanx in phalanges:
            limb[f"{side}{finger}{phalanx}"] = parent
            parent = f"{side}{finger}{phalanx}"
    return limb


# Every bone and its parent; where the parent is absent in an avatar, the nearest present ancestor takes its place.
PARENTS: dict[str, str | None] = {
    "hips": None,
    "spine": "hips",
    "chest": "spine",
    "upperChest": "chest",
    "neck": "upperChest",
    "head": "neck",
    "jaw": "head",
    **_side("left"),
    **_side("right"),
}

REQUIRED: frozenset[str] = frozenset(
    ["hips", "spine", "head"]
    + [
        side + bone
        for side in ("left", "right")
        for bone in ("UpperLeg", "LowerLeg", "Foot", "UpperArm", "LowerArm", "Hand")
    ]
)

SPINE: tuple[str, ...] = ("spine", "chest", "upperChest")
