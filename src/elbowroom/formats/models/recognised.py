"""Whether a model's file is that of a place or of somebody: told by whether anything in it could be a skeleton."""

from pathlib import Path

from elbowroom.errors import InputError
from elbowroom.formats.fields import Field
from elbowroom.formats.file_bytes import read_file
from elbowroom.formats.gltf import parse_gltf, read_gltf
from elbowroom.formats.models.kinds import ModelKind, kind_by_name, kind_of
from elbowroom.formats.x3d.files import MAX_BYTES, unpacked

_VRM = ("VRM", "VRMC_vrm")
_HUMANOIDS = (b"Humanoid", b"HAnimJoint")


def may_be_a_place(data: bytes, name: str) -> bool:
    """Whether these bytes are a model most of which bends by no bones: a place, should it be nobody.

    Raises `InputError`.
    """
    kind = kind_of(data, name)
    if kind is not ModelKind.GLTF:
        return kind is not None
    return _mostly_stands(parse_gltf(data, name).root)


def _mostly_stands(root: Field) -> bool:
    """Whether more nodes show a mesh as it is than one that is moved by bones, such as a flag or a fish."""
    shown = [node for node in root.at("nodes").items() if node.at("mesh").present]
    bent = sum(node.at("skin").present for node in shown)
    return len(shown) > 2 * bent


def is_of_a_place(path: Path) -> bool:
    """Whether the model in a file has no skeleton. False for what cannot be read: others say why."""
    kind = kind_by_name(path.name)
    try:
        if kind is ModelKind.X3D:
            text = unpacked(read_file(path, MAX_BYTES), path.name)
            return not any(word in text for word in _HUMANOIDS)
        if kind is ModelKind.GLTF:
            root = read_gltf(path).root
            skinned = bool(root.at("skins").items())
            return not skinned and not any(root.at("extensions").at(name).present for name in _VRM)
    except InputError:
        return False
    return kind is not None
