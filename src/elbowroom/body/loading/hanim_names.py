"""Which H-Anim joint is which bone: the names of H-Anim 1.0, 1.1 and 2.0 at any level of articulation, and robots'.

A joint is known by its `name`, else by the end of its DEF name: `hanim_l_elbow`, `Joe_l_elbow` and `l_elbow` are one.
Sources: ISO/IEC 19774-1:2019, tables of LOA 0 to 4; H-Anim 1.1, appendix A; joint names of OpenHRP's sample robots.
"""

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from elbowroom.body.bones import SPINE
from elbowroom.formats.hanim.figure import Joint
from elbowroom.formats.nodes import NodeTree

BY_NAME, BY_DEF, ROBOT = "H-Anim name", "H-Anim DEF name", "robot names"

_MIDDLE = {
    "hips": ("humanoid_root", "humanoidroot"),
    "neck": ("vc7", "vc4", "vc5", "vc6", "vc3", "vc2", "vc1"),
    "head": ("skullbase",),
    "jaw": ("temporomandibular",),
}
_LIMBS = {
    "Shoulder": ("sternoclavicular", "acromioclavicular"),
    "UpperArm": ("shoulder",),
    "LowerArm": ("elbow",),
    "Hand": ("radiocarpal", "wrist"),
    "UpperLeg": ("hip",),
    "LowerLeg": ("knee",),
    "Foot": ("talocrural", "ankle"),
    "Toes": ("metatarsophalangeal", "metatarsophalangeal_2", "metatarsophalangeal_1", "metatarsal", "midtarsal"),
    "Eye": ("eyeball_joint", "eyeball"),
    "ThumbMetacarpal": ("carpometacarpal_1", "thumb1"),
    "ThumbProximal": ("metacarpophalangeal_1", "thumb2"),
    "ThumbDistal": ("carpal_interphalangeal_1", "thumb3"),
}
for _number, _finger in enumerate(("Index", "Middle", "Ring", "Little"), start=2):
    _old = {"Little": "pinky"}.get(_finger, _finger.lower())
    _LIMBS[f"{_finger}Proximal"] = (f"metacarpophalangeal_{_number}", f"{_old}1")
    _LIMBS[f"{_finger}Intermediate"] = (f"carpal_proximal_interphalangeal_{_number}", f"{_old}2")
    _LIMBS[f"{_finger}Distal"] = (f"carpal_distal_interphalangeal_{_number}", f"{_old}3")
_VERTEBRAE = ("sacroiliac", *(f"vl{n}" for n in range(5, 0, -1)), *(f"vt{n}" for n in range(12, 0, -1)))

# Robots give each axis its own joint; the first of a group carries the others.
_ROBOT_MIDDLE = {
    "hips": ("waist", "pelvis"),
    "neck": ("neck_p", "neck_y", "neck"),
    "head": ("head_p", "head_y", "head"),
    "spine": ("waist_p", "waist_r", "waist_y"),
    "chest": ("chest", "chest_p", "chest_y"),
}
_ROBOT_LIMBS = {
    "UpperArm": ("arm_shoulder_",),
    "LowerArm": ("arm_elbow",),
    "Hand": ("arm_wrist_",),
    "UpperLeg": ("leg_hip_",),
    "LowerLeg": ("leg_knee",),
    "Foot": ("leg_ankle_",),
}
_WORDS = re.compile(r"[a-z0-9]+(?:_[a-z0-9]+)*")


def _spellings() -> dict[str, str]:
    """Joint name -> bone or vertebra, for every name of the standard."""
    table = {word: bone for bone, words in _MIDDLE.items() for word in words}
    table |= {word: word for word in _VERTEBRAE}
    for side, letter in (("left", "l"), ("right", "r")):
        table |= {f"{letter}_{word}": side + bone for bone, words in _LIMBS.items() for word in words}
    return table


_BONE_OF = _spellings()
_BACK = {"spine": "vl5", "chest": "vt12", "upperChest": "vt4"}  # vertebrae that a figure of ours turns at
_PRIORITY = {word: rank for words in [*_MIDDLE.values(), *_LIMBS.values()] for rank, word in enumerate(words)}


def hanim_name(bone: str) -> str:
    """The joint of H-Anim 2.0 that a bone is written as."""
    if bone in _BACK:
        return _BACK[bone]
    if bone in _MIDDLE:
        return _MIDDLE[bone][0]
    side = "left" if bone.startswith("left") else "right"
    return f"{side[0]}_{_LIMBS[bone.removeprefix(side)][0]}"


