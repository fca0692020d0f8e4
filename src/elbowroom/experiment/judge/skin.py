"""An avatar's own surface, posed by its joints: linear blend skinning of every triangle of its body.

A vertex that hangs on several joints is the weighted mean of the places to which each of them would carry it. With b
its place in T-pose by one joint alone, r that joint's place in T-pose, and p, R the posed joint, this place is
R (b - r) + p: in the model's axes every joint's rotation in T-pose is the identity.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.fitting.body_mesh import body_mesh, loose_nodes
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.made_once import made_once
from elbowroom.experiment.judge.poses import Posed
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.triangles import triangle_mesh
from elbowroom.formats.vrm import read_vrm

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]


class Carried(NamedTuple):
    """Some vertices as sums of what joints do to them: one product of matrices poses them all."""

    joints: Ints  # (j,) that carry any of them
    shares: Floats  # (v, 4 j) of the axes of each joint, and of its place

    def vertices(self, posed: Posed, rows: Ints) -> Floats:
        """The vertices in the world, (n, v, 3), at some of N poses."""
        turns, places = (each[rows[:, None], self.joints] for each in (posed.rotations, posed.positions))
        frames = np.concatenate([np.swapaxes(turns, 2, 3), places[:, :, None]], axis=2)  # (n, j, 4, 3)
        across = frames.reshape(len(rows), 4 * len(self.joints), 3).transpose(1, 0, 2)
        carried = self.shares @ across.reshape(4 * len(self.joints), 3 * len(rows))
        return np.ascontiguousarray(carried.reshape(len(self.shares), len(rows), 3).transpose(1, 0, 2))


@dataclass(frozen=True, eq=False)
class Skin:
    """The triangles of the body and the joints that carry each vertex; unused places have weight 0."""

    triangles: Ints  # (T, 3) into the vertices
    joints: Ints  # (V, K) of the skeleton
    weights: Floats  # (V, K) sum 1, the greatest first
    offsets: Floats  # (V, K, 3) from each joint in T-pose: b - r, metres
    left_out: int  # triangles that are not the body: what springs move, and rigid things on a skinned body

    def most_on(self, joints: Sequence[int]) -> Ints:
        """The vertices (v,) of its triangles that hang on one of these joints most."""
        used = np.unique(self.triangles)
        mine: Ints = used[np.isin(self.joints[used, 0], joints)]
        return mine

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

    def carried(self, which: Ints) -> Carried:
        """The vertices `which` (v,) as what their joints make of them; of few joints, or it is large."""
        weights, offsets = self.weights[which], self.offsets[which]
        present, places = np.unique(self.joints[which], return_inverse=True)
        shares = np.zeros((len(which), len(present), 4))
        of_joint = weights[..., None] * np.concatenate([offsets, np.ones_like(weights)[..., None]], axis=2)
        np.add.at(shares, (np.arange(len(which))[:, None], places.reshape(weights.shape)), of_joint)
        return Carried(present, shares.reshape(len(which), -1))


@made_once
def skin_of(humanoid: Humanoid) -> tuple[Skin | None, str]:
    """The skin of an avatar, or None and the reason why there is none to judge.

    It has the triangles that its capsules were fitted to. Raises `InputError` where the mesh is damaged.
    """
    rig = humanoid.rig
    if humanoid.glb is None or rig is None:
        return None, "the avatar has no file"
    if not humanoid.meta.has_body:
        return None, "the file has no mesh on most of the bones: it was planned with average proportions"
    gltf = parse_gltf(humanoid.glb, humanoid.name)
    tree = read_nodes(gltf)
    bones = rig.nodes.tolist()
    vrm = read_vrm(gltf, len(tree))
    loose = frozenset[int]() if humanoid.settings.include_hair else loose_nodes(tree, bones, vrm)
    rotations = tree.rotations.copy()
    rotations[rig.nodes] = rig.local_rotations
    body = body_mesh(triangle_mesh(gltf, tree), tree, bones, loose, tree.world_matrices(rotations))
    if not len(body.triangles):
        return None, "the file has no mesh on the body"
    offsets = rig.to_model(body.places) - humanoid.skeleton.positions[body.joints]
    return Skin(body.triangles, body.joints, body.weights, offsets, len(body.left_out)), ""
