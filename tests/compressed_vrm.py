"""A real VRM or GLB with its meshes compressed as other tools write them; morph targets stay as they are."""

import copy
from typing import Any

import DracoPy
import numpy as np
from numpy.typing import NDArray

from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.packing import write_glb

Array = NDArray[np.generic]

_KINDS = {5121: "<u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_POSITION = 0  # Draco's kind of attribute
DRACO, MESHOPT = "KHR_draco_mesh_compression", "EXT_meshopt_compression"


class Rewriter:
    """A GLB that is being written anew from a good one whose accessors have no stride."""

    def __init__(self, glb: bytes) -> None:
        gltf = parse_gltf(glb, "good.glb")
        assert gltf.buffers[0] is not None
        self.content: Any = copy.deepcopy(gltf.root.value)
        self._old = bytes(gltf.buffers[0])
        self.binary = bytearray()

    def array(self, index: int) -> Array:
        """An accessor's values (count, width), as stored."""
        accessor = self.content["accessors"][index]
        view = self.content["bufferViews"][accessor["bufferView"]]
        kind, width = np.dtype(_KINDS[accessor["componentType"]]), _WIDTHS[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        values = np.frombuffer(self._old, kind, accessor["count"] * width, start)
        return values.reshape(-1, width)

    def add(self, data: bytes) -> dict[str, int]:
        """Where `data` lies in the new buffer."""
        self.binary += bytes(-len(self.binary) % 4)
        place = {"buffer": 0, "byteOffset": len(self.binary), "byteLength": len(data)}
        self.binary += data
        return place

    def old(self, view: dict[str, Any]) -> bytes:
        """The bytes of a view of the good file."""
        start = view.get("byteOffset", 0)
        return self._old[start : start + view["byteLength"]]

    def finish(self, extension: str, *more: dict[str, Any]) -> bytes:
        """The GLB; `more` are buffers without data."""
        for name in ("extensionsUsed", "extensionsRequired"):
            self.content[name] = [*self.content.get(name, []), extension]
        self.content["buffers"] = [{"byteLength": len(self.binary)}, *more]
        return write_glb(self.content, bytes(self.binary))


def with_draco(glb: bytes) -> bytes:
    """Its triangles compressed with Draco, in their order."""
    new = Rewriter(glb)
    content = new.content
    streams = []
    for mesh in content["meshes"]:
        for primitive in mesh["primitives"]:
            data, attributes = _draco(new, primitive)
            streams.append(data)
            extension = {"bufferView": len(content["bufferViews"]) + len(streams) - 1, "attributes": attributes}
            primitive["extensions"] = {DRACO: extension}
            for index in (primitive["indices"], *primitive["attributes"].values()):
                content["accessors"][index].pop("bufferView", None)
    used = {accessor["bufferView"] for accessor in content["accessors"] if "bufferView" in accessor}
    used |= {image["bufferView"] for image in content.get("images", []) if "bufferView" in image}
    for index, view in enumerate(content["bufferViews"]):
        view.update(new.add(new.old(view) if index in used else bytes(4)))
    content["bufferViews"] += [new.add(data) for data in streams]
    return new.finish(DRACO)


def _draco(new: Rewriter, primitive: dict[str, Any]) -> tuple[bytes, dict[str, int]]:
    """The stream of one primitive, and which of its attributes is which."""
    arrays = {name: new.array(index) for name, index in primitive["attributes"].items()}
    others = {name: array for name, array in arrays.items() if name != "POSITION"}
    generic = {number: np.ascontiguousarray(array) for number, array in enumerate(others.values(), start=20)}
    faces = new.array(primitive["indices"]).reshape(-1, 3).astype(np.uint32)
    points = arrays["POSITION"].astype(np.float32)
    data = DracoPy.encode(points, faces, quantization_bits=16, generic_attributes=generic, preserve_order=True)
    stored = DracoPy.decode(data).attributes
    position = next(a["unique_id"] for a in stored if a["attribute_type"] == _POSITION)
    return data, {"POSITION": position} | dict(zip(others, generic, strict=True))


def with_meshopt(glb: bytes) -> bytes:
    """All its attributes and triangles compressed with meshoptimizer; their plain form is in no buffer."""
    new = Rewriter(glb)
    content, plain = new.content, 0
    accessors = {accessor["bufferView"]: accessor for accessor in content["accessors"]}
    primitives = [primitive for mesh in content["meshes"] for primitive in mesh["primitives"]]
    faces = {content["accessors"][p["indices"]]["bufferView"] for p in primitives if "indices" in p}
    for index, view in enumerate(content["bufferViews"]):
        raw = new.old(view)
        packed = _meshopt(raw, accessors[index], index in faces) if index in accessors else None
        if packed is None:
            view.update(new.add(raw))
            continue
        data, about = packed
        view["extensions"] = {MESHOPT: new.add(data) | about}
        view.update({"buffer": 1, "byteOffset": plain})
        plain += -(-len(raw) // 4) * 4
    return new.finish(MESHOPT, {"byteLength": plain, "extensions": {MESHOPT: {"fallback": True}}})


def _meshopt(raw: bytes, accessor: dict[str, Any], face: bool) -> tuple[bytes, dict[str, Any]] | None:
    """A view's stream and what its extension says about it; None where elements do not fill words."""
    import meshoptimizer

    count, kind = accessor["count"], np.dtype(_KINDS[accessor["componentType"]])
    stride = kind.itemsize * _WIDTHS[accessor["type"]]
    about = {"count": count, "byteStride": stride, "mode": "TRIANGLES" if face else "ATTRIBUTES"}
    if face:
        corners = np.frombuffer(raw, kind, count).astype(np.uint32)
        return bytes(meshoptimizer.encode_index_buffer(corners, count, int(corners.max()) + 1)), about
    if stride % 4:
        return None
    elements = np.frombuffer(raw, np.uint8, count * stride).reshape(count, stride)
    return bytes(meshoptimizer.encode_vertex_buffer(elements, count, stride)), about
