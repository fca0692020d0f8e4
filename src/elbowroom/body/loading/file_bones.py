"""The bones of a glTF or VRM file: as it names them, as they are found, or as the user says; repaired where need be."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from elbowroom.body.bone_mapping.file_nodes import FileNodes
from elbowroom.body.bone_mapping.mapping import OVERRIDE, map_bones
from elbowroom.body.bone_mapping.override import override_nodes
from elbowroom.body.bone_mapping.structure import checked_bones
from elbowroom.body.bones import PARENTS
from elbowroom.body.humanoid import BoneSource
from elbowroom.body.loading.rig_repair import repaired
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf
from elbowroom.formats.nodes import NodeTree, read_nodes
from elbowroom.formats.skins import skin_joints
from elbowroom.formats.vrm import Vrm

if TYPE_CHECKING:  # its readers are for those that have such a file
    from elbowroom.body.loading.hanim_names import NamedBones

ADDED = "added"


@dataclass(frozen=True, eq=False)
class FileBones:
    """A file whose bones are known and hang as they must."""

    gltf: Gltf
    tree: NodeTree
    nodes: dict[str, int]  # bone -> node, canonical order
    sources: tuple[BoneSource, ...]  # in the same order
    notes: tuple[str, ...]
    told: dict[str, int | None]  # by the user


def file_bones(
    gltf: Gltf, tree: NodeTree, vrm: Vrm | None, override: Field | None, hanim: "NamedBones | None" = None
) -> FileBones:
    """Find, check and repair; `hanim` are the bones that an H-Anim file names. Raises `InputError`."""
    nodes = file_nodes(gltf, tree)
    chosen = {} if override is None else override_nodes(override, nodes)
    if hanim is not None and hanim.is_humanoid:
        found = {bone: node for bone, node in hanim.nodes.items() if bone not in chosen}
        found |= {bone: node for bone, node in chosen.items() if node is not None}
        how = {bone: OVERRIDE if bone in chosen else hanim.found_by[bone] for bone in found}
    elif vrm is None:
        mapping = map_bones(nodes, chosen)
        found, how = mapping.nodes, mapping.how
    else:
        found = {bone: node for bone, node in vrm.bones.items() if bone not in chosen}
        found |= {bone: node for bone, node in chosen.items() if node is not None}
        how = {bone: OVERRIDE if bone in chosen else vrm.version for bone in found}
    checked = checked_bones(found, nodes, gltf.name, strict=vrm is not None)
    mended, carried, notes = repaired(gltf, tree, checked)
    if mended is not gltf:
        tree = read_nodes(mended)
    sources = tuple(
        BoneSource(bone, carried[bone], tree.names[carried[bone]], how.get(bone, ADDED))
        for bone in PARENTS
        if bone in carried
    )
    return FileBones(
        mended, tree, {source.bone: source.node for source in sources}, sources, checked.notes + notes, chosen
    )


def file_nodes(gltf: Gltf, tree: NodeTree) -> FileNodes:
    """What a mapping looks at, of a glTF file."""
    places = tree.world_matrices(tree.rotations)[:, :3, 3]
    with np.errstate(all="ignore"):
        finite = np.nan_to_num(np.clip(places, -1e9, 1e9))
    return FileNodes(tree.names, tree.parents, finite, frozenset(skin_joints(gltf, tree)))
