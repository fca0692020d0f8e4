"""Which node is which bone: tables of names first, then words, then the shape of the tree, then the user's word."""

from collections.abc import Mapping
from dataclasses import dataclass

from elbowroom.body.bone_mapping.conventions import CONVENTIONS, Convention, plain, spellings, spine_names
from elbowroom.body.bone_mapping.file_nodes import FileNodes
from elbowroom.body.bone_mapping.spelling import bones_by_spelling
from elbowroom.body.bone_mapping.spine import spine_bones
from elbowroom.body.bone_mapping.topology import bones_by_topology, outer_end
from elbowroom.body.bones import PARENTS, REQUIRED

TOPOLOGY, SPELLING, OVERRIDE = "topology", "spelling", "override"

# What a table of names must tell to be taken at its word; hands, feet and spine can be found from these.
_CORE = frozenset(bone for bone in REQUIRED if not bone.endswith(("Hand", "Foot"))) - {"spine"}
_ENDS = {"Hand": "LowerArm", "Foot": "LowerLeg"}


@dataclass(frozen=True)
class BoneMapping:
    """The bones of a humanoid among a file's nodes."""

    nodes: dict[str, int]  # VRM 1.0 bone name -> node, parents first
    how: dict[str, str]  # bone -> the table of names ("Mixamo", ...), "spelling", "topology" or "override"

    @property
    def missing(self) -> tuple[str, ...]:
        """The required bones that were not found."""
        return tuple(sorted(REQUIRED - self.nodes.keys()))


def map_bones(nodes: FileNodes, override: Mapping[str, int | None] | None = None) -> BoneMapping:
    """Find the bones of a humanoid; those that cannot be found are left out.

    `override` (bone -> node, or None for "has none") has the last word.
    """
    bones, how = _named(nodes)
    if not bones.keys() >= _CORE:
        for bone, node in bones_by_topology(nodes).items():
            if bone not in bones and node not in bones.values():
                bones[bone], how[bone] = node, TOPOLOGY
    _find_ends(nodes, bones, how)
    for bone, chosen in (override or {}).items():
        bones = {other: node for other, node in bones.items() if other != bone and node != chosen}
        if chosen is not None:
            bones[bone], how[bone] = chosen, OVERRIDE
    ordered = {bone: bones[bone] for bone in PARENTS if bone in bones}
    return BoneMapping(ordered, {bone: how[bone] for bone in ordered})


def _named(nodes: FileNodes) -> tuple[dict[str, int], dict[str, str]]:
    """What the names say, and by which table; the words of a name fill what its table does not know."""
    found: dict[str, int] = {}
    for node in sorted(nodes.order, key=lambda node: (node not in nodes.joints, nodes.names[node].startswith("_"))):
        found.setdefault(plain(nodes.names[node]), node)
    tables = [(_by_table(convention, found), convention) for convention in CONVENTIONS]
    bones, convention = max(tables, key=lambda table: (len(table[0].keys() & REQUIRED), len(table[0])))
    source, named = convention.name, frozenset(found[name] for name in spine_names(convention) if name in found)
    if not bones.keys() >= _CORE:
        bones, named = {}, frozenset()
    how = dict.fromkeys(bones, source)
    for bone, node in bones_by_spelling(nodes).items():
        if bone not in bones and node not in bones.values() and not (named and node in named):
            bones[bone], how[bone] = node, SPELLING
    if not bones.keys() >= _CORE:
        return bones, how
    for bone, node in spine_bones(nodes, bones, named).items():
        bones[bone], how[bone] = node, source if node in named else SPELLING
    return bones, how


def _by_table(convention: Convention, found: Mapping[str, int]) -> dict[str, int]:
    bones: dict[str, int] = {}
    for bone, names in spellings(convention).items():
        free = [found[name] for name in names if name in found and found[name] not in bones.values()]
        if free:
            bones[bone] = free[0]
    return bones


def _find_ends(nodes: FileNodes, bones: dict[str, int], how: dict[str, str]) -> None:
    """Hands and feet beyond the forearms and shins, and the spine between hips and head, where no name told them."""
    for side in ("left", "right"):
        for end, limb in _ENDS.items():
            if side + end in bones or side + limb not in bones:
                continue
            node = outer_end(nodes, bones[side + limb])
            if node >= 0 and node not in bones.values():
                bones[side + end], how[side + end] = node, TOPOLOGY
    if "spine" not in bones:
        for bone, node in spine_bones(nodes, bones, frozenset()).items():
            bones[bone], how[bone] = node, TOPOLOGY
