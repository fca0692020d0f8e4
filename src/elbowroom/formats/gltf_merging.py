"""Puts the content of one GLB beside that of another."""

import copy
from typing import Any

from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.open_glb import OpenGlb

_COLLECTIONS = ("nodes", "meshes", "materials", "bufferViews", "accessors")
# Where one element of a plain file names another: by the collection that it is in, the member and what that points to.
_NAMED = {
    "bufferViews": (("buffer", "buffers"),),
    "accessors": (("bufferView", "bufferViews"),),
    "nodes": (("mesh", "meshes"),),
}


def with_nodes_of(glb: bytes, plain: bytes) -> tuple[bytes, list[int]]:
    """The GLB with all nodes of a plain one in its scene, and their numbers there, in their order.

    A plain GLB has nodes, meshes of triangles and materials without pictures, as `GlbDraft` writes them.
    """
    opened, added = OpenGlb(glb), copy.deepcopy(parse_gltf(plain, "plain").root.value)
    counts = {key: len(opened.content.get(key, [])) for key in _COLLECTIONS}
    start = opened.append(OpenGlb(plain).data)
    for view in added.get("bufferViews", []):
        view |= {"buffer": opened.buffer, "byteOffset": start + view.get("byteOffset", 0)}
    for collection, members in _NAMED.items():
        for element in added.get(collection, []):
            for member, target in members:
                if member in element and target in counts:
                    element[member] += counts[target]
    for node in added["nodes"]:
        if "children" in node:
            node["children"] = [child + counts["nodes"] for child in node["children"]]
    for primitive in (one for mesh in added.get("meshes", []) for one in mesh["primitives"]):
        _shift(primitive, counts)
    for collection in counts:
        if added.get(collection):
            opened.content.setdefault(collection, []).extend(added[collection])
    opened.roots().extend(root + counts["nodes"] for root in added["scenes"][0]["nodes"])
    return opened.closed(), [counts["nodes"] + node for node in range(len(added["nodes"]))]


def _shift(primitive: dict[str, Any], counts: dict[str, int]) -> None:
    attributes = primitive["attributes"]
    primitive["attributes"] = {name: accessor + counts["accessors"] for name, accessor in attributes.items()}
    for member, target in (("indices", "accessors"), ("material", "materials")):
        if member in primitive:
            primitive[member] += counts[target]
