"""The container: a GLB or .gltf file as checked JSON and its buffers. Nothing outside its own folder is ever read."""

import struct
from dataclasses import dataclass, field
from pathlib import Path

from elbowroom.errors import InputError
from elbowroom.formats.fields import Field, parse_json
from elbowroom.formats.file_bytes import read_file
from elbowroom.formats.foreign_files import told_apart
from elbowroom.formats.resources import read_uri

MAX_BYTES = 256 * 1024 * 1024
_MAX_BUFFERS = 1000
_JSON, _BIN = 0x4E4F534A, 0x004E4942


@dataclass(frozen=True, eq=False)
class Gltf:
    """A glTF 2.0 asset in memory."""

    name: str  # file name, for messages
    root: Field  # the JSON object
    buffers: tuple[bytes | memoryview | None, ...]  # None: a buffer without data (compression fallback)
    glb: bytes | None  # the bytes as read, if they are a GLB that needs no other file
    folder: Path | None  # where neighbouring files may lie; None for uploaded bytes
    decoded: dict[str, bytes] = field(default_factory=dict)  # compressed views that were read already, by their place


def read_gltf(path: Path) -> Gltf:
    """Read a .glb, .vrm or .gltf file; raises `InputError`."""
    return parse_gltf(read_file(path, MAX_BYTES), path.name, path.parent)


def parse_gltf(data: bytes, name: str, folder: Path | None = None) -> Gltf:
    """Take a GLB or .gltf apart; `folder` is where neighbouring buffer files may lie (none for an upload)."""
    if len(data) > MAX_BYTES:
        raise InputError(f"{name} has {len(data) >> 20} MB: at most {MAX_BYTES >> 20} MB are read")
    is_glb = data[:4] == b"glTF"
    if not is_glb and not data[:64].lstrip(b"\xef\xbb\xbf \t\r\n").startswith(b"{"):
        raise InputError(told_apart(name, data, "it is neither a GLB or VRM ('glTF') nor a .gltf ('{')"))
    text, binary = _glb_chunks(data, name) if is_glb else (data, None)
    root = Field(parse_json(text, name), name)
    version = root.at("asset").at("version")
    if not version.text().startswith("2."):
        raise version.wrong("'2.0'")
    fields = root.at("buffers").items(_MAX_BUFFERS)
    buffers = tuple(_buffer(place, binary if i == 0 else None, folder) for i, place in enumerate(fields))
    whole = is_glb and not _needs_files(root)
    return Gltf(name, root, buffers, data if whole else None, folder)


def _glb_chunks(data: bytes, name: str) -> tuple[bytes, memoryview | None]:
    """The JSON chunk and the binary chunk of a GLB."""
    if len(data) < 20:
        raise InputError(f"{name} ends after {len(data)} bytes: a GLB has at least 20")
    _, version, length = struct.unpack_from("<4sII", data)
    if version != 2:
        raise InputError(f"{name} is GLB version {version}: only version 2 is read")
    if length > len(data):
        raise InputError(f"{name} ends after {len(data)} of {length} bytes: the file was cut off")
    chunks: dict[int, memoryview] = {}
    at = 12
    while at + 8 <= length:
        size, kind = struct.unpack_from("<II", data, at)
        if size > length - at - 8:
            raise InputError(f"{name}: the chunk at byte {at} claims {size} bytes, {length - at - 8} are left")
        chunks.setdefault(kind, memoryview(data)[at + 8 : at + 8 + size])
        at += 8 + size
    if _JSON not in chunks:
        raise InputError(f"{name} has no JSON chunk: it is not a glTF asset")
    return bytes(chunks[_JSON]), chunks.get(_BIN)


def _buffer(place: Field, binary: memoryview | None, folder: Path | None) -> bytes | memoryview | None:
    size = place.at("byteLength").integer(1, MAX_BYTES)
    uri = place.at("uri")
    data = read_uri(uri, folder, MAX_BYTES) if uri.present else binary
    if data is not None and len(data) < size:
        raise InputError(f"{place.place} claims {size} bytes, {len(data)} are there: the file was cut off")
    return data


def _needs_files(root: Field) -> bool:
    """Whether a viewer would have to fetch anything but these bytes."""
    uris = [place.at("uri") for key in ("buffers", "images") for place in root.at(key).items()]
    return any(uri.present and not uri.text().startswith("data:") for uri in uris)
