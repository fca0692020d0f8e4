"""Rigs that lack what every humanoid needs: hands or feet without a node, arms beside the spine, hips below it.

The file is changed as a modeller would change it, and everything stays where it is: nodes are added at the ends of
forearms and shins, and arms are hung on the spine, so that they go where the trunk takes them.
"""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bone_mapping.structure import CheckedBones
from elbowroom.formats.gltf import Gltf
from elbowroom.formats.grafting import NewNode, grafted
from elbowroom.formats.nodes import NodeTree

_PLACE = {"spine": "above the hips"}  # where a bone is that hangs wrongly
_FOREARM = 0.146 / 0.186  # of the upper arm; Drillis & Contini 1966
_SHIN = 0.246 / 0.245  # of the thigh
_ANKLE = 0.039 / 0.285  # height of the ankle, of the knee's


def repaired(gltf: Gltf, tree: NodeTree, bones: CheckedBones) -> tuple[Gltf, dict[str, int], tuple[str, ...]]:
    """The asset with all bones that are required, their nodes, and a note on each change."""
    if not bones.detached and not bones.absent:
        return gltf, bones.nodes, ()
    rest = tree.world_matrices(tree.rotations)
    places = {bone: rest[node, :3, 3] for bone, node in bones.nodes.items()}
    added = [_end(bone, bones.nodes, places) for bone in bones.absent]
    moved = {bones.nodes[bone]: parent for bone, parent in bones.detached.items()}
    if "spine" in bones.detached:  # the hips hang on it, and change places with it
        moved = {bones.nodes["hips"]: int(tree.parents[bones.nodes["spine"]])} | moved
    numbers = {bone: len(tree) + i for i, bone in enumerate(bones.absent)}
    notes = [
        f"{bone} ({tree.names[bones.nodes[bone]]}) hangs {_PLACE.get(bone, 'beside the spine')}; it was hung on "
        f"{tree.names[parent]}"
        for bone, parent in bones.detached.items()
    ] + [f"{bone} has no node; one was added" for bone in bones.absent]
    return grafted(gltf, tree, moved, added), bones.nodes | numbers, tuple(notes)


def _end(bone: str, nodes: dict[str, int], places: dict[str, NDArray[np.float64]]) -> NewNode:
    """A wrist in line with the upper arm, or an ankle in line with the thigh."""
    side = "left" if bone.startswith("left") else "right"
    limb = "Arm" if bone.endswith("Hand") else "Leg"
    top, middle = places[f"{side}Upper{limb}"], places[f"{side}Lower{limb}"]
    along = middle - top
    if limb == "Arm":
        return NewNode(bone, nodes[f"{side}LowerArm"], middle + _FOREARM * along)
    ground = min(0.0, *(float(place[1]) for place in places.values()))
    longest = (1.0 - _ANKLE) * (middle[1] - ground) / max(float(np.linalg.norm(along)), 1e-9)
    return NewNode(bone, nodes[f"{side}LowerLeg"], middle + min(_SHIN, max(longest, 0.1)) * along)