@dataclass(frozen=True)
class NamedBones:
    """Bones that were told by their joints' names, and how."""

    nodes: dict[str, int]  # bone -> node
    found_by: dict[str, str]  # bone -> what said so
    standard: bool  # by the names of H-Anim, not by those of robots

    @property
    def is_humanoid(self) -> bool:
        """Whether arms, legs and hips are among them."""
        limbs = {side + bone for side in ("left", "right") for bone in ("UpperArm", "LowerArm", "UpperLeg", "LowerLeg")}
        return {"hips"} | limbs <= self.nodes.keys()


def hanim_bones(joints: Sequence[Joint], tree: NodeTree) -> NamedBones:
    """The bones that the joints of a figure name; robots' names are looked for where those of H-Anim are missing."""
    known = _standard(joints)
    if {"leftUpperArm", "leftUpperLeg"} <= known.keys():
        bones = {bone: joint.node for bone, (joint, _) in known.items() if bone not in _VERTEBRAE}
        told = {bone: how for bone, (_, how) in known.items() if bone not in _VERTEBRAE}
        spine = _spine(known, bones, tree)
        return NamedBones(
            bones | {bone: known[word][0].node for bone, word in spine.items()},
            told | {bone: known[word][1] for bone, word in spine.items()},
            standard=True,
        )
    robot = _robot(joints)
    return NamedBones({b: j.node for b, j in robot.items()}, dict.fromkeys(robot, ROBOT), False)


def _standard(joints: Sequence[Joint]) -> dict[str, tuple[Joint, str]]:
    """Bone or vertebra -> joint and how it was told; better spellings win. A name that two joints have tells little."""
    found: dict[str, tuple[int, Joint, str]] = {}
    names = Counter(joint.name for joint in joints)
    for joint in joints:
        told = [(BY_NAME, joint.name), (BY_DEF, joint.definition)]
        for source, text in told if names[joint.name] == 1 else told[::-1]:
            word = _known_end(text)
            if word is None:
                continue
            bone = _BONE_OF[word]
            rank = _PRIORITY.get(word.removeprefix("l_").removeprefix("r_"), 0)
            if bone not in found or rank < found[bone][0]:
                found[bone] = (rank, joint, source)
            break
    return {bone: (joint, how) for bone, (_, joint, how) in found.items()}


def _known_end(text: str) -> str | None:
    """The longest known joint name at the end of a name, after a separator."""
    words = _WORDS.findall(text.lower().replace("-", "_").replace(".", "_"))
    parts = words[-1].split("_") if words else []
    ends = ("_".join(parts[i:]) for i in range(len(parts)))
    return next((end for end in ends if end in _BONE_OF), None)


def _spine(known: Mapping[str, tuple[Joint, str]], bones: Mapping[str, int], tree: NodeTree) -> dict[str, str]:
    """Up to three of the vertebrae between the hips and what hangs on the trunk: the lowest, the highest, one between.

    A sacroiliac joint counts where it carries the trunk; in most files it carries the legs.
    """
    above = [set(tree.ancestors(bones[bone])) for bone in ("head", "leftUpperArm", "rightUpperArm") if bone in bones]
    shared = set.intersection(*above)
    chain = [word for word in _VERTEBRAE if word in known and known[word][0].node in shared]
    chain.sort(key=lambda word: len(tree.ancestors(known[word][0].node)))
    if len(chain) > 3:
        heights = [float(known[word][0].centre[1]) for word in chain]
        middle = min(chain[1:-1], key=lambda w: abs(known[w][0].centre[1] - 0.5 * (heights[0] + heights[-1])))
        chain = [chain[0], middle, chain[-1]]
    return dict(zip(SPINE, chain, strict=False))


def _robot(joints: Sequence[Joint]) -> dict[str, Joint]:
    named = [(joint.definition or joint.name).lower() for joint in joints]
    found: dict[str, Joint] = {}
    for bone, words in _ROBOT_MIDDLE.items():
        hits = [joint for joint, name in zip(joints, named, strict=True) if name in words]
        if hits:
            found[bone] = hits[0]
    for side, letter in (("left", "l"), ("right", "r")):
        for bone, words in _ROBOT_LIMBS.items():
            starts = tuple(letter + word for word in words)
            hits = [joint for joint, name in zip(joints, named, strict=True) if name.startswith(starts)]
            if hits:
                found[side + bone] = hits[0]
    return found
