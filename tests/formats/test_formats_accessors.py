from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from elbowroom.errors import InputError
from elbowroom.formats.accessors import read_accessor
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import Gltf

TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}


def _gltf(accessor: dict[str, Any], views: list[dict[str, Any]], data: bytes) -> Gltf:
    content = {"accessors": [accessor], "bufferViews": views}
    return Gltf("made.glb", Field(content, "made.glb"), (data,), None, None)


def _read(gltf: Gltf, kind: str = "VEC3") -> np.ndarray[Any, np.dtype[np.float64]]:
    return read_accessor(gltf, Field(0, "here"), kind)


@settings(max_examples=60, deadline=None)
@given(
    code=st.sampled_from(sorted(TYPES)),
    count=st.integers(1, 9),
    gap=st.integers(0, 8),
    start=st.integers(0, 9),
    offset=st.integers(0, 9),
    normalized=st.booleans(),
    seed=st.integers(0, 2**32 - 1),
)
def test_every_layout_is_read(
    code: int, count: int, gap: int, start: int, offset: int, normalized: bool, seed: int
) -> None:
    dtype = np.dtype(TYPES[code])
    size = 3 * dtype.itemsize
    raw = np.random.default_rng(seed).integers(0, 255, 400, dtype=np.uint8).tobytes()
    if code == 5126:
        raw = np.random.default_rng(seed).normal(size=100).astype("<f4").tobytes()
        gap, start, offset = gap // 4 * 4, start // 4 * 4, offset // 4 * 4
    view = {"buffer": 0, "byteOffset": offset, "byteLength": 400 - offset, "byteStride": size + gap}
    accessor = {"bufferView": 0, "byteOffset": start, "componentType": code, "count": count, "type": "VEC3"}
    found = _read(_gltf(accessor | {"normalized": normalized}, [view], raw))
    for row in range(count):
        at = offset + start + row * (size + gap)
        expected = np.frombuffer(raw[at : at + size], dtype).astype(float)
        if normalized and code != 5126:
            expected = np.maximum(expected / np.iinfo(dtype).max, -1.0)
        assert np.allclose(found[row], expected, rtol=1e-12)


def test_sparse_values_replace_elements() -> None:
    data = np.array([1, 3], "<u2").tobytes() + np.arange(6, dtype="<f4").tobytes()
    views = [{"buffer": 0, "byteLength": 4}, {"buffer": 0, "byteOffset": 4, "byteLength": 24}]
    sparse = {"count": 2, "indices": {"bufferView": 0, "componentType": 5123}, "values": {"bufferView": 1}}
    accessor = {"componentType": 5126, "count": 4, "type": "VEC3", "sparse": sparse}
    found = _read(_gltf(accessor, views, data))
    assert found.tolist() == [[0, 0, 0], [0, 1, 2], [0, 0, 0], [3, 4, 5]]
    with pytest.raises(InputError, match="element 3 of 3"):
        _read(_gltf(accessor | {"count": 3}, views, data))


@pytest.mark.parametrize(
    ("accessor", "view", "words"),
    [
        ({"count": 0}, {}, "whole number from 1"),
        ({"count": 10**9}, {}, "whole number from 1"),
        ({"count": 5}, {}, "ends before that|its buffer view has"),
        ({"byteOffset": -4}, {}, "byteOffset"),
        ({"byteOffset": 4}, {}, "ends before that|its buffer view has"),
        ({"componentType": 5124}, {}, "component type"),
        ({"componentType": "5126"}, {}, "whole number"),
        ({"bufferView": 1}, {}, "from 0 to 0"),
        ({"type": "VEC4"}, {}, "VEC3"),
        ({}, {"byteStride": 4}, "at least 12"),
        ({}, {"byteLength": 49}, "ends before that|its buffer view has"),
        ({}, {"byteOffset": 8}, "ends before that|its buffer view has"),
        ({}, {"buffer": 1}, "from 0 to 0"),
    ],
)
def test_what_is_out_of_bounds_is_refused(accessor: dict[str, Any], view: dict[str, Any], words: str) -> None:
    good = {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"}
    with pytest.raises(InputError, match=words):
        _read(_gltf(good | accessor, [{"buffer": 0, "byteLength": 48} | view], bytes(48)))


def test_numbers_must_be_finite() -> None:
    data = np.array([1.0, np.nan, np.inf], "<f4").tobytes()
    accessor = {"bufferView": 0, "componentType": 5126, "count": 1, "type": "VEC3"}
    with pytest.raises(InputError, match="not finite"):
        _read(_gltf(accessor, [{"buffer": 0, "byteLength": 12}], data))
