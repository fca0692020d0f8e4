"""An avatar file whose mesh is compressed with Draco; `compressed_vrm` does it to real files."""

from typing import Any

import DracoPy
import numpy as np

from avatar_builder import Recipe, build, json_of
from elbowroom.formats.packing import write_glb


def _parts(glb: bytes) -> tuple[dict[str, Any], bytearray]:
    size = int.from_bytes(glb[12:16], "little")
    return json_of(glb), bytearray(glb[28 + size :])


def draco_file(damage: bytes | None = None, each: int = 20) -> tuple[bytes, Any, Any]:
    """An avatar whose mesh is compressed, its points and its joints."""
    content, binary = _parts(build(Recipe(points=each)))
    views, accessors = content["bufferViews"], content["accessors"]

    def view(index: int, kind: str, width: int) -> Any:
        start = views[index]["byteOffset"]
        return np.frombuffer(bytes(binary), kind, views[index]["byteLength"] // np.dtype(kind).itemsize, start).reshape(
            -1, width
        )

    points, joints, weights = view(0, "<f4", 3), view(1, "<u2", 4), view(2, "<u1", 4)
    order = np.arange(len(points) // 3 * 3).reshape(-1, 3)
    packed = DracoPy.encode(
        points, order, quantization_bits=16, generic_attributes={7: joints.copy(), 8: weights.copy()},
        preserve_order=True,
    )  # fmt: skip
    place = next(a["unique_id"] for a in DracoPy.decode(packed).attributes if a["attribute_type"] == 0)
    packed = packed if damage is None else damage
    views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(packed)})
    binary += packed
    content["buffers"] = [{"byteLength": len(binary)}]
    for accessor in accessors[:3]:
        del accessor["bufferView"]
    attributes = {"POSITION": place, "JOINTS_0": 7, "WEIGHTS_0": 8}
    primitive = content["meshes"][0]["primitives"][0]
    primitive["mode"] = 4
    primitive["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": len(views) - 1, "attributes": attributes}}
    return write_glb(content, bytes(binary)), points, joints
