"""Which points of an avatar's surface move with which bone; hair, skirts and things in the hand are not the body."""

import re
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.body_parts import BodyPoints
from elbowroom.body.bone_mapping.spelling import words_of
from elbowroom.formats.meshes import SurfacePoints
from elbowroom.formats.nodes import NodeTree
from elbowroom.formats.vrm import Vrm

_FEWEST_SKINNED = 50  # points; with fewer, the body is made of rigid pieces
_NAMED = 6  # things that a note names
_ORNAMENT = re.compile(
    r"(hair|ponytail|bangs|skirt|cape|cloak|scarf|ribbon|tail|handslot|weapon|sword|shield|gun|staff|wing|prop)s?\d*"
)


def loose_nodes(tree: NodeTree, bone_nodes: Sequence[int], vrm: Vrm | None) -> frozenset[int]:
    """The nodes that are not the body: what springs move, and what is named after hair, clothes that hang, weapons.

    What hangs on them is loose too, unless it is a bone.
    """
    bones = set(bone_nodes)
    named = {n for n, name in enumerate(tree.names) if any(_ORNAMENT.fullmatch(word) for word in words_of(name))}
    return frozenset((named - bones) | (set(vrm.spring_nodes) if vrm else set()))


def body_points(
    tree: NodeTree,
    bone_nodes: Sequence[int],
    loose: frozenset[int],
    surface: SurfacePoints,
    matrices: NDArray[np.float64],
) -> tuple[BodyPoints, tuple[str, ...]]:
    """The points that belong to bones, in the file's axes and units at the pose of the world `matrices` (n, 4, 4).

    A point on a node between or beyond the bones goes with the nearest bone above it, unless that is `loose`. Where
    the body is skinned, rigid pieces (weapons, shields, helmets) count as things that it carries. A note names what is
    left out.
    """
    joint_of_node = _joints_of_nodes(tree, bone_nodes, loose)
    joints = joint_of_node[surface.nodes] if len(surface.nodes) else np.zeros(0, np.int64)
    kept = joints >= 0
    if np.count_nonzero(kept & surface.skinned) >= _FEWEST_SKINNED:
        kept &= surface.skinned
    carried = matrices[surface.nodes[kept]]
    with np.errstate(all="ignore"):
        positions = np.einsum("pij,pj->pi", carried[:, :3, :3], surface.offsets[kept]) + carried[:, :3, 3]
    finite = np.isfinite(positions).all(axis=1) & (np.abs(positions).max(axis=1, initial=0.0) < 1e6)
    return BodyPoints(positions[finite], joints[kept][finite]), _note(tree, np.unique(surface.nodes[~kept]))


def _note(tree: NodeTree, nodes: NDArray[np.int64]) -> tuple[str, ...]:
    if not len(nodes):
        return ()
    names = [tree.names[node] or f"node {node}" for node in map(int, nodes)]
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    return (f"not taken for the body (hair, things that hang or are carried): {', '.join(names[:_NAMED])}{more}",)


def _joints_of_nodes(tree: NodeTree, bone_nodes: Sequence[int], loose: frozenset[int]) -> NDArray[np.int64]:
    """For every node the skeleton's joint that moves it, -1 for none."""
    own = {node: joint for joint, node in enumerate(bone_nodes)}
    joints = np.full(len(tree), -1, dtype=np.int64)
    for node in map(int, tree.order):
        if node in own:
            joints[node] = own[node]
        elif node not in loose and tree.parents[node] >= 0:
            joints[node] = joints[tree.parents[node]]
    return joints
