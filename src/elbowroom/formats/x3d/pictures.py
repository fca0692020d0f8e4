"""Pictures: which kind a file is, and the pixels that a PixelTexture holds in itself, as PNG."""

import struct
import zlib

import numpy as np

from elbowroom.errors import InputError
from elbowroom.formats.x3d.model import Node

_MAX_PIXELS = 4_000_000
_LARGEST_PIXEL = 2.0**32
_COLOUR_TYPE = {1: 0, 2: 4, 3: 2, 4: 6}  # of PNG, by components


def mime_of(data: bytes) -> str | None:
    """The type of a picture that a glTF may hold, by its first bytes; None for others."""
    if data[:8] == b"\x89PNG\r\n\x1a\n":
        return "image/png"
    return "image/jpeg" if data[:3] == b"\xff\xd8\xff" else None


def pixel_texture(node: Node) -> bytes | None:
    """The `image` of a PixelTexture as PNG; None if it is empty. Raises `InputError`."""
    values = node.numbers("image", _LARGEST_PIXEL)
    if len(values) < 3 or not values[:3].all():
        return None
    width, height, components = (int(value) for value in values[:3])
    if min(width, height) < 1 or not 1 <= components <= 4 or width * height > _MAX_PIXELS:
        raise InputError(f"{node.place}.image begins with {width} {height} {components}: that is no picture")
    if len(values) - 3 < width * height:
        raise InputError(f"{node.place}.image has {len(values) - 3} pixels: {width} x {height} are needed")
    pixels = values[3 : 3 + width * height].astype(np.uint32).reshape(height, width)[::-1]
    channels = np.stack([pixels >> (8 * k) & 255 for k in range(components - 1, -1, -1)], axis=-1).astype(np.uint8)
    rows = np.concatenate([np.zeros((height, 1), np.uint8), channels.reshape(height, -1)], axis=1)
    header = struct.pack(">IIBBBBB", width, height, 8, _COLOUR_TYPE[components], 0, 0, 0)
    chunks = ((b"IHDR", header), (b"IDAT", zlib.compress(rows.tobytes(), 6)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(kind, data) for kind, data in chunks)


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
