"""Scenes: stock data, round trips, and one clear complaint for each wrong field."""

import copy
import json
import math
import re
from importlib.resources import files
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest

from elbowroom.body.root import RootState
from elbowroom.errors import InputError
from elbowroom.geometry import quaternion
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.places.options import PlaceOptions
from elbowroom.world.scene import MAX_FILE_BYTES, Gate, Scene

SCHEMA = json.loads((files("elbowroom.world") / "data" / "scene.schema.json").read_text("utf-8"))
VALIDATOR = jsonschema.Draft202012Validator(SCHEMA)


CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0.5, 0.7]]
TRACK = [{"center": [-3, 0.5, 4], "seconds": 2}, {"center": [-3, 0.5, 5], "seconds": 2}]


STANDING = [
    {"type": "sphere", "name": "four", "center": [3, 1, 3], "radius": 0.3},
    {"type": "capsule", "center": [3, 1, 4], "radius": 0.2, "length": 0.9, "yaw": 0.1},
    {"type": "cylinder", "center": [3, 1, 5], "radius": 0.2, "height": 0.9, "euler": [0.4, 0, 0]},
    {"type": "hull", "center": [3, 0, 6], "points": CORNERS, "rotation": [0, 0.6, 0, 0.8]},
    {"type": "mesh", "center": [3, 0, 7], "vertices": CORNERS, "faces": [[0, 1, 2], [0, 2, 1]], "yaw": 0.1},
]
MOVING = [
    {"type": "sphere", "radius": 0.2, "track": TRACK},
    {"type": "capsule", "radius": 0.2, "length": 1, "track": TRACK},
    {"type": "cylinder", "radius": 0.2, "height": 1, "track": TRACK},
    {"type": "hull", "name": "wedge", "points": CORNERS, "track": TRACK, "repeat": "once"},
]


def document(standing: list[Any] = STANDING, moving: list[Any] = MOVING) -> dict[str, Any]:
    """A document that uses every field of the format, and every shape."""
    made = {
        "$schema": "scene.schema.json",
        "format": "elbowroom-scene",
        "version": 1,
        "name": "test",
        "title": "A test",
        "description": "Nothing special",
        "ground": {"size": [8, 10.5], "center": [0, 3]},
        "start": {"position": [0, -1], "heading": 0.5},
        "finish": {"position": [1, 5], "heading": 0.25, "width": 3},
        "tour": [{"position": [0, 1]}, {"position": [1, 2.5, 4], "view": "side", "say": "Look up.", "seconds": 2.5}],
        "obstacles": [
            {"type": "box", "name": "one", "center": [1, 1, 2], "size": [0.5, 1, 0.5], "yaw": 0.3},
            {"type": "box", "center": [-1, 1, 2], "size": [0.5, 1, 0.5], "euler": [0.1, 0.2, 0.3]},
            {"type": "box", "name": "three", "center": [0, 2, 3], "size": [2, 0.1, 0.1], "rotation": [0, 0, 0, 1]},
            *standing,
        ],
        "moving": [
            {
                "type": "box",
                "name": "trolley",
                "size": [0.5, 1, 0.8],
                "repeat": "pingpong",
                "track": [{"center": [3, 0.5, 4], "yaw": 0.2, "seconds": 2}, {"center": [3, 0.5, 6], "seconds": 1}],
            },
            *moving,
        ],
    }
    return dict(json.loads(json.dumps(made)))  # no two parts of it are one object


def spots(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """The paths of all values in a document."""
    children = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path] + [spot for key, child in children for spot in spots(child, (*path, key))]


def replaced(source: Any, path: tuple[Any, ...], value: Any) -> Any:
    out = copy.deepcopy(source)
    if not path:
        return value
    parent = out
    for key in path[:-1]:
        parent = parent[key]
    parent[path[-1]] = value
    return out


def removed(source: Any, path: tuple[Any, ...]) -> Any:
    out = copy.deepcopy(source)
    parent = out
    for key in path[:-1]:
        parent = parent[key]
    del parent[path[-1]]
    return out


STRANGERS: list[Any] = [
    None, True, "", "box", "x" * 5000, 0, -1, 1, 0.5, 7, 1e9, -1e9, math.inf, [], [0], [0, 0], [0, 0, 0], [1, 1, 1],
    [0.1, 0.2, 0.1, 0.2], [0, 0.6, 0, 0.8], [0, 0, 0, 2], ["a", "b"], [True, 1], {}, {"type": "box"},
    {"size": [1, 1]}, {"position": [3, 3]},
]  # fmt: skip


