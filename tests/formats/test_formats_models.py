"""Models of any format become one glTF: recognised by content, files beside them bounded, damage told in one line."""

import contextlib
from pathlib import Path

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from elbowroom.errors import InputError
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.models import model as models
from elbowroom.formats.models.kinds import ModelKind, kind_of
from elbowroom.formats.models.model import Model, parse_model, read_model
from elbowroom.formats.models.recognised import is_of_a_place, may_be_a_place
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.packing import write_glb
from elbowroom.formats.triangles import triangle_mesh
from hanim_builder import HanimRecipe, build_hanim
from place_builder import TWO_ROOMS, glb

TWO_TRIANGLES = """mtllib colours.mtl
o one
v 0 0 0
v 1 0 0
v 0 1 0
usemtl red
f 1 2 3
o two
v 0 0 5
v 1 0 5
v 0 1 5
usemtl red
f 4 5 6
"""


def triangles(model: Model) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    """The corners (T, 3, 3) of what a model shows, in its own frame."""
    tree = read_nodes(model.gltf)
    mesh = triangle_mesh(model.gltf, tree)
    matrices = tree.world_matrices(tree.rotations)[mesh.nodes[:, 0]]
    points = np.einsum("vij,vj->vi", matrices[:, :3, :3], mesh.offsets[:, 0]) + matrices[:, :3, 3]
    return np.asarray(points[mesh.triangles])


@pytest.mark.parametrize(
    ("kind", "text"), [("stl", False), ("stl", True), ("ply", False), ("ply", True), ("obj", True)]
)
def test_loose_triangles_are_where_another_library_wrote_them(tmp_path: Path, kind: str, text: bool) -> None:
    ball = trimesh.creation.icosphere(subdivisions=1, radius=2.0)
    ball.apply_translation((1.0, 2.0, 3.0))
    options = {} if kind == "obj" else {"file_type": {"stl": "stl_ascii"}.get(kind, kind)} if text else {}
    if kind == "ply":
        options["encoding"] = "ascii" if text else "binary"
    (tmp_path / f"a.{kind}").write_bytes(_bytes(ball.export(**({"file_type": kind} | options))))
    model = read_model(tmp_path / f"a.{kind}")
    assert model.kind.name.lower() == kind
    found = triangles(model)
    assert len(found) == len(ball.faces)
    middles = np.sort(found.mean(axis=1), axis=0)
    assert middles == pytest.approx(np.sort(ball.triangles.mean(axis=1), axis=0), abs=1e-5)


@pytest.mark.parametrize("corner", ["{v}", "{v}//{n}", "{v}/{t}/{n}"])
def test_an_obj_may_count_its_corners_back(corner: str) -> None:
    rng = np.random.default_rng(5)
    front: list[str] = []
    back: list[str] = []
    for part in range(1, 9):
        lines = [f"v {x} {y} {z}" for x, y, z in rng.uniform(-3.0, 3.0, (4, 3))]
        lines += [f"vt {x} {y}" for x, y in rng.uniform(0.0, 1.0, (2, 2))] + ["vn 0 1 0"]
        corners = [(4 * part - 3 + i, 2 * part - i % 2, part) for i in range(4)]
        told = [" ".join(corner.format(v=v, t=t, n=n) for v, t, n in corners)]
        told += [" ".join(corner.format(v=i - 4, t=-1 - i % 2, n=-1) for i in range(4))]
        for file, face in zip((front, back), told, strict=True):
            file += [*lines, f"f {face}"]
    expected, found = (triangles(parse_model("\r\n".join(file).encode(), "a.obj")) for file in (front, back))
    assert len(found) == 16
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize(("before", "after"), [("\n", "\r"), ("\n", "\r\n"), (" ", "\t"), (" ", "  ")])
def test_words_and_lines_of_an_obj_are_apart_by_whatever_is_usual(before: str, after: str) -> None:
    found = triangles(parse_model(TWO_TRIANGLES.replace(before, after).encode(), "a.obj"))
    np.testing.assert_array_equal(found, triangles(parse_model(TWO_TRIANGLES.encode(), "a.obj")))


def _bytes(data: bytes | str) -> bytes:
    return data.encode() if isinstance(data, str) else data


def areas(found: NDArray[np.float64]) -> NDArray[np.float64]:
    """Those of triangles (T, 3, 3)."""
    sides = np.cross(found[:, 1] - found[:, 0], found[:, 2] - found[:, 0])
    found_areas: NDArray[np.float64] = 0.5 * np.linalg.norm(sides, axis=1)
    return found_areas


@pytest.mark.parametrize("first", range(6))
@pytest.mark.parametrize("corner", ["{0}", "{0}/1", "{0}//1", "-{1}"])
def test_a_floor_of_an_obj_with_a_corner_that_is_left_out_covers_no_more_than_itself(first: int, corner: str) -> None:
    ring = [(0, 0), (4, 0), (4, 3), (2, 3), (2, 1), (0, 1)]  # 8 square metres of 12
    order = np.roll(np.arange(6), first)
    file = ["vt 0 0", "vn 0 1 0", *(f"v {x} 0 {z}" for x, z in ring), "v 9 0 0", "v 9 0 1", "v 8 0 0"]
    file += ["f " + " ".join(corner.format(n + 1, 9 - n) for n in order), "f 7 8 9"]
    found = triangles(parse_model("\n".join(file).encode(), "a.obj"))
    assert len(found) == 5
    assert areas(found).sum() == pytest.approx(8.0 + 0.5)
    middles = found.mean(axis=1)
    assert not np.any((middles[:, 0] < 2.0) & (middles[:, 2] > 1.0))


