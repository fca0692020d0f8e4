"""Changes to the node tree of a glTF asset that leave everything where it is: nodes hung elsewhere, nodes added."""

import copy
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf
from elbowroom.formats.nodes import NodeTree
from elbowroom.geometry import quaternion


@dataclass(frozen=True, eq=False)
class NewNode:
    """A node to be added."""

    name: str
    parent: int
    position: NDArray[np.float64]  # (3,) in the world


def grafted(gltf: Gltf, tree: NodeTree, moved: Mapping[int, int], added: Sequence[NewNode]) -> Gltf:
    """The asset with the nodes `moved` (node -> new parent, -1 for none) and `added` (numbered after the last).

    Every node keeps its place in the world; scales above the nodes concerned must be the same along all axes.
    """
    content = copy.deepcopy(gltf.root.value)
    nodes = content["nodes"]
    matrices, turns = tree.world_matrices(tree.rotations), tree.world_rotations(tree.rotations)
    for node, parent in moved.items():
        root = next(iter(tree.ancestors(node)[::-1]), node)
        showing = [scene for scene in content.get("scenes", []) if root in scene.get("nodes", [])]
        _unhang(content, node, int(tree.parents[node]))
        for children in [nodes[parent].setdefault("children", [])] if parent >= 0 else [s["nodes"] for s in showing]:
            children.append(node)
        above = matrices[parent] if parent >= 0 else np.eye(4)
        turn = turns[parent] if parent >= 0 else quaternion.IDENTITY
        scale = tree.world_scale(parent) if parent >= 0 else 1.0
        nodes[node].pop("matrix", None)
        nodes[node] |= {
            "translation": _inside(above, matrices[node, :3, 3]),
            "rotation": quaternion.normalize(quaternion.multiply(quaternion.conjugate(turn), turns[node])).tolist(),
            "scale": [tree.world_scale(node) / scale] * 3,
        }
    for new in added:
        nodes.append({"name": new.name, "translation": _inside(matrices[new.parent], new.position)})
        nodes[new.parent].setdefault("children", []).append(len(nodes) - 1)
    return replace(gltf, root=Field(content, gltf.root.place), glb=None)


def _unhang(content: dict[str, Any], node: int, parent: int) -> None:
    if parent >= 0:
        nodes = content["nodes"]
        nodes[parent]["children"] = [child for child in nodes[parent]["children"] if child != node]
        if not nodes[parent]["children"]:
            del nodes[parent]["children"]
    for scene in content.get("scenes", []):
        if node in scene.get("nodes", []):
            scene["nodes"] = [root for root in scene["nodes"] if root != node]


def _inside(matrix: NDArray[np.float64], point: NDArray[np.float64]) -> list[float]:
    """A point of the world in the axes and units of a node."""
    local: list[float] = np.linalg.solve(matrix[:3, :3], point - matrix[:3, 3]).tolist()
    return local
