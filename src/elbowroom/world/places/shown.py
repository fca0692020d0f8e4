"""What a viewer shows of a place: a GLB in the scene's own metres and axes, its ground at height 0."""

import re
import struct
from typing import Any

import numpy as np

from elbowroom.formats.fields import parse_json
from elbowroom.formats.models.matt import matt
from elbowroom.formats.packing import pack_glb, write_glb
from elbowroom.world.places.place import Place

_HEAD = 20  # bytes before a GLB's JSON
# Linear colours of what has no material, a kind of thing each: the format's own default is bare metal.
_TINTS = (
    (0.72, 0.7, 0.66),
    (0.5, 0.56, 0.6),
    (0.62, 0.5, 0.38),
    (0.48, 0.58, 0.48),
    (0.66, 0.58, 0.5),
    (0.55, 0.5, 0.6),
)


def shown_glb(place: Place, ground: float) -> bytes:
    """The GLB of a place without what is dropped; raises `InputError` for references to files elsewhere."""
    place.model.gltf.root.at("materials").items()  # a list: some are added to it below
    packed = pack_glb(place.model.gltf)
    (length,) = struct.unpack_from("<I", packed, 12)
    content = parse_json(packed[_HEAD : _HEAD + length], place.name)
    binary = packed[_HEAD + length + 8 :]
    nodes = content["nodes"]
    for node in place.dropped:
        nodes[node].pop("mesh", None)
    hanging = {child for node in nodes for child in node.get("children", ())}
    placed = place.to_metres.copy()
    placed[1, 3] -= ground
    roots = [node for node in range(len(nodes)) if node not in hanging]
    nodes.append({"name": "place", "matrix": np.round(placed.T, 9).ravel().tolist(), "children": roots})
    content["scenes"], content["scene"] = [{"nodes": [len(nodes) - 1]}], 0
    for unseen in ("animations", "cameras"):
        content.pop(unseen, None)
    for node in nodes:
        node.pop("camera", None)
    _paint(content)
    if not place.model.kind.says_its_unit:  # loose triangles: which side is outside is anybody's guess
        for material in content.get("materials", ()):
            material["doubleSided"] = True
    return write_glb(content, binary)


def _paint(content: dict[str, Any]) -> None:
    """Give matt surfaces to what has no material: things whose names begin alike have one tint."""
    bare: dict[int, str] = {}
    for node in content["nodes"]:
        if "mesh" in node:
            bare.setdefault(node["mesh"], re.split(r"[\d_.:-]", node.get("name", ""), maxsplit=1)[0])
    kinds: dict[str, int] = {}
    for mesh, name in bare.items():
        for primitive in content["meshes"][mesh].get("primitives", ()):
            if "material" not in primitive:
                if name not in kinds:
                    kinds[name] = len(content.setdefault("materials", []))
                    content["materials"].append(matt(_TINTS[len(kinds) % len(_TINTS)]))
                primitive["material"] = kinds[name]
