"""A compressed buffer view as the bytes that it stands for."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.fields import Field
from elbowroom.formats.meshopt import filters
from elbowroom.formats.meshopt.index_codec import decode_sequence, decode_triangles
from elbowroom.formats.meshopt.vertex_codec import decode_vertices

Bytes = NDArray[np.uint8]

EXTENSIONS = ("EXT_meshopt_compression", "KHR_meshopt_compression")
MAX_COUNT = 5_000_000
_MODES = ("ATTRIBUTES", "TRIANGLES", "INDICES")
_FILTERS: dict[str, tuple[Callable[[Bytes], Bytes], tuple[int, ...] | None]] = {
    "OCTAHEDRAL": (filters.octahedral, (4, 8)),
    "QUATERNION": (filters.quaternions, (8,)),
    "EXPONENTIAL": (filters.exponential, None),
    "COLOR": (filters.color, (4, 8)),
}


def compressed(view: Field) -> Field:
    """The extension of a buffer view that is compressed; a missing field for any other."""
    found = [view.at("extensions").at(name) for name in EXTENSIONS]
    return next((field for field in found if field.present), found[0])


def decoded_size(extension: Field) -> int:
    """Bytes of the view when it is decoded; raises `InputError`."""
    stride = extension.at("byteStride").integer(1, 256)
    return stride * extension.at("count").integer(1, MAX_COUNT)


def decode_view(extension: Field, data: bytes) -> Bytes:
    """The view's bytes, (count, stride), from its compressed `data`; raises `InputError`."""
    count, stride = extension.at("count").integer(1, MAX_COUNT), extension.at("byteStride").integer(1, 256)
    mode = extension.at("mode").text()
    if mode not in _MODES:
        raise extension.at("mode").wrong(" or ".join(_MODES))
    packed = np.frombuffer(data, np.uint8)
    if mode == "ATTRIBUTES":
        if stride % 4:
            raise extension.at("byteStride").wrong("a multiple of 4")
        elements, whole = decode_vertices(packed, count, stride)
        _check(whole, extension)
        return _unfiltered(extension, elements, stride)
    if stride not in (2, 4):
        raise extension.at("byteStride").wrong("2 or 4")
    if mode == "TRIANGLES" and count % 3:
        raise extension.at("count").wrong("a multiple of 3")
    indices, whole = decode_triangles(packed, count) if mode == "TRIANGLES" else decode_sequence(packed, count)
    _check(whole, extension)
    return indices.astype("<u2" if stride == 2 else "<u4").view(np.uint8).reshape(count, stride)


def _check(whole: bool, extension: Field) -> None:
    if not whole:
        raise InputError(f"{extension.place}: the compressed data is damaged or cut off")


def _unfiltered(extension: Field, elements: Bytes, stride: int) -> Bytes:
    name = extension.at("filter").text("NONE")
    if name == "NONE":
        return elements
    if name not in _FILTERS:
        raise extension.at("filter").wrong(" or ".join(["NONE", *_FILTERS]))
    undo, strides = _FILTERS[name]
    if strides is not None and stride not in strides:
        raise extension.at("byteStride").wrong(" or ".join(map(str, strides)))
    return undo(elements)
