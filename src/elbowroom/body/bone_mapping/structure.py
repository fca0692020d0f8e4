"""Whether the bones that were found hang on one another as they must."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from elbowroom.body.bone_mapping.file_nodes import FileNodes
from elbowroom.body.bones import PARENTS, REQUIRED
from elbowroom.errors import InputError

_ARMS = ("leftShoulder", "rightShoulder", "leftUpperArm", "rightUpperArm")
_FEWEST = len(REQUIRED) - 4  # nodes; hands and feet can be added
_ENDS = ("leftHand", "rightHand", "leftFoot", "rightFoot")


@dataclass(frozen=True)
class CheckedBones:
    """Bones in canonical order, parents first."""

    nodes: dict[str, int]
    notes: tuple[str, ...] = ()  # on optional bones left out because they hang elsewhere
    detached: dict[str, int] = field(default_factory=dict)  # arm or spine beside or above its place -> node to hang on
    absent: tuple[str, ...] = ()  # hands and feet that the file has no node for


def checked_bones(
    bones: Mapping[str, int], nodes: FileNodes, place: str, strict: bool, whole: bool = False
) -> CheckedBones:
    """The bones checked against the tree; what a VRM file says is taken `strict`, without arms to be hung elsewhere.

    `whole`: hands and feet must be there too, since nothing can be added to the file.

    Raises `InputError` if a required bone is missing or does not hang below the bone that should carry it.
    """
    missing = sorted(REQUIRED - bones.keys() - (frozenset() if strict or whole else frozenset(_ENDS)))
    if missing and not strict and len(nodes) < _FEWEST:
        count = f"{len(nodes)} nodes" if len(nodes) > 1 else "one node"
        raise InputError(
            f"{place}: there is no skeleton of a humanoid in it, only {count}: a humanoid has {_FEWEST} bones"
        )
    if missing:
        raise InputError(f"{place}: no node was found for the bones {', '.join(missing)}{_mend(place, strict)}")
    kept: dict[str, int] = {}
    notes, detached = [], {}
    for bone in PARENTS:
        if bone not in bones:
            continue
        parent = parent_bone(bone, kept)
        above = nodes.ancestors(bones[bone])
        if parent is None or kept[parent] in above:
            kept[bone] = bones[bone]
        elif bone == "spine" and not strict and bones[bone] in nodes.ancestors(kept["hips"]):
            kept[bone], detached[bone] = bones[bone], kept["hips"]
        elif bone in _ARMS and not strict and bones[bone] not in nodes.ancestors(kept[parent]):
            kept[bone], detached[bone] = bones[bone], kept[parent]
        elif bone in REQUIRED:
            told = nodes.names[bones[bone]], nodes.names[kept[parent]]
            raise InputError(
                f"{place}: the node of {bone} ({told[0]}) must hang below the node of {parent} ({told[1]}), "
                f"but does not{_mend(place, strict)}"
            )
        else:
            notes.append(f"{bone} was left out: it does not hang below {parent}")
    absent = tuple(bone for bone in _ENDS if bone not in kept)
    return CheckedBones(kept, tuple(notes), detached, absent)


def parent_bone(bone: str, present: Mapping[str, int]) -> str | None:
    """The nearest ancestor of `bone` that is present; None for the hips."""
    parent = PARENTS[bone]
    while parent is not None and parent not in present:
        parent = PARENTS[parent]
    return parent


def _mend(place: str, strict: bool) -> str:
    return "" if strict else f": name their nodes in {place}.bones.json (docs/avatars.md)"
