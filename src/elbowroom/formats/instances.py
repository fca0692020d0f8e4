"""Nodes that show their mesh many times over: the glTF extension EXT_mesh_gpu_instancing."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.accessors import read_accessor
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf
from elbowroom.geometry import quaternion

Floats = NDArray[np.float64]

EXTENSION = "EXT_mesh_gpu_instancing"


def instances_of(gltf: Gltf, node: int) -> Floats | None:
    """Where each of them is, as transforms (N, 4, 4) in the axes of the node; None for a node that shows its mesh once.

    Raises `InputError`.
    """
    told = gltf.root.at("nodes").pick(Field(node, gltf.name)).at("extensions").at(EXTENSION).at("attributes")
    fields = {name: told.at(name) for name in ("TRANSLATION", "ROTATION", "SCALE") if told.at(name).present}
    read = {name: read_accessor(gltf, at, "VEC4" if name == "ROTATION" else "VEC3") for name, at in fields.items()}
    if not read:
        return None
    many = {len(values) for values in read.values()}
    if len(many) > 1:
        raise InputError(f"{told.place}: its accessors have {' and '.join(map(str, sorted(many)))} elements")
    placed = np.tile(np.eye(4), (many.pop(), 1, 1))
    if "ROTATION" in read:
        lengths = np.linalg.norm(read["ROTATION"], axis=1)
        if not ((lengths > 0.5) & (lengths < 2.0)).all():
            raise fields["ROTATION"].wrong("unit quaternions")
        placed[:, :3, :3] = quaternion.to_matrix(read["ROTATION"] / lengths[:, None])
    placed[:, :3, :3] *= read.get("SCALE", np.ones((1, 3)))[:, None]
    placed[:, :3, 3] = read.get("TRANSLATION", 0.0)
    return placed
