"""What a file is that somebody took for a scene, an avatar or a motion."""

from pathlib import Path
from typing import Any

from elbowroom.formats.fields import beginning_of

# By how they begin, past white space; the longer ones first.
_BEGINNINGS: tuple[tuple[bytes, str], ...] = (
    (b"ELBOWROOM RECORDING", "a recording"),
    (b"Kaydara FBX", "an FBX model"),
    (b"ISO-10303-21", "an IFC or STEP model"),
    (b"HIERARCHY", "a BVH motion"),
    (b"Vocaloid Motion Data", "an MMD motion"),
    (b"PXR-USDC", "a USD model"),
    (b"BLENDER", "a Blender file"),
    (b"#usda", "a USD model"),
    (b"#VRML", "a VRML model"),
    (b"Pmx ", "an MMD model"),
    (b"Pmd", "an MMD model"),
    (b"glTF", "a glTF model that is not called .glb"),
    (b"#X3D", "an X3D model"),
    (b"solid", "an STL model"),
    (b"ply", "a PLY model"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\x1f\x8b", "a gzipped file"),
)
_ELEMENTS = {b"<X3D": "an X3D model", b"<COLLADA": "a COLLADA model", b"<ifcXML": "an IFC model"}
_ENDINGS = {
    ".3ds": "a 3DS model",
    ".blend": "a Blender file",
    ".bvh": "a BVH motion",
    ".dae": "a COLLADA model",
    ".elbow": "a recording",
    ".fbx": "an FBX model",
    ".glb": "a glTF model",
    ".gltf": "a glTF model",
    ".ifc": "an IFC model",
    ".obj": "an OBJ model",
    ".ply": "a PLY model",
    ".stl": "an STL model",
    ".usd": "a USD model",
    ".usda": "a USD model",
    ".usdc": "a USD model",
    ".usdz": "a USD model",
    ".vrm": "a VRM avatar, which walks by --avatar",
    ".vrml": "a VRML model",
    ".wrl": "a VRML model",
    ".x3d": "an X3D model",
    ".x3dv": "an X3D model",
    ".x3dz": "an X3D model",
}
_BLENDER = "Blender can open it and save it as .glb"
_MENDS = {
    "an FBX model": _BLENDER,
    "a COLLADA model": _BLENDER,
    "a USD model": _BLENDER,
    "a Blender file": _BLENDER,
    "an MMD model": "an add-on of Blender's can open it and save it as .vrm or .glb",
    "an MMD motion": "an add-on of Blender's can open it and save it as .bvh or .glb",
    "an IFC or STEP model": "IfcConvert saves an IFC model as .glb",
    "a ZIP archive": "unpack it",
}
_AVATAR = ".vrm"  # begins as other glTF models do
_LOOKED_AT = 4096  # bytes


def foreign_kind(path: Path) -> str | None:
    """What a file is, by how it begins or else by its name; None where it may be JSON. Raises OSError."""
    with path.open("rb") as file:
        head = file.read(_LOOKED_AT)
    if path.suffix.lower() == _AVATAR:
        return _ENDINGS[_AVATAR]
    return kind_by_beginning(head) or _ENDINGS.get(path.suffix.lower())


def kind_by_beginning(data: bytes) -> str | None:
    """What some bytes are, by how they begin; None where that tells nothing."""
    head = data[:_LOOKED_AT].removeprefix(b"\xef\xbb\xbf").lstrip()
    for beginning, kind in _BEGINNINGS:
        if head.startswith(beginning):
            return kind
    if head.startswith(b"<"):
        return next((kind for element, kind in _ELEMENTS.items() if element in head), "an XML file")
    return None


def told_apart(name: str, data: bytes, wanted: str) -> str:
    """What to say of a file that is none of ours: what it is or begins with, what is `wanted`, and what to do."""
    kind = kind_by_beginning(data)
    if kind is None:
        return f"{name}{beginning_of(data)}: {wanted}"
    mend = _MENDS.get(kind, "")
    return f"{name} is {kind}: {wanted}{mend and f'; {mend}'}"


def foreign_document(document: Any) -> str | None:
    """What a JSON document is that is no scene; None where it may be one."""
    is_gltf = isinstance(document, dict) and "asset" in document and "format" not in document
    return "a glTF model" if is_gltf else None
