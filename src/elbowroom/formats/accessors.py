"""Accessors as arrays: strides, normalised integers, sparse values, every border checked (glTF 2.0, section 3.6)."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import MAX_BYTES, Gltf
from elbowroom.formats.meshopt.views import compressed, decode_view, decoded_size

MAX_COUNT = 5_000_000

_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def read_accessor(gltf: Gltf, reference: Field, kind: str) -> NDArray[np.float64]:
    """The accessor that `reference` points to, as (count, width) numbers; `kind` is "VEC3", "MAT4", ...

    Raises `InputError` for a wrong type, anything out of bounds, and values that are not finite.
    """
    field = gltf.root.at("accessors").pick(reference)
    if field.at("type").value != kind:
        raise field.at("type").wrong(f"'{kind}'")
    count = field.at("count").integer(1, MAX_COUNT)
    dtype, width = _component(field.at("componentType")), WIDTHS[kind]
    if field.at("bufferView").present:
        raw = _elements(gltf, field, count, dtype, width)
    else:
        raw = np.zeros((count, width), dtype)
    raw = _with_sparse(gltf, field.at("sparse"), raw)
    return scaled(raw, field)


def _component(field: Field) -> np.dtype[np.generic]:
    name = _COMPONENTS.get(field.integer(5120, 5126))
    if name is None:
        raise field.wrong("a component type of glTF 2.0")
    return np.dtype(name)


def _elements(gltf: Gltf, field: Field, count: int, dtype: np.dtype[np.generic], width: int) -> NDArray[np.generic]:
    """A view (count, width) on the buffer behind `field` (an accessor, or the indices or values of a sparse one)."""
    view = gltf.root.at("bufferViews").pick(field.at("bufferView"))
    data, stride_field = view_bytes(gltf, view)
    size = dtype.itemsize * width
    stride = stride_field.optional_integer(1, 256, size)
    start = field.at("byteOffset").optional_integer(0, MAX_BYTES, 0)
    needed = start + (count - 1) * stride + size
    if needed > len(data):
        raise InputError(f"{field.place} needs {needed} bytes: its buffer view has {len(data)}")
    if stride < size:
        raise stride_field.wrong(f"at least {size}")
    return np.ndarray((count, width), dtype, data, start, (stride, dtype.itemsize))


def view_bytes(gltf: Gltf, view: Field) -> tuple[memoryview, Field]:
    """The bytes of a buffer view, decoded where it is compressed, and where its stride is told; raises `InputError`."""
    packed = compressed(view)
    if not packed.present:
        return _slice(gltf, view), view.at("byteStride")
    if view.place not in gltf.decoded:
        used = sum(len(done) for done in gltf.decoded.values())
        if used + decoded_size(packed) > MAX_BYTES:
            raise InputError(f"{packed.place}: the decoded views have more than {MAX_BYTES >> 20} MB")
        gltf.decoded[view.place] = decode_view(packed, bytes(_slice(gltf, packed))).tobytes()
    return memoryview(gltf.decoded[view.place]), packed.at("byteStride")


def _slice(gltf: Gltf, view: Field) -> memoryview:
    """The bytes that `view` (a buffer view or its compressed form) points to."""
    buffer = view.at("buffer").integer(0, len(gltf.buffers) - 1)
    data = gltf.buffers[buffer]
    if data is None:
        raise InputError(f"{view.place}: its buffer {buffer} has no data in this file")
    offset = view.at("byteOffset").optional_integer(0, MAX_BYTES, 0)
    length = view.at("byteLength").integer(1, MAX_BYTES)
    if offset + length > len(data):
        raise InputError(f"{view.place} needs {length} bytes at {offset}: its buffer ends before that")
    return memoryview(data)[offset : offset + length]


def _with_sparse(gltf: Gltf, sparse: Field, raw: NDArray[np.generic]) -> NDArray[np.generic]:
    if not sparse.present:
        return raw
    count = sparse.at("count").integer(1, len(raw))
    index_field = sparse.at("indices")
    indices = _elements(gltf, index_field, count, _component(index_field.at("componentType")), 1)[:, 0].astype(np.int64)
    if indices.min() < 0 or indices.max() >= len(raw):
        raise InputError(f"{index_field.place} points to element {indices.max()} of {len(raw)}")
    result = raw.copy()
    result[indices] = _elements(gltf, sparse.at("values"), count, raw.dtype, raw.shape[1])
    return result


def scaled(raw: NDArray[np.generic], field: Field) -> NDArray[np.float64]:
    """Stored values as the numbers that they stand for by the accessor `field`; raises `InputError`."""
    if raw.dtype.kind == "f" and not np.isfinite(raw).all():
        raise InputError(f"{field.place} holds numbers that are not finite")
    values = raw.astype(np.float64)
    if raw.dtype.kind != "f" and field.at("normalized").flag():
        values = np.maximum(values / (2.0 ** (8 * raw.dtype.itemsize - (raw.dtype.kind == "i")) - 1.0), -1.0)
    return values
