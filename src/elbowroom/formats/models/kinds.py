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

    @property
    def says_its_unit(self) -> bool:
        """Whether the format's standard says that lengths are metres and Y is up."""
        return self in (ModelKind.GLTF, ModelKind.X3D)


_BY_SUFFIX = {
    ".glb": ModelKind.GLTF,
    ".gltf": ModelKind.GLTF,
    ".obj": ModelKind.OBJ,
    ".stl": ModelKind.STL,
    ".ply": ModelKind.PLY,
    ".vrml": ModelKind.X3D,
    **dict.fromkeys(X3D_SUFFIXES, ModelKind.X3D),
}
MODEL_SUFFIXES = tuple(_BY_SUFFIX)


def kind_by_name(name: str) -> ModelKind | None:
    """The format that a file's name promises; None where it promises none that is read."""
    lower = name.lower()
    ending = next((end for end in X3D_SUFFIXES if lower.endswith(end)), PurePath(lower).suffix)
    return _BY_SUFFIX.get(ending)


def kind_of(data: bytes, name: str) -> ModelKind | None:
    """The format of these bytes; None where it is none that is read."""
    head = data[:256].lstrip(b"\xef\xbb\xbf \t\r\n")
    named = kind_by_name(name)
    if head.startswith(b"glTF"):
        return ModelKind.GLTF
    if head.startswith(b"ply\n") or head.startswith(b"ply\r"):
        return ModelKind.PLY
    if (head.startswith((b"#VRML", b"#X3D", b"<")) and COLLADA not in data[:4096]) or (
        named is ModelKind.X3D and is_x3d(data)
    ):
        return ModelKind.X3D
    if (head.startswith(b"solid") and b"facet" in data[:4096]) or _is_binary_stl(data):
        return ModelKind.STL
    if head.startswith(b"{"):
        return ModelKind.GLTF
    return named if named is ModelKind.OBJ else None


def _is_binary_stl(data: bytes) -> bool:
    """Whether the number of triangles that a binary STL tells goes with its length."""
    if len(data) <= _STL_HEAD:
        return False
    return len(data) == _STL_HEAD + _STL_FACET * int.from_bytes(data[_STL_HEAD - 4 : _STL_HEAD], "little")