def mutants() -> list[Any]:
    """All mutants of a document of boxes, and those of each other shape in a document that has nothing else."""
    plain, bare, out = document([], []), {**document([], []), "obstacles": [], "moving": [], "tour": []}, []
    for base, places in (
        (plain, spots(plain)),
        *(({**bare, "obstacles": [one]}, spots(one, ("obstacles", 0))) for one in STANDING),
        *(({**bare, "moving": [one]}, spots(one, ("moving", 0))) for one in MOVING),
    ):
        for path in places:
            out += mutated(base, path)
    return out


def mutated(base: Any, path: tuple[Any, ...]) -> list[Any]:
    """A document with something else at a path, with nothing there, and with a field too many."""
    out = [replaced(base, path, value) for value in STRANGERS]
    if path:
        out.append(removed(base, path))
    target: Any = base
    for key in path:
        target = target[key]
    if isinstance(target, dict):
        out += [replaced(base, path, {**target, extra: 0.1}) for extra in ("yaw", "colour", "rotation", "$schema")]
    return out


SAID_BY_NO_SCHEMA = (
    "stands in the obstacle",
    "leads on at",
    "off the ground",
    "lies behind it already",
    "lie in a plane",
    "a corner that is not there",
)


def _read_unless_start_is_blocked(mutant: Any) -> None:
    """The rules that a schema cannot state: start and finish lie on the ground and apart, and such."""
    try:
        Scene.from_dict(mutant)
    except InputError as error:
        if not any(rule in str(error) for rule in SAID_BY_NO_SCHEMA):
            raise


PARTS = 16  # of the mutants, the first of which is looked at every time


@pytest.mark.parametrize("part", [0, *(pytest.param(part, marks=pytest.mark.long) for part in range(1, PARTS))])
def test_reader_and_published_schema_agree_on_every_mutant(part: int) -> None:
    VALIDATOR.check_schema(SCHEMA)
    verdicts = set()
    for mutant in mutants()[part::PARTS]:
        wanted = VALIDATOR.is_valid(mutant)
        verdicts.add(wanted)
        if wanted:
            _read_unless_start_is_blocked(mutant)
        else:
            with pytest.raises(InputError) as error:
                Scene.from_dict(mutant, "some.json")
            assert str(error.value).startswith("some.json: $")
            assert "\n" not in str(error.value)
            assert len(str(error.value)) < 300
    assert verdicts == {True, False}


@pytest.mark.parametrize(
    ("path", "value", "parts"),
    [
        (("obstacles", 2, "size", 1), -0.1, ["$.obstacles[2].size[1] is -0.1", "above 0 and at most 1000"]),
        (("obstacles", 0, "yaw"), 45, ["$.obstacles[0].yaw is 45", "radians", "0.7854"]),
        (("obstacles", 0, "color"), "red", ["$.obstacles[0].color", "must be a colour"]),
        (("obstacles", 0, "tpye"), "box", ["unknown field", "did you mean 'type'"]),
        (("obstacles", 1, "type"), "cone", ['$.obstacles[1].type is "cone"', "one of box, sphere, capsule"]),
        (("obstacles", 1, "type"), "sphere", ["$.obstacles[1]", "lacks the field 'radius'"]),
        (("obstacles", 3, "yaw"), 0.1, ["$.obstacles[3] has an unknown field", "yaw"]),
        (("obstacles", 5, "height"), 0, ["$.obstacles[5].height is 0", "above 0"]),
        (("obstacles", 6, "points"), CORNERS[:3], ["$.obstacles[6].points has 3 points", "4 to 128"]),
        (("obstacles", 6, "points", 3), [0.4, 0.4, 0], ["$.obstacles[6].points lie in a plane", "1 mm"]),
        (("moving", 4, "points", 0, 1), "0", ["$.moving[4].points[0][1]", "must be a number"]),
        (("obstacles", 1, "yaw"), 0.0, ["$.obstacles[1] has both yaw and euler"]),
        (("obstacles", 2, "rotation"), [0.1, 0, 0, 0], ["$.obstacles[2].rotation", "unit quaternion"]),
        (("version",), 2, ["$.version is 2", "must be 1"]),
        (("start", "position"), [1.0, 2.0], ["$.start.position", "stands in the obstacle 'one'"]),
        (("finish", "position"), [0, 60], ["$.finish.position is [0.0, 60.0]", "m off the ground"]),
        (("start", "position"), [-40, 0], ["$.start.position is [-40.0, 0.0]", "m off the ground"]),
        (("finish", "position"), [0, -1], ["$.finish", "the start lies behind it already"]),
        (("start", "heading"), math.nan, ["$.start.heading is NaN", "must be a number"]),
        (("ground", "size"), [1, 2, 3], ["$.ground.size", "list of 2 numbers"]),
        (("name",), "", ["$.name", "1 to 100 characters"]),
    ],
)
def test_a_wrong_field_is_named_with_its_value_and_the_mend(
    path: tuple[Any, ...], value: Any, parts: list[str]
) -> None:
    with pytest.raises(InputError) as error:
        Scene.from_dict(replaced(document(), path, value), "hall.json")
    for part in ["hall.json", *parts]:
        assert part in str(error.value)


