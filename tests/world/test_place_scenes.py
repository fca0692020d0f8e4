"""Scenes of models of places: what stands where, documents that need no file, files beside a scene and nowhere else."""

import json
from importlib.resources import files
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

from elbowroom.body.root import RootState
from elbowroom.errors import InputError
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.triangles import triangle_mesh
from elbowroom.world.obstacles.shapes import Box, Mesh
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.places.shown import shown_glb
from elbowroom.world.scene import Scene
from place_builder import TWO_ROOMS, Boxes, write_place

SCHEMA = json.loads((files("elbowroom.world") / "data" / "scene.schema.json").read_text("utf-8"))
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)
OPEN = PlaceOptions(drop=("Door_*",))
RAISED: Boxes = {name: (np.add(middle, (3.0, 1.0, -2.0)), size) for name, (middle, size) in TWO_ROOMS.items()}


@pytest.fixture
def rooms(tmp_path: Path) -> Path:
    return write_place(tmp_path / "rooms.glb")


def document(**place: Any) -> dict[str, Any]:
    return {"format": "elbowroom-scene", "version": 1, "name": "rooms", "place": {"file": "rooms.glb", **place}}


def clearance(scene: Scene, x: float, z: float) -> float:
    """Of a slim upright capsule."""
    return scene.obstacles.clearance(
        np.array([[[0.0], [0.3], [0.0], [0.0], [1.5], [0.0]]], np.float32), [0.1], (x, z), 0.0
    )


def test_what_stands_in_a_model_stands_in_the_way(rooms: Path) -> None:
    scene = Scene.load(rooms, OPEN)
    assert "Door_1" not in scene.obstacles.names
    assert clearance(scene, 1.0, 1.0) == pytest.approx(0.1 - 0.1, abs=1e-5)  # the table's side at x = 1.1
    assert clearance(scene, 0.0, 4.0) == pytest.approx(0.4 - 0.1, abs=1e-5)  # in the doorway
    assert clearance(scene, scene.start.x, scene.start.z) > 0.1
    assert not scene.finished(scene.start)


def test_the_floor_comes_to_height_0_wherever_the_file_has_it(tmp_path: Path, rooms: Path) -> None:
    low, high = Scene.load(rooms, OPEN), Scene.load(write_place(tmp_path / "raised.glb", RAISED), OPEN)
    assert high.place is not None
    assert high.place.options.ground == pytest.approx(1.0, abs=0.02)
    for x, z in ((0.0, 4.0), (1.0, 1.0), (-0.5, 6.0)):
        assert clearance(high, x + 3.0, z - 2.0) == pytest.approx(clearance(low, x, z), abs=1e-5)


def test_what_is_passable_is_in_nobodys_way(rooms: Path) -> None:
    scene = Scene.load(rooms, PlaceOptions(passable=("Door_*",)))
    assert clearance(scene, 0.0, 4.0) == pytest.approx(0.3, abs=1e-5)
    assert clearance(Scene.load(rooms), 0.0, 4.0) <= 0.0


def test_a_document_needs_no_file_and_is_the_same_scene(rooms: Path) -> None:
    scene = Scene.load(rooms, OPEN)
    text = json.dumps(scene.to_dict())
    VALIDATOR.validate(json.loads(text))
    rooms.unlink()
    again = Scene.from_dict(json.loads(text))
    assert json.dumps(again.to_dict()) == text
    assert again.obstacles.names == scene.obstacles.names
    ours_floor, their_floor = (each.place.floor for each in (scene, again) if each.place is not None)
    assert ours_floor is not None
    assert their_floor is not None
    assert np.array_equal(ours_floor.there, their_floor.there)
    assert ours_floor.there.any()
    for ours, theirs in zip(scene.obstacles.shapes, again.obstacles.shapes, strict=True):
        assert isinstance(ours, Mesh)
        assert isinstance(theirs, Mesh)
        assert np.array_equal(ours.vertices, theirs.vertices)
        assert np.array_equal(ours.faces, theirs.faces)


def test_a_scene_file_names_a_model_and_adds_to_it(rooms: Path) -> None:
    told = document(drop=["Door_*"]) | {
        "start": {"position": [-1, 1], "heading": 0.1},
        "finish": {"position": [0, 7]},
        "obstacles": [{"type": "box", "name": "crate", "center": [0, 0.5, 6], "size": [0.5, 1, 0.5]}],
    }
    VALIDATOR.validate(told)
    (rooms.parent / "scene.json").write_text(json.dumps(told))
    scene = Scene.load(rooms.parent / "scene.json")
    assert scene.start == RootState(x=-1.0, z=1.0, heading=0.1)
    assert scene.obstacles.names[-1] == "crate"
    assert isinstance(scene.obstacles.shapes[-1], Box)
    assert clearance(scene, 0.0, 6.0) < 0.0
    written = scene.to_dict()
    assert [row["name"] for row in written["obstacles"]] == ["crate"]
    assert Scene.from_dict(written).to_dict() == written


def test_the_least_document_is_enough(rooms: Path) -> None:
    (rooms.parent / "scene.json").write_text(json.dumps(document()))
    assert Scene.load(rooms.parent / "scene.json").obstacles.names == Scene.load(rooms).obstacles.names


@pytest.mark.parametrize(
    "file", ["../rooms.glb", "/etc/passwd", "C:rooms.glb", "a\\rooms.glb", "inner/../../rooms.glb"]
)
def test_a_scene_names_files_of_its_own_folder_only(rooms: Path, file: str) -> None:
    inner = rooms.parent / "inner"
    inner.mkdir(exist_ok=True)
    (inner / "scene.json").write_text(json.dumps(document(file=file)))
    with pytest.raises(InputError, match=r"\$\.place\.file is .*own folder"):
        Scene.load(inner / "scene.json")


