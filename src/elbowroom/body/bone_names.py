"""Which node is which bone, by name: Mixamo, Unreal, VRM, and names that differ from them only in their spelling.

A name is taken apart into words (at separators, capitals and digits), the word for the side is set aside, and the rest
is looked up: `mixamorig:LeftForeArm`, `lowerarm_l`, `J_Bip_L_LowerArm` and `DEF-forearm.L` all name the left lower arm.
"""

import re
from collections.abc import Iterable, Mapping

from elbowroom.body.bones import PARENTS, REQUIRED, SPINE
from elbowroom.errors import InputError
from elbowroom.formats.nodes import NodeTree

_SIDES = {"l": "left", "left": "left", "r": "right", "right": "right"}
_PREFIXES = {"mixamorig", "armature", "bip", "biped", "j", "c", "def", "character", "valve", "valvebiped", "cc", "base"}

# The rest of a name without side, prefix and separators -> bone. Earlier spellings win over later ones.
_MIDDLE = {
    "hips": ("hips", "pelvis", "hip"),
    "neck": ("neck", "neck1"),
    "head": ("head",),
    "jaw": ("jaw",),
}
_LIMBS = {
    "Shoulder": ("clavicle", "shoulder", "collar", "collarbone"),
    "UpperArm": ("upperarm", "uparm", "arm", "armupper"),
    "LowerArm": ("lowerarm", "forearm", "lowarm", "elbow", "armlower"),
    "Hand": ("wrist", "hand"),
    "UpperLeg": ("upperleg", "upleg", "thigh", "legupper"),
    "LowerLeg": ("lowerleg", "lowleg", "calf", "shin", "knee", "leglower", "leg"),
    "Foot": ("foot", "ankle"),
    "Toes": ("toes", "toebase", "toe", "ball"),
    "Eye": ("eye",),
}
_FINGERS = {"Thumb": ("thumb",), "Index": ("index",), "Middle": ("middle", "mid"), "Ring": ("ring",)}
_FINGERS["Little"] = ("little", "pinky", "pinkie")
_THUMB = ("Metacarpal", "Proximal", "Distal")
_FINGER = ("Proximal", "Intermediate", "Distal")


def _spellings() -> dict[str, tuple[str, ...]]:
    table: dict[str, tuple[str, ...]] = dict(_MIDDLE)
    for side in ("left", "right"):
        table |= {side + bone: tuple(f"{side} {word}" for word in words) for bone, words in _LIMBS.items()}
        for finger, words in _FINGERS.items():
            for number, phalanx in enumerate(_THUMB if finger == "Thumb" else _FINGER, start=1):
                numbered = [f"{word}{number}" for word in words] + [f"hand{word}{number}" for word in words]
                named = [f"{word}{phalanx.lower()}" for word in words]
                table[f"{side}{finger}{phalanx}"] = tuple(f"{side} {word}" for word in numbered + named)
    return table


_SPELLINGS = _spellings()
_SPINE_WORD = re.compile(r"(spine|chest|upperchest|torso|abdomen|waist)\d*")


def simplified(name: str) -> str:
    """A node's name reduced to side and words: "mixamorig1:LeftHandThumb1" becomes "left handthumb1"."""
    last = re.split(r"[:|]", name)[-1]
    words = [word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", last)]
    while len(words) > 1 and (words[0] in _PREFIXES or (words[0].isdigit())):
        words = words[1:]
    sides = [word for word in words if word in _SIDES]
    rest = [str(int(word)) if word.isdigit() and len(word) < 4 else word for word in words if word not in _SIDES]
    return " ".join([_SIDES[word] for word in sides[:1]] + ["".join(rest)])


def bones_by_name(tree: NodeTree, joints: Iterable[int]) -> dict[str, int]:
    """Bone -> node for all bones that can be told by name; where a name occurs twice, skin `joints` go first."""
    skinned = set(joints)
    found: dict[str, int] = {}
    for node in sorted((int(n) for n in tree.order), key=lambda node: node not in skinned):
        found.setdefault(simplified(tree.names[node]), node)
    bones: dict[str, int] = {}
    for bone, spellings in _SPELLINGS.items():
        known = [found[spelling] for spelling in spellings if spelling in found]
        if known and known[0] not in bones.values():
            bones[bone] = known[0]
    return bones | _spine_bones(tree, bones)


def _spine_bones(tree: NodeTree, bones: Mapping[str, int]) -> dict[str, int]:
    """The nodes named like a spine between the hips and the neck or head, spread over the three spine bones of VRM."""
    top = bones.get("neck", bones.get("head"))
    if top is None or "hips" not in bones:
        return {}
    above = tree.ancestors(top)
    if bones["hips"] not in above:
        return {}
    chain = above[: above.index(bones["hips"])][::-1]
    spine = [node for node in chain if _SPINE_WORD.fullmatch(simplified(tree.names[node]))]
    if len(spine) > 3:
        spine = [spine[0], spine[len(spine) // 2], spine[-1]]
    return dict(zip(SPINE, spine, strict=False))


def checked_bones(bones: Mapping[str, int], tree: NodeTree, place: str) -> tuple[dict[str, int], tuple[str, ...]]:
    """The bones in canonical order (parents first), and notes on optional bones left out because they hang elsewhere.

    Raises `InputError` if a required bone is missing or does not hang below the bone that should carry it.
    """
    missing = sorted(REQUIRED - bones.keys())
    if missing:
        raise InputError(f"{place}: no node was found for the bones {', '.join(missing)} (VRM, Mixamo or Unreal names)")
    kept: dict[str, int] = {}
    notes = []
    for bone in PARENTS:
        if bone not in bones:
            continue
        parent = parent_bone(bone, kept)
        if parent is None or kept[parent] in tree.ancestors(bones[bone]):
            kept[bone] = bones[bone]
        elif bone in REQUIRED:
            raise InputError(f"{place}: the node of {bone} must hang below the node of {parent}, but does not")
        else:
            notes.append(f"{bone} was left out: it does not hang below {parent}")
    return kept, tuple(notes)


def parent_bone(bone: str, present: Mapping[str, int]) -> str | None:
    """The nearest ancestor of `bone` that is present; None for the hips."""
    parent = PARENTS[bone]
    while parent is not None and parent not in present:
        parent = PARENTS[parent]
    return parent