def test_what_was_read_is_what_is_written() -> None:
    scene = Scene.from_dict(document())
    again = Scene.from_dict(json.loads(json.dumps(scene.to_dict())))
    assert again.to_dict() == scene.to_dict()
    assert VALIDATOR.is_valid(scene.to_dict())
    np.testing.assert_array_equal(again.obstacles.standing.rows, scene.obstacles.standing.rows)
    assert scene.obstacles.standing_names == (
        "one",
        "box 2",
        "three",
        "four",
        "capsule 5",
        "cylinder 6",
        "hull 7",
        "mesh 8",
    )
    assert scene.start == RootState(x=0.0, z=-1.0, heading=0.5)
    assert scene.finish == Gate((1.0, 5.0), 0.25, 3.0)


def test_rotations_mean_what_the_schema_says() -> None:
    scene = Scene.from_dict(document())
    x, y, z = (quaternion.to_matrix(quaternion.about_axis(axis, 0.1 + 0.1 * axis)) for axis in range(3))
    np.testing.assert_allclose(quaternion.to_matrix(scene.obstacles.rotations[1]), y @ x @ z, atol=1e-12)
    np.testing.assert_allclose(scene.obstacles.rotations[0], [0.0, math.sin(0.15), 0.0, math.cos(0.15)], atol=1e-12)
    np.testing.assert_allclose(scene.obstacles.half_sizes[0], [0.25, 0.5, 0.25])


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("", "line 1, column 1"),
        ('{"a": 1,}', "line 1, column 9"),
        ('{"a": 1, "a": 2}', "stands twice"),
        ('{"a": NaN}', "NaN is not a JSON number"),
        ("[" * 100_000, "nested too deeply"),
        ('{"a": ' + "9" * 5000 + "}", "too large a number"),
        ("[]", "$ is []"),
        (json.dumps({**document(), "obstacles": [document()["obstacles"][0]] * 10_001}), "at most 10000"),
    ],
)
def test_a_broken_file_gives_one_line(tmp_path: Path, text: str, part: str) -> None:
    path = tmp_path / "broken.json"
    path.write_text(text, "utf-8")
    with pytest.raises(InputError) as error:
        Scene.load(path)
    assert str(path) in str(error.value)
    assert part in str(error.value)
    assert "\n" not in str(error.value)


def test_files_that_are_no_text_too_big_or_absent(tmp_path: Path) -> None:
    path = tmp_path / "x.json"
    with pytest.raises(InputError, match="cannot be read"):
        Scene.load(path)
    path.write_bytes(b'{"name": "\xff"}')
    with pytest.raises(InputError, match="UTF-8"):
        Scene.load(str(path))
    with path.open("wb") as file:
        file.truncate(MAX_FILE_BYTES + 1)
    with pytest.raises(InputError, match=f"at most {MAX_FILE_BYTES}"):
        Scene.load(path)
    path.write_bytes(b"\xef\xbb\xbf" + json.dumps(document()).encode())
    assert Scene.load(path).name == "test"


@pytest.mark.parametrize(
    ("name", "content", "kind"),
    [
        ("room.json", b"glTF\x02\x00\x00\x00\xff\xfe", "a glTF model"),
        ("alice.vrm", b"glTF\x02\x00\x00\x00", "a VRM avatar, which walks by --avatar"),
        ("room.json", b'{"asset": {"version": "2.0"}}', "a glTF model"),
        ("room.ifc", b"\nISO-10303-21;\nHEADER;", "an IFC or STEP model"),
        ("room.dae", b'<COLLADA version="1.4.1"/>', "a COLLADA model"),
        ("room.fbx", b"Kaydara FBX Binary  \x00", "an FBX model"),
        ("run.elbow", b"ELBOWROOM RECORDING 2\n", "a recording"),
        ("walk.bvh", b"HIERARCHY\nROOT Hips\n", "a BVH motion"),
        ("room.svg", b"<svg/>", "an XML file"),
    ],
)
def test_what_is_no_scene_is_called_what_it_is(tmp_path: Path, name: str, content: bytes, kind: str) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=f"{name}: is {kind}.*; a scene is a JSON file or a model") as error:
        Scene.load(tmp_path / name)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", ["missing.glb", "missing.json", "missing.x3d"])
