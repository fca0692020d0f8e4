"""An avatar's own surface, posed by its joints: linear blend skinning of every triangle of its file.

A vertex that hangs on several joints is the weighted mean of the places to which each of them would carry it. With b
its place in T-pose by one joint alone, r that joint's place in T-pose, and p, R the posed joint, this place is
R (b - r) + p: in the model's axes every joint's rotation in T-pose is the identity.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.rig import Rig
from elbowroom.body.surface import loose_nodes
from elbowroom.experiment.judge.poses import Posed
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.nodes import NodeTree, read_nodes
from elbowroom.formats.triangles import TriangleMesh, triangle_mesh
from elbowroom.formats.vrm import read_vrm

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

_FEWEST_SKINNED = 50  # vertices; with fewer, the body is made of rigid pieces
_FARTHEST = 100.0  # metres from the hips: beyond, numbers have overflowed and nothing is drawn


@dataclass(frozen=True, eq=False)
class Skin:
    """The triangles of the body and the joints that carry each vertex; unused places have weight 0."""

    triangles: Ints  # (T, 3) into the vertices
    joints: Ints  # (V, K) of the skeleton
    weights: Floats  # (V, K) sum 1, the greatest first
    offsets: Floats  # (V, K, 3) from each joint in T-pose: b - r, metres
    left_out: int  # triangles that are not the body: what springs move, and rigid things on a skinned body

    def vertices(self, posed: Posed, which: Ints) -> Floats:
        """The vertices `which` (v,) in the world, (N, v, 3), for N poses."""
        total = np.zeros((len(posed.positions), len(which), 3))
        for k in range(self.joints.shape[1]):
            weights, joints = self.weights[which, k], self.joints[which, k]
            for joint in np.unique(joints[weights > 0.0]):
                at = np.flatnonzero((joints == joint) & (weights > 0.0))
                carried = self.offsets[which[at], k] @ np.swapaxes(posed.rotations[:, joint], -1, -2)
                total[:, at] += weights[at, None] * (carried + posed.positions[:, joint, None])
        return total


def skin_of(humanoid: Humanoid) -> tuple[Skin | None, str]:
    """The skin of an avatar, or None and the reason why there is none to judge.

    Raises `InputError` where the mesh is damaged.
    """
    if humanoid.glb is None or humanoid.rig is None:
        return None, "the avatar has no file"
    gltf = parse_gltf(humanoid.glb, humanoid.name)
    tree = read_nodes(gltf)
    mesh = triangle_mesh(gltf, tree)
    vrm = read_vrm(gltf, len(tree))
    skin = _skin(mesh, tree, humanoid, humanoid.rig, loose_nodes(tree, humanoid.rig.nodes.tolist(), vrm))
    return (skin, "") if len(skin.triangles) else (None, "the file has no mesh on the body")


def _skin(mesh: TriangleMesh, tree: NodeTree, humanoid: Humanoid, rig: Rig, springs: frozenset[int]) -> Skin:
    joint_of, foreign = _riders(tree, rig, springs)
    joints = joint_of[mesh.nodes]
    offsets = _in_t_pose(mesh, tree, rig) - humanoid.skeleton.positions[joints]
    body = ~foreign[mesh.nodes[:, 0]] & (np.abs(offsets).max(axis=(1, 2), initial=0.0) < _FARTHEST)
    if np.count_nonzero(body & mesh.skinned) >= _FEWEST_SKINNED:
        body &= mesh.skinned
    kept = body[mesh.triangles].all(axis=1)
    return Skin(mesh.triangles[kept], joints, mesh.weights, offsets, int(np.count_nonzero(~kept)))


def _riders(tree: NodeTree, rig: Rig, springs: frozenset[int]) -> tuple[Ints, Flags]:
    """For every node the joint that carries it, and whether it moves otherwise: by a spring, or not with the body."""
    own = {int(node): joint for joint, node in enumerate(rig.nodes)}
    joints, foreign = np.zeros(len(tree), np.int64), np.ones(len(tree), bool)
    for node in map(int, tree.order):
        above = int(tree.parents[node])
        if node in own:
            joints[node], foreign[node] = own[node], False
        elif above >= 0:
            joints[node], foreign[node] = joints[above], foreign[above] or node in springs
    return joints, foreign


def _in_t_pose(mesh: TriangleMesh, tree: NodeTree, rig: Rig) -> Floats:
    """Where each node of each vertex alone would have it in T-pose, (V, K, 3), in the model's root frame."""
    rotations = tree.rotations.copy()
    rotations[rig.nodes] = rig.local_rotations
    carried = tree.world_matrices(rotations)[mesh.nodes]
    with np.errstate(all="ignore"):
        places = np.einsum("vkij,vkj->vki", carried[..., :3, :3], mesh.offsets) + carried[..., :3, 3]
        return np.nan_to_num(rig.to_model(places), nan=np.inf)
