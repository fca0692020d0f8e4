"""The user's word on which node is which bone: JSON such as `{"hips": "butt_bone", "leftToes": null}`."""

import json
from pathlib import Path

from elbowroom.body.bone_mapping.file_nodes import FileNodes
from elbowroom.body.bones import PARENTS
from elbowroom.errors import InputError
from elbowroom.formats.fields import Field, parse_json

SUFFIX = ".bones.json"
_LARGEST = 1 << 20  # bytes


def override_beside(path: Path) -> Path | None:
    """The override that lies beside an avatar file (`robot.glb.bones.json` or `robot.bones.json`), if there is one."""
    candidates = [path.with_name(path.name + SUFFIX), path.with_name(path.stem + SUFFIX)]
    return next((candidate for candidate in candidates if candidate.is_file()), None)


def read_override(path: Path) -> Field:
    """The JSON object of an override file; raises `InputError`."""
    try:
        if path.stat().st_size > _LARGEST:
            raise InputError(f"{path.name} is larger than {_LARGEST >> 20} MB: it must be a short list of bones")
        return parse_override(path.read_bytes(), path.name)
    except OSError as error:
        raise InputError(f"{path}: cannot be read: {error.strerror or error}") from None


def parse_override(data: bytes, name: str) -> Field:
    """The same from bytes."""
    return Field(parse_json(data, name, nulls=True), name)


def override_nodes(override: Field, nodes: FileNodes) -> dict[str, int | None]:
    """Bone -> node (None: the avatar has no such bone); raises `InputError` that names the bone."""
    chosen: dict[str, int | None] = {}
    for bone in override.names(len(PARENTS)):
        if bone not in PARENTS:
            raise InputError(f"{override.place}: {json.dumps(bone)[:40]} is no bone; the bones are named as in VRM 1.0")
        field = override.at(bone)
        chosen[bone] = _node(bone, field, nodes) if field.present else None
    used = [node for node in chosen.values() if node is not None]
    for bone, node in chosen.items():
        if node is not None and used.count(node) > 1:
            raise override.at(bone).wrong("a node of its own, but another bone has the same")
    return chosen


def _node(bone: str, field: Field, nodes: FileNodes) -> int:
    """A node by its name or its index in the file."""
    if not isinstance(field.value, str):
        return field.integer(0, len(nodes) - 1)
    found = [node for node, name in enumerate(nodes.names) if name == " ".join(field.value.split())[:200]]
    if len(found) > 1:
        raise field.wrong(f"a name that only one node has; {len(found)} have it: give the node's number instead")
    if not found:
        raise field.wrong(f"the name or number of a node of the avatar for the bone {bone}")
    return found[0]