def test_a_missing_file_is_missing(name: str) -> None:
    with pytest.raises(InputError, match=f"{name}: cannot be read: No such file"):
        Scene.load(name)


def test_the_shapes_in_the_guide_are_read() -> None:
    guide = (Path(__file__).parents[2] / "docs" / "scenes.md").read_text("utf-8")
    told = [json.loads(text) for text in re.findall(r'`({"type": .*?})`', guide)]
    assert {one["type"] for one in told} == {"box", "sphere", "capsule", "cylinder", "hull", "mesh"}
    scene = Scene.from_dict({**document([], []), "obstacles": told, "moving": []})
    VALIDATOR.validate(scene.to_dict())
    assert len(scene.obstacles) == len(told)


def test_stock_scenes_by_name() -> None:
    assert Scene.stock_names() == ("a", "b", "c", "d", "beam", "empty", "shapes", "doorway", "traffic")
    assert Scene.load("D").name == "d"
    with pytest.raises(InputError, match=r"stock scene \(a, b, c, d, beam, empty, shapes, doorway, traffic\)"):
        Scene.load("e")


@pytest.mark.parametrize("name", Scene.stock_names())
def test_a_stock_scene_is_valid_and_lies_on_its_ground(name: str) -> None:
    text = (files("elbowroom.world") / "data" / "scenes" / f"{name}.json").read_text("utf-8")
    VALIDATOR.validate(json.loads(text))
    scene = Scene.load(name)
    assert not scene.finished(scene.start)
    way = scene.finish.position[1] - scene.start.z
    assert scene.finished(RootState(x=0.0, z=scene.start.z + way + 0.01))
    low = np.array(scene.ground_center) - 0.5 * np.array(scene.ground_size)
    corners = scene.obstacles.corners[..., [0, 2]].reshape(-1, 2)
    assert np.all(corners >= low)
    assert np.all(corners <= low + scene.ground_size)


@pytest.mark.parametrize(("name", "count"), [("a", 4), ("b", 4), ("c", 4), ("d", 6), ("beam", 4), ("empty", 0)])
def test_the_papers_scenes_leave_the_straight_way_free_for_the_legs(name: str, count: int) -> None:
    scene = Scene.load(name)
    assert len(scene.obstacles) == count
    z = scene.start.z + np.linspace(0.0, scene.finish.position[1] - scene.start.z + 1.0, 200)
    legs = np.stack([0 * z, 0 * z + 0.24, z, 0 * z, 0 * z + 0.8, z])
    assert np.all(clearance(legs[None], np.array([0.24]), scene.obstacles.standing) > 0.0)


def test_a_gate_is_crossed_in_its_direction_and_width() -> None:
    gate = Gate((1.0, 2.0), math.pi / 2, 2.0)
    assert gate.passed(1.1, 2.9)
    assert not gate.passed(0.9, 2.0)
    assert not gate.passed(1.1, 3.1)


def test_a_scene_made_in_code_is_one_of_a_file() -> None:
    post = {"type": "box", "name": "post", "center": [1.0, 1.0, 2.0], "size": [0.2, 2.0, 0.2], "yaw": 0.5}
    scene = Scene.of("posts", [post], finish=(3.0, 4.0), start=(0.0, 1.0))
    assert (scene.name, scene.title, scene.obstacles.standing_names) == ("posts", "posts", ("post",))
    assert scene.start.heading == scene.finish.heading == pytest.approx(np.pi / 4.0)
    assert scene.ground_center == (1.5, 2.5)
    assert scene.ground_size == (19.0, 19.0)
    assert Scene.from_dict(scene.to_dict()).to_dict() == scene.to_dict()
    with pytest.raises(InputError, match=r"posts: \$.obstacles\[0\] lacks the field 'size'"):
        Scene.of("posts", [{"type": "box", "center": [1.0, 1.0, 2.0]}], finish=(3.0, 4.0))


def test_how_a_model_is_read_is_not_told_of_other_scenes() -> None:
    with pytest.raises(InputError, match="c: how a model is read is told in the scene's own"):
        Scene.load("c", PlaceOptions(scale=2.0))


@pytest.mark.parametrize("place", [None, 5, (), (1.0, 2.0, 3.0), "ab", ("a", "b"), (None, 1.0)])
@pytest.mark.parametrize("name", ["start", "finish"])
def test_a_scene_in_code_has_places_of_two_numbers(name: str, place: Any) -> None:
    places: dict[str, Any] = {"start": (0.0, 0.0), "finish": (0.0, 5.0), name: place}
    with pytest.raises(InputError, match=f"x: {name} is ") as caught:
        Scene.of("x", [], **places)
    assert "\n" not in str(caught.value)
