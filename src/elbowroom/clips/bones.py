"""Which node of a motion file is which bone."""

from dataclasses import replace

import numpy as np

from elbowroom.body.bone_mapping.file_nodes import FileNodes
from elbowroom.body.bone_mapping.mapping import map_bones
from elbowroom.body.bone_mapping.override import override_nodes
from elbowroom.body.bone_mapping.structure import CheckedBones, checked_bones
from elbowroom.body.loading.file_bones import file_nodes
from elbowroom.body.loading.rig_repair import repaired
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf
from elbowroom.formats.nodes import NodeTree, read_nodes
from elbowroom.geometry import quaternion

# Where the shape of the tree has to tell the bones it must stand upright; who knows which axis of a BVH file is up.
_STANDS = (quaternion.IDENTITY, quaternion.about_axis(0, -0.5 * np.pi), quaternion.about_axis(2, 0.5 * np.pi))


def tree_bones(tree: NodeTree, place: str, told: Field | None = None) -> dict[str, int]:
    """The bones of a BVH or USD skeleton, parents first; raises `InputError` where one that is needed is missing.

    `told` is what the user says of them, as for avatars (`FILE.bones.json`).
    """
    places = tree.world_matrices(tree.rotations)[:, :3, 3]
    stood = [FileNodes(tree.names, tree.parents, quaternion.rotate(turn, places)) for turn in _STANDS]
    chosen = {} if told is None else override_nodes(told, stood[0])
    nodes, mapping = min(((nodes, map_bones(nodes, chosen)) for nodes in stood), key=lambda pair: len(pair[1].missing))
    return checked_bones(mapping.nodes, nodes, place, strict=False, whole=True).nodes


def gltf_bones(
    gltf: Gltf, tree: NodeTree, named: dict[str, int] | None, told: Field | None = None, *, strict: bool = True
) -> tuple[NodeTree, dict[str, int]]:
    """The bones of a glTF skeleton, `named` by the file itself or found, and the tree with hands and feet it lacked.

    `told` is what the user says of them, as for avatars. What the file names is taken `strict`, or hands and feet may
    be missing.

    Raises `InputError` where one that is needed is missing.
    """
    nodes = file_nodes(gltf, tree)
    chosen = {} if told is None else override_nodes(told, nodes)
    if named is not None:
        bones = {bone: node for bone, node in (named | chosen).items() if node is not None}
    else:
        bones = map_bones(nodes, chosen).nodes
    checked = checked_bones(bones, nodes, gltf.name, strict=named is not None and strict)
    if named is not None and strict:
        return tree, checked.nodes
    mended, bones, _ = repaired(gltf, tree, _without_detached(checked))
    return (tree if mended is gltf else read_nodes(mended)), bones


def _without_detached(bones: CheckedBones) -> CheckedBones:
    """Arms that hang beside the spine may do so in a motion: only where bones are in the world is looked at."""
    return replace(bones, detached={})
