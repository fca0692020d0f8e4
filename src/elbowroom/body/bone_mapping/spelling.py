"""Which node is which bone, by the words of its name, for names that no table has.

A name is taken apart into words (at separators, capitals and digits), the word for the side is set aside, and the rest
is looked up: `mixamorig:LeftForeArm`, `lowerarm_l`, `J_Bip_L_LowerArm` and `DEF-forearm.L` all name the left lower arm.
"""

import re

from elbowroom.body.bone_mapping.conventions import FINGER, THUMB
from elbowroom.body.bone_mapping.file_nodes import FileNodes

_SIDES = {"l": "left", "left": "left", "r": "right", "right": "right"}
_PREFIXES = {"mixamorig", "armature", "bip", "biped", "j", "c", "def", "character", "valve", "valvebiped", "cc", "base"}

_NO_NEWS = {"bind", "jnt", "joint", "jt", "bone", "bn", "skin", "deform"}  # words that say only that it is a joint
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


def _spellings() -> dict[str, tuple[str, ...]]:
    table: dict[str, tuple[str, ...]] = dict(_MIDDLE)
    for side in ("left", "right"):
        table |= {side + bone: tuple(f"{side} {word}" for word in words) for bone, words in _LIMBS.items()}
        for finger, words in _FINGERS.items():
            for number, phalanx in enumerate(THUMB if finger == "Thumb" else FINGER, start=1):
                numbered = [f"{word}{number}" for word in words] + [f"hand{word}{number}" for word in words]
                named = [f"{word}{phalanx.lower()}" for word in words]
                table[f"{side}{finger}{phalanx}"] = tuple(f"{side} {word}" for word in numbered + named)
    return table


_SPELLINGS = _spellings()


_NO_BODY = re.compile(
    r"(ik|fk|pole|ctrl|control|target|twist|roll|helper|slot|handslot|socket|weapon|prop|hair|skirt|cape|tail|cloth|ribbon|"
    r"breast|bust|end|leaf|nub|tip|mch|vis)\d*"
)


def words_of(name: str) -> list[str]:
    """The words of a node's name in lower case, parted at separators, capitals and digits."""
    last = re.split(r"[:|]", name)[-1]
    return [word.lower() for word in re.findall(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+", last)]


def side_of(name: str) -> str:
    """ "left", "right", or "" where the name has no word for a side."""
    return next((_SIDES[word] for word in words_of(name) if word in _SIDES), "")


def names_no_body(name: str) -> bool:
    """Whether the name says that the node controls or adorns the body: IK targets, twist helpers, hair, weapons."""
    return any(_NO_BODY.fullmatch(word) for word in words_of(name))


def simplified(name: str) -> str:
    """A node's name reduced to side and words: "mixamorig1:LeftHandThumb1" becomes "left handthumb1"."""
    words = words_of(name)
    while len(words) > 1 and (words[0] in _PREFIXES or (words[0].isdigit())):
        words = words[1:]
    sides = [word for word in words if word in _SIDES]
    rest = [str(int(word)) if word.isdigit() and len(word) < 4 else word for word in words if word not in _SIDES]
    telling = [word for word in rest if word not in _NO_NEWS and not (word.isdigit() and word.startswith("0"))]
    if any(word.isalpha() for word in telling):
        rest = telling
    return " ".join([_SIDES[word] for word in sides[:1]] + ["".join(rest)])


def bones_by_spelling(nodes: FileNodes) -> dict[str, int]:
    """Bone -> node without the spine; where a name occurs twice, joints of skins go first."""
    found: dict[str, int] = {}
    for node in sorted(nodes.order, key=lambda node: node not in nodes.joints):
        found.setdefault(simplified(nodes.names[node]), node)
    bones: dict[str, int] = {}
    for bone, spellings in _SPELLINGS.items():
        known = [found[spelling] for spelling in spellings if spelling in found]
        if known and known[0] not in bones.values():
            bones[bone] = known[0]
    return bones
