"""The skins of an asset: which nodes are joints, and where they were when a mesh was bound to them."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.accessors import read_accessor
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf
from elbowroom.formats.nodes import NodeTree


@dataclass(frozen=True, eq=False)
class Skin:
    """The joints of a skin, and where they were when the mesh was bound to them."""

    joints: NDArray[np.int64]  # (S,) node of each slot
    inverse_binds: NDArray[np.float64]  # (S, 4, 4), maybe more than slots


def skin_joints(gltf: Gltf, tree: NodeTree) -> set[int]:
    """The nodes that are joints of any skin."""
    return {
        joint.integer(0, len(tree) - 1) for skin in gltf.root.at("skins").items() for joint in skin.at("joints").items()
    }


def read_skin(gltf: Gltf, index: int, nodes: int) -> Skin:
    """The skin `index` of a file with that many nodes."""
    skin = gltf.root.at("skins").pick(Field(index, gltf.name))
    joints = np.array([joint.integer(0, nodes - 1) for joint in skin.at("joints").items(nodes)], dtype=np.int64)
    field = skin.at("inverseBindMatrices")
    if not field.present:
        return Skin(joints, np.tile(np.eye(4), (len(joints), 1, 1)))
    matrices = read_accessor(gltf, field, "MAT4").reshape(-1, 4, 4).transpose(0, 2, 1)
    if len(matrices) < len(joints):
        raise InputError(f"{field.place} has {len(matrices)} matrices for {len(joints)} joints")
    return Skin(joints, matrices)
