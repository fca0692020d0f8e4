import base64
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pygltflib
import pytest

from avatar_builder import Recipe, build, json_of
from elbowroom.errors import InputError
from elbowroom.formats.gltf import parse_gltf, read_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.packing import pack_glb, write_glb
from elbowroom.formats.triangles import triangle_mesh

GLB = build(Recipe(vrm="1"))
EMPTY: dict[str, Any] = {"asset": {"version": "2.0"}}


def _binary(glb: bytes) -> bytes:
    return glb[28 + int.from_bytes(glb[12:16], "little") :]


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "is empty"),
        (b"PK\x03\x04 zip", "is a ZIP archive: it is neither a GLB .*; unpack it"),
        (b"Kaydara FBX Binary  \x00", "is an FBX model: .*; Blender can open it and save it as .glb"),
        (b"Pmx \x00\x00\x00@", "is an MMD model: .*add-on"),
        (b"<?xml version='1.0'?><COLLADA version='1.4.1'>", "is a COLLADA model: "),
        (GLB[:8], "at least 20"),
        (GLB[:-1], "cut off"),
        (GLB[:4] + struct.pack("<I", 1) + GLB[8:], "version 1"),
        (GLB[:12] + struct.pack("<I", 2**31) + GLB[16:], "claims"),
        (GLB[:16] + b"NOPE" + GLB[20:], "no JSON chunk"),
        (b"glTF" + struct.pack("<II", 2, 20) + struct.pack("<I4s", 0, b"JSON"), "cannot be read"),
        (b'{"asset": {"version": "2.0"}, "nodes": [' + b"[" * 100_000, "nested too deeply|cannot be read"),
        (b'{"asset": {"version": "2.0"}, "x": NaN}', "NaN is not a JSON number"),
        (b'{"asset": {"version": "2.0"}, "x": ' + b"9" * 10_000 + b"}", "cannot be read"),
        (b"{\xff}", "cannot be read"),
        (b'{"asset": []}', "must be an object"),
        (b"{}", "version is missing"),
        (b'{"asset": {"version": "2.0"}, "buffers": [{}]}', "byteLength is missing"),
        (b'{"asset": {"version": "2.0"}, "buffers": 3}', "must be a list"),
    ],
)
def test_a_broken_container_gets_one_line(data: bytes, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        parse_gltf(data, "broken.glb")
    assert str(caught.value).startswith("broken.glb")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "uri",
    [
        "https://example.org/a.bin",
        "file:///etc/hostname",
        "/etc/hostname",
        "../a.bin",
        "%2e%2e/a.bin",
        "a/../../a.bin",
        "C:\\a.bin",
        "link.bin",
        "missing.bin",
        "data:application/octet-stream;base64,@@@",
        "data:nothing",
        7,
    ],
)
def test_only_files_in_the_same_folder_are_read(tmp_path: Path, uri: object) -> None:
    inside = tmp_path / "inside"
    inside.mkdir()
    (tmp_path / "a.bin").write_bytes(b"secret!!")
    (inside / "link.bin").symlink_to(tmp_path / "a.bin")
    content = EMPTY | {"buffers": [{"byteLength": 4, "uri": uri}]}
    (inside / "figure.gltf").write_text(json.dumps(content))
    with pytest.raises(InputError, match=r"buffers\[0\].uri"):
        read_gltf(inside / "figure.gltf")


def test_an_upload_must_not_refer_to_files() -> None:
    content = EMPTY | {"buffers": [{"byteLength": 4, "uri": "a.bin"}]}
    with pytest.raises(InputError, match="embedded"):
        parse_gltf(json.dumps(content).encode(), "figure.gltf")


def test_a_whole_glb_is_packed_unchanged() -> None:
    assert pack_glb(parse_gltf(GLB, "a.glb")) is GLB


def test_a_picture_on_the_network_is_refused(tmp_path: Path) -> None:
    content = json_of(GLB) | {"images": [{"uri": "https://example.org/face.png"}]}
    (tmp_path / "figure.vrm").write_bytes(write_glb(content, _binary(GLB)))
    with pytest.raises(InputError, match="same folder"):
        pack_glb(read_gltf(tmp_path / "figure.vrm"))


def test_scattered_buffers_and_images_are_packed_into_one_glb(tmp_path: Path) -> None:
    binary = _binary(GLB)
    content = json_of(GLB)
    views = content["bufferViews"]
    half = views[2]["byteOffset"]
    for view in views[2:]:
        view["buffer"], view["byteOffset"] = 1, view["byteOffset"] - half
    content["buffers"] = [
        {"byteLength": half, "uri": "data:application/octet-stream;base64," + base64.b64encode(binary[:half]).decode()},
        {"byteLength": len(binary) - half, "uri": "rest.bin"},
    ]
    content["images"] = [{"uri": "skin.png"}]
    (tmp_path / "rest.bin").write_bytes(binary[half:])
    (tmp_path / "skin.png").write_bytes(b"\x89PNG not really")
    (tmp_path / "figure.gltf").write_text(json.dumps(content))
    packed = pack_glb(read_gltf(tmp_path / "figure.gltf"))
    assert "uri" not in json.dumps(json_of(packed))
    original, again = parse_gltf(GLB, "a"), parse_gltf(packed, "b")
    assert again.glb == packed
    for one, other in zip(
        (triangle_mesh(original, read_nodes(original))).__dict__.values(),
        (triangle_mesh(again, read_nodes(again))).__dict__.values(),
        strict=True,
    ):
        assert np.array_equal(one, other)
    judged = pygltflib.GLTF2.load_from_bytes(packed)
    image = judged.bufferViews[judged.images[0].bufferView]
    assert judged.binary_blob()[image.byteOffset : image.byteOffset + image.byteLength] == b"\x89PNG not really"


def test_nodes_too_deep_or_too_many() -> None:
    deep = EMPTY | {"nodes": [{"children": [i + 1]} for i in range(300)] + [{}]}
    with pytest.raises(InputError, match="deep"):
        read_nodes(parse_gltf(write_glb(deep, b""), "deep.glb"))
    many = EMPTY | {"nodes": [{}] * 20_001}
    with pytest.raises(InputError, match="at most 20000"):
        read_nodes(parse_gltf(write_glb(many, b""), "many.glb"))


def test_a_matrix_is_taken_apart() -> None:
    rng = np.random.default_rng(0)
    axes, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    axes *= np.sign(np.linalg.det(axes))
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = axes * [1.0, 2.0, 3.0], [4.0, 5.0, 6.0]
    nodes: list[dict[str, Any]] = [{"matrix": matrix.T.ravel().tolist(), "children": [1]}, {"translation": [1, 0, 0]}]
    tree = read_nodes(parse_gltf(write_glb(EMPTY | {"nodes": nodes}, b""), "a.glb"))
    assert np.allclose(tree.world_matrices(tree.rotations)[0], matrix)
    assert np.allclose(tree.world_matrices(tree.rotations)[1, :3, 3], matrix[:3, 3] + axes[:, 0])
    nodes[0]["matrix"] = (matrix + np.eye(4, k=1)).T.ravel().tolist()
    with pytest.raises(InputError, match="without shear"):
        read_nodes(parse_gltf(write_glb(EMPTY | {"nodes": nodes}, b""), "a.glb"))
