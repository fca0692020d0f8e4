"""Meshes compressed with Draco (KHR_draco_mesh_compression), decoded by Google's library."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.accessors import view_bytes
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf

EXTENSION = "KHR_draco_mesh_compression"
_MOST = 5_000_000  # triangles


@dataclass(frozen=True, eq=False)
class DracoMesh:
    """A decoded primitive."""

    faces: NDArray[np.int64]  # (T, 3)
    attributes: dict[str, NDArray[np.generic]]  # "POSITION" -> (V, width) as stored


def read_draco(gltf: Gltf, extension: Field) -> DracoMesh:
    """Decode the primitive whose extension this is; raises `InputError`."""
    import DracoPy

    data, _ = view_bytes(gltf, gltf.root.at("bufferViews").pick(extension.at("bufferView")))
    try:
        mesh = DracoPy.decode(bytes(data))
    except Exception:  # whatever the library raises, the data is not what it should be
        raise InputError(f"{extension.place}: the compressed mesh is damaged or cut off") from None
    faces = np.asarray(getattr(mesh, "faces", np.zeros((0, 3))), np.int64).reshape(-1, 3)
    if len(faces) > _MOST:
        raise InputError(f"{extension.place} has {len(faces)} triangles: at most {_MOST} are read")
    stored = {int(attribute["unique_id"]): np.asarray(attribute["data"]) for attribute in mesh.attributes}
    names = extension.at("attributes")
    numbers = {name: names.at(name).integer(0, 2**31) for name in names.names(100)}
    return DracoMesh(faces, {name: stored[number] for name, number in numbers.items() if number in stored})