def test_a_link_out_of_the_folder_is_not_followed(rooms: Path) -> None:
    inner = rooms.parent / "inner"
    inner.mkdir()
    (inner / "rooms.glb").symlink_to(rooms)
    (inner / "scene.json").write_text(json.dumps(document()))
    with pytest.raises(InputError, match="own folder"):
        Scene.load(inner / "scene.json")


def test_a_document_without_a_folder_reads_no_file() -> None:
    with pytest.raises(InputError, match="must be loaded from a file"):
        Scene.from_dict(document())


def test_another_file_than_was_meant_is_refused(rooms: Path) -> None:
    digest = Scene.load(rooms).to_dict()["place"]["sha256"]
    (rooms.parent / "scene.json").write_text(json.dumps(document(sha256=digest)))
    assert Scene.load(rooms.parent / "scene.json").place is not None
    write_place(rooms, RAISED)
    with pytest.raises(InputError, match=r"rooms\.glb has changed"):
        Scene.load(rooms.parent / "scene.json")


def _carried(**fields: Any) -> dict[str, Any]:
    """A place that carries no part."""
    return {"parts": [], "data": "eJwDAAAAAAE=", **fields}


@pytest.mark.parametrize(
    "place",
    [
        {"file": ""},
        {"scale": 0},
        {"up": "w"},
        {"drop": "Door"},
        {"drop": [""]},
        {"sha256": "abc"},
        {"colour": "red"},
        {"data": "AAAA"},
        {"data": "AAAA", "parts": [["a", 3, 1, 0, 0, 0]]},
        {"data": "AAAA", "parts": [["a", 3, 1]]},
        {"data": "AAAA", "parts": [["a", 6000000, 2000000, 0, 0, 0]] * 100},
        {"ground": 1e9},
        _carried(floor={"origin": [0, 0], "cell": 0.05, "shape": [2, 2], "data": "!"}),
        _carried(floor={"origin": [0, 0], "cell": 0.05, "shape": [200, 2], "data": "eJxjAAAAAQAB"}),
        _carried(floor={"origin": [0, 0], "cell": 0.05, "shape": [1000000, 1000000], "data": "eJxjAAAAAQAB"}),
        _carried(floor={"origin": [0], "cell": 0.05, "shape": [2, 2], "data": "eJxjAAAAAQAB"}),
        _carried(floor={"cell": 0.05}),
    ],
)
def test_wrong_places_are_told_in_one_line(rooms: Path, place: dict[str, Any]) -> None:
    with pytest.raises(InputError) as told:
        Scene.from_dict(document(**place), "scene.json", rooms.parent)
    assert str(told.value).startswith(("scene.json: ", "scale", "up"))
    assert "\n" not in str(told.value)


def test_packed_parts_that_point_astray_are_refused(rooms: Path) -> None:
    written = Scene.load(rooms).to_dict()
    written["place"]["parts"][0][1] += 1
    with pytest.raises(InputError, match="data"):
        Scene.from_dict(written)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("room.glb", b"glTF\x02\x00\x00\x00\xff\xfe"),
        ("room.gltf", b'{"asset": {"version": "2.0"}}'),
        ("room.obj", b"v 0 0 0\n"),
        ("room.x3d", b'<?xml version="1.0"?>\n<X3D version="4.0"/>'),
        ("room.wrl", b"#VRML V2.0 utf8\n"),
        ("room.stl", b"\x00" * 84),
        ("room.ply", b"ply\n"),
    ],
)
def test_a_model_without_anything_in_it_is_refused(tmp_path: Path, name: str, content: bytes) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=name) as told:
        Scene.load(tmp_path / name)
    assert "\n" not in str(told.value)


def test_what_a_viewer_is_given_stands_where_the_obstacles_stand(rooms: Path) -> None:
    scene = Scene.load(write_place(rooms, RAISED), PlaceOptions(drop=("Door_*",), passable=("Table",)))
    assert scene.place is not None
    assert scene.place.place is not None
    shown = parse_gltf(shown_glb(scene.place.place, scene.place.options.ground or 0.0), "shown.glb")
    tree = read_nodes(shown)
    mesh = triangle_mesh(shown, tree)
    matrices = tree.world_matrices(tree.rotations)[mesh.nodes[:, 0]]
    points = np.einsum("vij,vj->vi", matrices[:, :3, :3], mesh.offsets[:, 0]) + matrices[:, :3, 3]
    named = {tree.names[node] for node in np.unique(mesh.nodes[:, 0])}
    assert named == set(TWO_ROOMS) - {"Door_1"}
    for name, shape, center, _ in scene.obstacles:
        assert isinstance(shape, Mesh)
        seen = points[[tree.names[node] == name for node in mesh.nodes[:, 0]]]
        assert np.sort(seen, axis=0) == pytest.approx(np.sort(shape.vertices + center, axis=0), abs=1e-4)


def test_the_schema_holds_for_scenes_without_a_model_as_before() -> None:
    with pytest.raises(jsonschema.ValidationError):
        VALIDATOR.validate({"format": "elbowroom-scene", "version": 1, "name": "nothing"})
    with pytest.raises(InputError, match="lacks the field 'ground'"):
        Scene.from_dict({"format": "elbowroom-scene", "version": 1, "name": "nothing"})
