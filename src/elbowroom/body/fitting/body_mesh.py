"""Which triangles of a file are the avatar's body, and which joints carry them: one list for planning and for judging.

Not the body are what springs move and what is named after hair, clothes that hang and weapons, with all that hangs on
them; what hangs on no bone; and, where most of the surface is skinned, rigid things (helmets, shields), which the body
carries.
"""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.bone_mapping.spelling import words_of
from elbowroom.formats.nodes import NodeTree
from elbowroom.formats.triangles import TriangleMesh
from elbowroom.formats.vrm import Vrm

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

_SKINNED = 0.2  # of the surface on bones: with more that is skinned, what is rigid is carried
_FARTHEST = 50.0  # times the size of the skeleton: beyond, numbers have overflowed and nothing is drawn
_NAMED = 6  # things that a note names
_ORNAMENT = re.compile(
    r"(hair|ponytail|bangs|skirt|cape|cloak|scarf|ribbon|tail|handslot|weapon|sword|shield|gun|staff|wing|prop)s?\d*"
)


@dataclass(frozen=True, eq=False)
class BodyMesh:
    """The triangles of a body in T-pose; a vertex that hangs on several joints is the weighted mean of its places."""

    triangles: Ints  # (T, 3) into the vertices
    joints: Ints  # (V, K) of the skeleton
    weights: Floats  # (V, K) sum 1, the greatest first; unused places have weight 0
    places: Floats  # (V, K, 3) where each of its joints alone would have a vertex
    left_out: Ints  # (L,) the nodes of the file that carry triangles which are not the body, one for each triangle

    def vertices(self) -> Floats:
        """Where the vertices (V, 3) are."""
        places: Floats = np.einsum("vk,vki->vi", self.weights, self.places)
        return places

    def moved(self, move: Callable[[Floats], Floats]) -> "BodyMesh":
        """The same in other axes and units."""
        return replace(self, places=move(self.places))


def loose_nodes(tree: NodeTree, bone_nodes: Sequence[int], vrm: Vrm | None) -> frozenset[int]:
    """The nodes that are not the body: what springs move, and what is named after hair, clothes that hang, weapons.

    What hangs on them is loose too, unless it is a bone.
    """
    bones = set(bone_nodes)
    named = {n for n, name in enumerate(tree.names) if any(_ORNAMENT.fullmatch(word) for word in words_of(name))}
    return frozenset((named - bones) | (set(vrm.spring_nodes) if vrm else set()))


def body_mesh(
    mesh: TriangleMesh, tree: NodeTree, bone_nodes: Sequence[int], loose: frozenset[int], matrices: Floats
) -> BodyMesh:
    """The body among the triangles of a file, in the file's axes and units at the pose of the world `matrices`.

    What rides on a node between or beyond the bones goes with the nearest bone above it, unless that node is `loose`.
    """
    joint_of, foreign = _riders(tree, bone_nodes, loose)
    carried = matrices[mesh.nodes]
    with np.errstate(all="ignore"):
        places = np.einsum("vkij,vkj->vki", carried[..., :3, :3], mesh.offsets) + carried[..., :3, 3]
    bones = matrices[list(bone_nodes), :3, 3]
    near = np.abs(np.nan_to_num(places - bones[0], nan=np.inf)) < _FARTHEST * float(np.ptp(bones, axis=0).max())
    drawn = near.all(axis=(1, 2))
    places[~drawn] = bones[0]
    own = drawn & ~foreign[mesh.nodes[:, 0]]
    whole = BodyMesh(mesh.triangles, joint_of[mesh.nodes], mesh.weights, places, np.zeros(0, np.int64))
    kept = own[mesh.triangles].all(axis=1)
    skinned = mesh.skinned[mesh.triangles].all(axis=1)
    areas = triangle_areas(whole.vertices()[mesh.triangles])
    if areas[kept & skinned].sum() > _SKINNED * areas[kept].sum():
        kept &= skinned
    other = mesh.triangles[~kept]
    strange = np.take_along_axis(other, np.argmin(own[other], axis=1)[:, None], axis=1)[:, 0]
    return replace(whole, triangles=mesh.triangles[kept], left_out=mesh.nodes[strange, 0])


def left_out_note(tree: NodeTree, body: BodyMesh) -> tuple[str, ...]:
    """A note that names what is not taken for the body, if anything is."""
    nodes = np.unique(body.left_out)
    if not len(nodes):
        return ()
    names = [tree.names[node] or f"node {node}" for node in map(int, nodes)]
    more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    return (f"not taken for the body (hair, things that hang or are carried): {', '.join(names[:_NAMED])}{more}",)


def triangle_areas(corners: Floats) -> Floats:
    """Areas (T,) of triangles with corners (T, 3, 3)."""
    sides = corners[:, 1:] - corners[:, :1]
    areas: Floats = 0.5 * np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1)
    return areas


def _riders(tree: NodeTree, bone_nodes: Sequence[int], loose: frozenset[int]) -> tuple[Ints, Flags]:
    """For every node the joint that carries it, and whether it moves otherwise: loosely, or not with the body."""
    own = {int(node): joint for joint, node in enumerate(bone_nodes)}
    joints, foreign = np.zeros(len(tree), np.int64), np.ones(len(tree), bool)
    for node in map(int, tree.order):
        above = int(tree.parents[node])
        if node in own:
            joints[node], foreign[node] = own[node], False
        elif above >= 0:
            joints[node], foreign[node] = joints[above], foreign[above] or node in loose
    return joints, foreign