def test_a_face_of_four_corners_may_have_a_dent(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 3 0 0\nv 1 0 1\nv 0 0 3\nf 2 3 4 1\nf 4 1 2 3\nf 1 2 3\n")
    found = triangles(read_model(tmp_path / "a.obj"))
    assert areas(found).sum() == pytest.approx(2 * 3.0 + 1.5)


def test_an_obj_keeps_the_names_of_its_objects_and_its_colours(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text(TWO_TRIANGLES)
    (tmp_path / "colours.mtl").write_text("newmtl red\nKd 1 0 0\nmap_Kd none.png\n")
    model = read_model(tmp_path / "a.obj")
    names = {node.at("name").text() for node in model.gltf.root.at("nodes").items()}
    assert any("one" in name for name in names)
    assert any("two" in name for name in names)
    material = model.gltf.root.at("materials").items()[0].value
    assert material["pbrMetallicRoughness"]["baseColorFactor"][:3] == [1.0, 0.0, 0.0]
    assert model.notes == ("'none.png' is left out: there is no such file in the model's folder",)


@pytest.mark.parametrize("escape", ["../colours.mtl", "/etc/hostname", "..\\colours.mtl"])
def test_files_elsewhere_are_never_read(tmp_path: Path, escape: str) -> None:
    (tmp_path / "colours.mtl").write_text("newmtl red\nKd 1 0 0\n")
    inner = tmp_path / "inner"
    inner.mkdir()
    (inner / "a.obj").write_text(TWO_TRIANGLES.replace("colours.mtl", escape))
    model = read_model(inner / "a.obj")
    assert "left out" in model.notes[0]
    sent = parse_model((inner / "a.obj").read_bytes(), "a.obj")
    assert "left out" in sent.notes[0]


def test_content_goes_before_the_name(tmp_path: Path) -> None:
    assert kind_of(glb(TWO_ROOMS), "a.obj") is ModelKind.GLTF
    assert kind_of(b"#VRML V2.0 utf8\n", "a.stl") is ModelKind.X3D
    assert kind_of(b"v 0 0 0\n", "a.txt") is None
    assert kind_of(b"solid wood is not STL", "a.txt") is None


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("a.obj", b"v 0 0\nf 1 2 9\n"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -9\n"),
        ("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"),
        ("a.obj", b"nothing"),
        ("a.obj", b"v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n"),
        ("a.stl", b"solid a\nfacet normal 0 0 1\nvertex"),
        ("a.ply", b"ply\nformat ascii 1.0\nelement vertex 99999999999\nend_header\n"),
        ("a.glb", b"glTF\x02\x00\x00\x00"),
        ("a.blend", b"BLENDER-v300"),
        ("a.bin", b""),
    ],
)
def test_what_is_damaged_or_unknown_is_told_in_one_line(name: str, data: bytes) -> None:
    with pytest.raises(InputError) as told:
        parse_model(data, name)
    assert str(told.value).startswith(name)
    assert "\n" not in str(told.value)


def test_what_the_library_thinks_of_a_damaged_file_is_not_printed(capfd: pytest.CaptureFixture[str]) -> None:
    box = bytes(trimesh.creation.box().export(file_type="stl"))
    with pytest.raises(InputError):
        parse_model(b"solid " + box[6:80] + b"\xff\xff\xff\x7f" + box[84:], "cut.stl")
    wide = "solid a\nfacet normal 0 0 0\nouter loop\n" + "vertex 1e300 0 -1e300\n" * 3 + "endloop\nendfacet\nendsolid a"
    with contextlib.suppress(InputError):
        parse_model(wide.encode(), "wide.stl")
    assert capfd.readouterr() == ("", "")


def test_a_file_that_is_too_large_is_refused_unread(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(models, "MAX_BYTES", 100)
    (tmp_path / "a.glb").write_bytes(glb(TWO_ROOMS))
    with pytest.raises(InputError, match="at most 0 MB are read"):
        read_model(tmp_path / "a.glb")


def test_a_world_with_a_humanoid_in_it_is_read_whole(tmp_path: Path) -> None:
    alone = build_hanim(HanimRecipe()).decode()
    box = "<Transform translation='5 0 0'><Shape><Box size='1 1 1'/></Shape></Transform>"
    both = alone.replace("<Scene>", f"<Scene>{box}", 1)
    found = triangles(parse_model(both.encode(), "a.x3d"))
    others = triangles(parse_model(alone.encode(), "a.x3d"))
    assert len(found) == len(others) + 12
    assert found[..., 0].max() == pytest.approx(5.5)


def test_models_without_a_skeleton_are_places(tmp_path: Path) -> None:
    (tmp_path / "room.glb").write_bytes(glb(TWO_ROOMS))
    (tmp_path / "room.wrl").write_text("#VRML V2.0 utf8\nShape { geometry Box {} }\n")
    (tmp_path / "who.x3d").write_text(build_hanim(HanimRecipe()).decode())
    assert is_of_a_place(tmp_path / "room.glb")
    assert is_of_a_place(tmp_path / "room.wrl")
    assert not is_of_a_place(tmp_path / "who.x3d")
    assert not is_of_a_place(tmp_path / "missing.glb")


def test_a_place_may_have_a_flag_that_bends() -> None:
    gltf = parse_gltf(glb(TWO_ROOMS), "rooms.glb")
    content = dict(gltf.root.value)
    binary = bytes(gltf.buffers[0] or b"")
    content["skins"] = [{"joints": [1]}]
    content["nodes"][0]["skin"] = 0
    assert may_be_a_place(write_glb(content, binary), "rooms.glb")
    for node in content["nodes"]:
        node["skin"] = 0
    assert not may_be_a_place(write_glb(content, binary), "rooms.glb")
