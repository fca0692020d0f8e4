"""Which points of an avatar's surface move with which bone; hair, skirts and things in the hand are not the body."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.fitting import BodyPoints
from elbowroom.formats.meshes import SurfacePoints
from elbowroom.formats.nodes import NodeTree

_FEWEST_SKINNED = 50  # points; with fewer, the body is made of rigid pieces


def body_points(
    tree: NodeTree,
    bone_nodes: list[int],
    spring_nodes: frozenset[int],
    surface: SurfacePoints,
    matrices: NDArray[np.float64],
) -> BodyPoints:
    """The points that belong to bones, in the file's axes and units at the pose of the world `matrices` (n, 4, 4).

    A point on a node between or beyond the bones goes with the nearest bone above it, unless a spring moves it. Where
    the body is skinned, rigid pieces (weapons, shields, helmets) count as things that it carries.
    """
    joint_of_node = _joints_of_nodes(tree, bone_nodes, spring_nodes)
    joints = joint_of_node[surface.nodes] if len(surface.nodes) else np.zeros(0, np.int64)
    kept = joints >= 0
    if np.count_nonzero(kept & surface.skinned) >= _FEWEST_SKINNED:
        kept &= surface.skinned
    carried = matrices[surface.nodes[kept]]
    with np.errstate(all="ignore"):
        positions = np.einsum("pij,pj->pi", carried[:, :3, :3], surface.offsets[kept]) + carried[:, :3, 3]
    finite = np.isfinite(positions).all(axis=1) & (np.abs(positions).max(axis=1, initial=0.0) < 1e6)
    return BodyPoints(positions[finite], joints[kept][finite])


def _joints_of_nodes(tree: NodeTree, bone_nodes: list[int], springs: frozenset[int]) -> NDArray[np.int64]:
    """For every node the skeleton's joint that moves it, -1 for none."""
    own = {node: joint for joint, node in enumerate(bone_nodes)}
    joints = np.full(len(tree), -1, dtype=np.int64)
    for node in map(int, tree.order):
        if node in own:
            joints[node] = own[node]
        elif node not in springs and tree.parents[node] >= 0:
            joints[node] = joints[tree.parents[node]]
    return joints
