"""Which format a model has, by how it begins or else by its name."""

from enum import Enum
from pathlib import PurePath

from elbowroom.formats.x3d.recognised import COLLADA, is_x3d
from elbowroom.formats.x3d.recognised import SUFFIXES as X3D_SUFFIXES

_STL_HEAD, _STL_FACET = 84, 50  # bytes of a binary STL before its triangles, and of each


class ModelKind(Enum):
    """A format that is read."""

    GLTF = "glTF 2.0"
    X3D = "X3D or VRML97"
    OBJ = "OBJ"
    STL = "STL"
    PLY = "PLY"
    USD = "USD"

    @property
    def says_its_unit(self) -> bool:
        """Whether the format's standard says how long a unit is, and which way is up."""
        return self in (ModelKind.GLTF, ModelKind.X3D, ModelKind.USD)


_BY_SUFFIX = {
    ".glb": ModelKind.GLTF,
    ".gltf": ModelKind.GLTF,
    ".obj": ModelKind.OBJ,
    ".stl": ModelKind.STL,
    ".ply": ModelKind.PLY,
    ".vrml": ModelKind.X3D,
    **dict.fromkeys((".usd", ".usda", ".usdc", ".usdz"), ModelKind.USD),
    **dict.fromkeys(X3D_SUFFIXES, ModelKind.X3D),
}


_BEGINNINGS = (
    (b"glTF", ModelKind.GLTF),
    (b"{", ModelKind.GLTF),
    (b"#VRML", ModelKind.X3D),
    (b"#X3D", ModelKind.X3D),
    (b"ply\n", ModelKind.PLY),
    (b"ply\r", ModelKind.PLY),
    (b"#usda", ModelKind.USD),
    (b"PXR-USDC", ModelKind.USD),
)


def kind_by_name(name: str) -> ModelKind | None:
    """The format that a file's name promises; None where it promises none that is read."""
    lower = name.lower()
    ending = next((end for end in X3D_SUFFIXES if lower.endswith(end)), PurePath(lower).suffix)
    return _BY_SUFFIX.get(ending)


def kind_of(data: bytes, name: str) -> ModelKind | None:
    """The format of these bytes; None where it is none that is read."""
    head = data[:256].lstrip(b"\xef\xbb\xbf \t\r\n")
    told = next((kind for beginning, kind in _BEGINNINGS if head.startswith(beginning)), None)
    if told is not None:
        return told
    named = kind_by_name(name)
    if (head.startswith(b"<") and COLLADA not in data[:4096]) or (named is ModelKind.X3D and is_x3d(data)):
        return ModelKind.X3D
    if (head.startswith(b"solid") and b"facet" in data[:4096]) or _is_binary_stl(data):
        return ModelKind.STL
    if named is ModelKind.USD and head.startswith(b"PK\x03\x04"):
        return ModelKind.USD
    return named if named is ModelKind.OBJ else None


def _is_binary_stl(data: bytes) -> bool:
    """Whether the number of triangles that a binary STL tells goes with its length."""
    if len(data) <= _STL_HEAD:
        return False
    return len(data) == _STL_HEAD + _STL_FACET * int.from_bytes(data[_STL_HEAD - 4 : _STL_HEAD], "little")
