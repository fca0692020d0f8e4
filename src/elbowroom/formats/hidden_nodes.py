"""Nodes of a glTF file that nobody sees: those of another scene, and those that are switched off."""

import numpy as np

from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf
from elbowroom.formats.nodes import NodeTree

_VISIBILITY = "KHR_node_visibility"


def hidden_nodes(gltf: Gltf, tree: NodeTree) -> frozenset[int]:
    """Those that a viewer does not show: what hangs on none of the roots of the file's scene, or on what is hidden.

    None where nothing would be left, as in a library of things that belong to no scene. Raises `InputError`.
    """
    roots, hidden = _roots(gltf, tree), set[int]()
    for node in map(int, tree.order):
        above = int(tree.parents[node])
        away = above in hidden if above >= 0 else node not in roots
        if away or _is_off(gltf, node):
            hidden.add(node)
    seen = set(map(int, np.flatnonzero(tree.meshes >= 0))) - hidden
    return frozenset(hidden if seen else ())


def _is_off(gltf: Gltf, node: int) -> bool:
    told = gltf.root.at("nodes").pick(Field(node, gltf.name)).at("extensions").at(_VISIBILITY).at("visible")
    return told.present and not told.flag()


def _roots(gltf: Gltf, tree: NodeTree) -> set[int]:
    """The roots of the scene that is shown."""
    scenes = gltf.root.at("scenes").items()
    if not scenes:
        return set(map(int, np.flatnonzero(tree.parents < 0)))
    shown = gltf.root.at("scene").optional_integer(0, len(scenes) - 1, 0)
    return {node.integer(0, len(tree) - 1) for node in scenes[shown].at("nodes").items()}
