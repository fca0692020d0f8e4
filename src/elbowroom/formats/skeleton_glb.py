"""A skeleton as a GLB: its nodes, with a figure of bones that is skinned to them, or as a VRM animation without one."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.bone_shapes import bone_shapes
from elbowroom.formats.glb_draft import GlbDraft
from elbowroom.formats.gltf_animating import NodeMotion, with_animation
from elbowroom.formats.takes import Take

Floats = NDArray[np.float64]

_MOVED = 1e-9


def skeleton_glb(take: Take, tips: Mapping[str, Floats]) -> bytes:
    """The take with a figure of bones: `tips` (3,) are the ends of bones without a joint below, by joint."""
    draft, tree = GlbDraft(), take.tree
    joints = _nodes(draft, take)
    shapes = bone_shapes(tree, tips)
    binds = np.linalg.inv(tree.world_matrices(tree.rotations))
    skin = draft.add(
        "skins",
        {"joints": joints, "inverseBindMatrices": draft.add_vertices(np.swapaxes(binds, 1, 2)), "skeleton": joints[0]},
    )
    carried, weights = np.zeros((2, len(shapes.points), 4))
    carried[:, 0], weights[:, 0] = shapes.joints, 1.0
    attributes = {
        "POSITION": draft.add_vertices(shapes.points, bounds=True),
        "NORMAL": draft.add_vertices(shapes.normals),
        "JOINTS_0": draft.add_vertices(carried, "<u2"),
        "WEIGHTS_0": draft.add_vertices(weights),
    }
    look = {"baseColorFactor": [0.85, 0.82, 0.75, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.8}
    material = draft.add("materials", {"name": "bones", "pbrMetallicRoughness": look})
    mesh = draft.add("meshes", {"name": "bones", "primitives": [{"attributes": attributes, "material": material}]})
    draft.add_node("bones", mesh=mesh, skin=skin)
    return with_animation(draft.finish(), take.name, take.frame_time, node_motions(take, joints))


def vrm_animation(take: Take, bones: Mapping[str, str]) -> bytes:
    """The take as a VRM animation (`VRMC_vrm_animation` 1.0): `bones` says which node (by name) is which bone.

    The rest pose must be a T-pose that faces +Z, in metres; only the hips' way is played, so it has to carry all.
    """
    draft = GlbDraft()
    joints = _nodes(draft, take)
    named = {bone: {"node": joints[take.tree.names.index(name)]} for bone, name in bones.items()}
    extension = {"specVersion": "1.0", "humanoid": {"humanBones": named}}
    glb = draft.finish({"VRMC_vrm_animation": extension})
    return with_animation(glb, take.name, take.frame_time, node_motions(take, joints))


def node_motions(take: Take, nodes: Sequence[int]) -> list[NodeMotion]:
    """What nodes of a file do, one for each node of a take: all turn, those that leave their places move."""
    moved = np.abs(take.translations - take.tree.translations).max(axis=(0, 2)) > _MOVED
    return [
        NodeMotion(node, take.rotations[:, i], take.translations[:, i] if moved[i] else None)
        for i, node in enumerate(nodes)
    ]


def _nodes(draft: GlbDraft, take: Take) -> list[int]:
    tree = take.tree
    numbers: dict[int, int] = {-1: -1}
    for node in tree.order.tolist():
        above = numbers[int(tree.parents[node])]
        place: Any = tree.translations[node]
        numbers[node] = draft.add_node(tree.names[node], None if above < 0 else above, place, tree.rotations[node])
    return [numbers[node] for node in range(len(tree))]
