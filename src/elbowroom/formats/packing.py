"""One self-contained GLB for the browser, whatever the asset was spread over."""

import copy
import json
import struct
from pathlib import Path

from elbowroom.formats.gltf import MAX_BYTES, Gltf
from elbowroom.formats.resources import read_uri

_MIME = {".png": "image/png", ".jpg": "image/jpeg", ".jpeg": "image/jpeg", ".webp": "image/webp", ".ktx2": "image/ktx2"}


def pack_glb(gltf: Gltf) -> bytes:
    """The asset as one GLB that refers to no other file; a GLB or VRM which is so already comes back unchanged.

    Raises `InputError` for references to a network address or out of the file's folder.
    """
    if gltf.glb is not None:
        return gltf.glb
    content = copy.deepcopy(gltf.root.value)
    binary = bytearray()
    starts = [_append(binary, data or b"") for data in gltf.buffers]
    for view in gltf.root.at("bufferViews").items():
        index = int(view.place.rpartition("[")[2][:-1])
        buffer = view.at("buffer").integer(0, len(starts) - 1)
        moved = content["bufferViews"][index]
        moved["byteOffset"] = view.at("byteOffset").optional_integer(0, MAX_BYTES, 0) + starts[buffer]
        moved["buffer"] = 0
    for index, image in enumerate(gltf.root.at("images").items()):
        uri = image.at("uri")
        if uri.present and not uri.text().startswith("data:"):
            data = read_uri(uri, gltf.folder, MAX_BYTES)
            views = content.setdefault("bufferViews", [])
            views.append({"buffer": 0, "byteOffset": _append(binary, data), "byteLength": len(data)})
            packed = content["images"][index]
            del packed["uri"]
            packed["bufferView"] = len(views) - 1
            packed.setdefault("mimeType", _MIME.get(Path(uri.text()).suffix.lower(), "image/png"))
    if binary:
        content["buffers"] = [{"byteLength": len(binary)}]
    return write_glb(content, bytes(binary))


def write_glb(content: dict[str, object], binary: bytes) -> bytes:
    """A GLB from its JSON and its one buffer (which may be empty)."""
    text = json.dumps(content, separators=(",", ":"), allow_nan=False).encode()
    chunks = [(0x4E4F534A, text + b" " * (-len(text) % 4))]
    if binary:
        chunks.append((0x004E4942, binary + b"\x00" * (-len(binary) % 4)))
    body = b"".join(struct.pack("<II", len(chunk), kind) + chunk for kind, chunk in chunks)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def _append(binary: bytearray, data: bytes | memoryview) -> int:
    """Add `data` on a 4-byte border; returns where it starts."""
    binary.extend(b"\x00" * (-len(binary) % 4))
    start = len(binary)
    binary.extend(data)
    return start
