"""Places in USD, held against what Pixar's own library says of them; files elsewhere, damage, and what nobody sees."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pxr import Gf, Usd, UsdGeom, UsdUtils

from elbowroom.clips.files import is_motion_only
from elbowroom.errors import InputError
from elbowroom.formats.models.kinds import ModelKind, kind_of
from elbowroom.formats.models.model import parse_model, read_model
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.places.reading import parse_place, read_place

QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def crate(stage: Any, path: str, middle: tuple[float, ...], size: tuple[float, ...]) -> Any:
    cube = UsdGeom.Cube.Define(stage, path)
    cube.GetSizeAttr().Set(1.0)
    form = UsdGeom.XformCommonAPI(cube)
    form.SetTranslate(Gf.Vec3d(*middle))
    form.SetRotate(Gf.Vec3f(0.0, 0.0, 30.0))
    form.SetScale(Gf.Vec3f(*size))
    return cube


def mesh(stage: Any, path: str, counts: list[int], corners: list[int], points: Any = None) -> Any:
    made = UsdGeom.Mesh.Define(stage, path)
    cube = [[x, y, z] for x in (0.0, 30.0) for y in (0.0, 20.0) for z in (0.0, 200.0)]
    made.GetPointsAttr().Set([Gf.Vec3f(*map(float, point)) for point in (cube if points is None else points)])
    made.GetFaceVertexCountsAttr().Set(counts)
    made.GetFaceVertexIndicesAttr().Set(corners)
    return made


def hall(file: Path) -> Path:
    """A floor, a door, solids of every kind and some that stand many times over: Z up, in centimetres."""
    stage = Usd.Stage.CreateNew(str(file))
    UsdGeom.SetStageUpAxis(stage, "Z")
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    crate(stage, "/Hall/Floor", (0.0, 0.0, -10.0), (800.0, 800.0, 20.0))
    crate(stage, "/Hall/Hidden", (0.0, 0.0, 900.0), (10.0, 10.0, 10.0)).GetVisibilityAttr().Set("invisible")
    crate(stage, "/Hall/Guide", (0.0, 0.0, 900.0), (10.0, 10.0, 10.0)).GetPurposeAttr().Set("guide")
    mesh(stage, "/Hall/Door_1/Leaf", [4] * 6, [corner for quad in QUADS for corner in quad])
    for number, kind in enumerate(("Cylinder", "Cone", "Capsule", "Sphere")):
        solid = getattr(UsdGeom, kind).Define(stage, f"/Hall/{kind}")
        solid.GetRadiusAttr().Set(20.0)
        if kind != "Sphere":
            solid.GetHeightAttr().Set(150.0)
            solid.GetAxisAttr().Set("XYZ"[number])
        UsdGeom.XformCommonAPI(solid).SetTranslate(Gf.Vec3d(100.0 * number - 150.0, 250.0, 100.0))
    many = UsdGeom.PointInstancer.Define(stage, "/Hall/Many")
    crate(stage, "/Hall/Many/Post", (0.0, 5.0, 0.0), (10.0, 10.0, 120.0))
    many.GetPrototypesRel().SetTargets(["/Hall/Many/Post"])
    many.GetProtoIndicesAttr().Set([0, 0, 0])
    many.GetPositionsAttr().Set([Gf.Vec3f(x, -300.0, 60.0) for x in (-200.0, 0.0, 350.0)])
    UsdGeom.XformCommonAPI(many).SetRotate(Gf.Vec3f(0.0, 0.0, 10.0))
    stage.Save()
    return file


def written(tmp_path: Path, make: Callable[[Any], object]) -> bytes:
    stage = Usd.Stage.CreateInMemory()
    UsdGeom.SetStageUpAxis(stage, "Y")
    make(stage)
    file = tmp_path / "made.usda"
    file.write_text(stage.ExportToString())
    return file.read_bytes()


@pytest.mark.parametrize("ending", ["usda", "usdc", "usd", "usdz"])
def test_a_place_stands_as_pixars_library_says(tmp_path: Path, ending: str) -> None:
    file = hall(tmp_path / ("hall.usdc" if ending == "usdz" else f"hall.{ending}"))
    if ending == "usdz":
        assert UsdUtils.CreateNewUsdzPackage(str(file), str(tmp_path / "hall.usdz"))
        file = tmp_path / "hall.usdz"
    place = read_place(file)
    assert place.told == ("+Z is up, as the file says", "a unit is 0.01 m, as the file says")
    stage = Usd.Stage.Open(str(file))
    boxes = UsdGeom.BBoxCache(Usd.TimeCode.EarliestTime(), ["default", "render"])
    for name in ("Floor", "Leaf", "Cylinder", "Cone", "Capsule", "Sphere", "Many"):
        path = "/Hall/Door_1/Leaf" if name == "Leaf" else f"/Hall/{name}"
        wanted = boxes.ComputeWorldBound(stage.GetPrimAtPath(path)).ComputeAlignedRange()
        own = [part for part in place.parts if part.name == ("Post" if name == "Many" else name)]
        points = 100.0 * np.concatenate([part.vertices for part in own])
        points = np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)
        found = [points.min(axis=0), points.max(axis=0)]
        np.testing.assert_allclose(found, [wanted.GetMin(), wanted.GetMax()], atol=1.0, err_msg=name)
    assert {part.name for part in place.parts}.isdisjoint({"Hidden", "Guide"})
    assert len([part for part in place.parts if part.name == "Post"]) == 3


def test_what_hangs_on_a_dropped_prim_is_dropped(tmp_path: Path) -> None:
    place = read_place(hall(tmp_path / "hall.usda"), PlaceOptions(drop=("Door_*",)))
    assert "Leaf" not in {part.name for part in place.parts}


def test_sent_bytes_are_read_as_the_file_is(tmp_path: Path) -> None:
    file = hall(tmp_path / "hall.usdc")
    sent = parse_place(file.read_bytes(), "sent.usd")
    assert sent.triangles == read_place(file).triangles
    assert kind_of(file.read_bytes(), "whatever") is ModelKind.USD


def test_faces_of_any_number_of_corners_and_holes(tmp_path: Path) -> None:
    ring = [[np.cos(a), 0.0, np.sin(a)] for a in np.linspace(0.0, 2 * np.pi, 6, endpoint=False)]

    def make(stage: Any) -> None:
        made = mesh(stage, "/A", [6, 3, 4, 2], [0, 1, 2, 3, 4, 5, 0, 1, 2, 0, 1, 2, 3, 0, 1], ring)
        made.GetHoleIndicesAttr().Set([1])

    place = parse_place(written(tmp_path, make), "a.usda", PlaceOptions(scale=1.0))
    assert place.triangles == 4 + 2


def test_a_face_with_a_dent_covers_no_more_than_itself(tmp_path: Path) -> None:
    ring = [[0, 0, 0], [4, 0, 0], [4, 0, 3], [2, 0, 3], [2, 0, 1], [0, 0, 1]]

    def make(stage: Any) -> None:
        mesh(stage, "/A", [6, 3], [4, 5, 0, 1, 2, 3, 0, 1, 2], ring)

    place = parse_place(written(tmp_path, make), "a.usda", PlaceOptions(scale=1.0))
    corners = place.parts[0].vertices[place.parts[0].faces]
    sides = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert 0.5 * np.linalg.norm(sides, axis=1).sum() == pytest.approx(8.0 + 6.0)


@pytest.mark.parametrize(
    ("counts", "corners", "said"),
    [
        ([3], [0, 1, 8], "names a point that is not there"),
        ([3], [0, 1, -1], "names a point that is not there"),
        ([3, 3], [0, 1, 2], "6 corners; 3 are told"),
        ([-3], [0, 1, 2], "corners"),
        ([], [], "shows no triangles"),
    ],
)
def test_wrong_meshes_are_told(tmp_path: Path, counts: list[int], corners: list[int], said: str) -> None:
    data = written(tmp_path, lambda stage: mesh(stage, "/A", counts, corners))
    with pytest.raises(InputError, match=said) as told:
        parse_model(data, "a.usda")
    assert str(told.value).startswith("a.usda: ")
    assert "\n" not in str(told.value)


@pytest.mark.parametrize("asset", ["/etc/hostname", "../outside.usda", "https://example.org/a.usd", "beside.usda"])
def test_files_elsewhere_are_never_read(tmp_path: Path, asset: str) -> None:
    inner = tmp_path / "inner"
    inner.mkdir()
    hall(inner / "beside.usda")
    hall(tmp_path / "outside.usda")
    stage = Usd.Stage.CreateNew(str(inner / "a.usda"))
    stage.DefinePrim("/Room").GetReferences().AddReference(asset, "/Hall")
    stage.Save()
    with pytest.raises(InputError, match="must be one file"):
        parse_model((inner / "a.usda").read_bytes(), "a.usda")
    if asset == "beside.usda":
        assert len(read_place(inner / "a.usda").parts) == len(read_place(inner / "beside.usda").parts)
    else:
        with pytest.raises(InputError, match="only files in the model's own folder"):
            read_model(inner / "a.usda")


def test_damage_is_told_in_one_line(tmp_path: Path) -> None:
    whole = hall(tmp_path / "hall.usdc").read_bytes()
    rng = np.random.default_rng(0)
    for size in rng.integers(8, len(whole), 20):
        with pytest.raises(InputError) as told:
            parse_model(whole[:size], "cut.usdc")
        assert "\n" not in str(told.value)
    with pytest.raises(InputError, match=r"a\.usda: is no USD file that can be read"):
        parse_model(b"#usda 1.0\ndef {{{", "a.usda")


def test_without_the_library_it_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pxr", None)
    with pytest.raises(InputError, match=r"pip install 'elbowroom\[usd\]'"):
        parse_model(b"#usda 1.0\n", "a.usda")


def test_a_place_is_no_motion(tmp_path: Path) -> None:
    assert not is_motion_only(hall(tmp_path / "hall.usda").read_bytes(), "hall.usda")
    assert not is_motion_only(hall(tmp_path / "hall.usdc").read_bytes(), "hall.usdc")
    assert is_motion_only(b'#usda 1.0\ndef SkelRoot "A" {}\n', "a.usda")
