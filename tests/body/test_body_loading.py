import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from avatar_builder import MIXAMO, UNREAL, Recipe, build, json_of
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid_bytes, load_with_surface
from elbowroom.body.loading.settings import LoadSettings
from elbowroom.body.loading.size import crown_of
from elbowroom.errors import InputError
from elbowroom.formats.packing import write_glb
from hanim_builder import HanimRecipe, build_hanim
from odd_bodies import box_body
from sampled import sampled
from shared_data import SHARED, needs_shared


def _changed(recipe: Recipe, change: Callable[[dict[str, Any]], object]) -> bytes:
    glb = build(recipe)
    content = json_of(glb)
    change(content)
    size = int.from_bytes(glb[12:16], "little")
    return write_glb(content, glb[28 + size :])


def _node(content: dict[str, Any], name: str) -> dict[str, Any]:
    return next(node for node in content["nodes"] if node["name"] == name)


def _human_bones(content: dict[str, Any]) -> Any:
    extensions = content["extensions"]
    return (extensions.get("VRMC_vrm") or extensions["VRM"])["humanoid"]["humanBones"]


def test_meta_data_of_both_vrm_versions() -> None:
    new = load_humanoid_bytes(build(Recipe(vrm="1", mesh=False)), "a.vrm")
    assert (new.meta.title, new.meta.authors, new.meta.format) == ("Made", ("A", "B"), "VRM 1.0")
    assert new.meta.licence == "https://vrm.dev/licenses/1.0/"
    old = load_humanoid_bytes(build(Recipe(vrm="0", heading=np.pi, mesh=False)), "b.vrm")
    assert (old.name, old.meta.title, old.meta.authors, old.meta.licence) == ("b", "Made", ("A",), "CC0")
    assert old.meta.format == "VRM 0.x"
    assert old.rig is not None
    assert old.rig.facing == np.pi


def test_old_thumb_names_are_renamed() -> None:
    def add_thumb(content: dict[str, Any]) -> None:
        hand = _node(content, "leftHand")
        first = len(content["nodes"])
        hand["children"] = [first]
        for number, bone in enumerate(("Proximal", "Intermediate", "Distal")):
            content["nodes"].append(
                {"name": f"t{number}", "translation": [0.03, 0, 0], "children": [first + number + 1]}
            )
            _human_bones(content).append({"bone": f"leftThumb{bone}", "node": first + number})
        del content["nodes"][-1]["children"]

    names = load_humanoid_bytes(_changed(Recipe(vrm="0"), add_thumb), "a.vrm").skeleton.names
    assert [name for name in names if "Thumb" in name] == [
        "leftThumbMetacarpal",
        "leftThumbProximal",
        "leftThumbDistal",
    ]


def test_centimetres_are_found_from_the_height() -> None:
    humanoid = load_humanoid_bytes(build(Recipe(names=MIXAMO, unit=100.0, mesh=False)), "cm.glb")
    assert humanoid.rig is not None
    assert humanoid.rig.scale == 0.01
    assert 1.4 < humanoid.skeleton.height < 1.7


@pytest.mark.parametrize(
    ("recipe", "change", "words"),
    [
        (Recipe(vrm="1"), lambda c: _human_bones(c)["spine"].update(node=999), "spine.node is 999"),
        (Recipe(vrm="1"), lambda c: _human_bones(c)["spine"].update(node="3"), "spine.node is '3'"),
        (Recipe(vrm="1"), lambda c: _human_bones(c).pop("leftHand"), "leftHand"),
        (Recipe(vrm="1"), lambda c: _human_bones(c)["spine"].update(_human_bones(c)["hips"]), "is both"),
        (Recipe(vrm="1"), lambda c: c["extensions"].update(VRMC_vrm=[]), "must be an object"),
        (Recipe(vrm="0"), lambda c: _human_bones(c)[2].pop("node"), "node is missing"),
        (Recipe(vrm="0"), lambda c: _human_bones(c).append(dict(_human_bones(c)[0])), "twice"),
        (Recipe(vrm="0"), lambda c: _human_bones(c)[3].update(bone=7), "must be a text"),
        (Recipe(), lambda c: _node(c, "neck").update(children=[]), "head .* must hang below the node of neck"),
        (Recipe(), lambda c: c.pop("nodes"), "has no nodes"),
        (Recipe(), lambda c: c["nodes"][3].update(children=[1]), "already hangs"),
        (Recipe(), lambda c: c["nodes"][0].update(children=[]) or c["nodes"][9].update(children=[1]), "circle"),
        (Recipe(), lambda c: c["nodes"][2].update(translation=[0, "1", 0]), "list of 3 numbers"),
        (Recipe(), lambda c: c["nodes"][2].update(rotation=[0, 0, 0, 0]), "unit quaternion"),
        (Recipe(), lambda c: c["nodes"][2].update(scale=[1, 2, 1]), "same along all axes"),
        (Recipe(), lambda c: c["nodes"][2].update(scale=[-1, -1, -1]), "positive"),
        (Recipe(), lambda c: c["nodes"][0].update(scale=[1e5, 1e5, 1e5]), "units above the feet"),
        (Recipe(), lambda c: _node(c, "leftLowerArm").update(translation=[0, 0, 0]), "same place"),
        (Recipe(), lambda c: c["nodes"][0].update(rotation=[0.7071068, 0, 0, 0.7071068]), "upright"),
        (Recipe(), lambda c: c["accessors"][0].update(count=10**12), "whole number"),
        (Recipe(), lambda c: c["accessors"][0].update(count=10**6), "its buffer view has"),
        (Recipe(), lambda c: c["skins"][0].update(joints=[1]), "points to joint"),
        (Recipe(), lambda c: c["meshes"][0]["primitives"][0]["attributes"].update(POSITION=1), "type"),
        (Recipe(), lambda c: c["asset"].update(version="1.0"), "'2.0'"),
    ],
)
def test_a_wrong_file_gets_one_line(recipe: Recipe, change: Callable[[dict[str, Any]], object], words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        load_humanoid_bytes(_changed(recipe, change), "wrong.glb")
    assert str(caught.value).startswith("wrong.glb")
    assert "\n" not in str(caught.value)


def test_swapped_sides_are_noticed() -> None:
    swapped = {bone: bone.replace("left", "right") if bone.startswith("left") else bone.replace("right", "left")
               for bone in UNREAL}  # fmt: skip
    with pytest.raises(InputError, match="swapped"):
        load_humanoid_bytes(build(Recipe(names=swapped)), "mirror.glb")


def _turned(recipe: Recipe, degrees: float, axis: int = 0) -> bytes:
    """The file with everything turned about an axis."""
    turn = [0.0, 0.0, 0.0, float(np.cos(np.deg2rad(0.5 * degrees)))]
    turn[axis] = float(np.sin(np.deg2rad(0.5 * degrees)))
    return _changed(recipe, lambda content: content["nodes"][0].update(rotation=turn))


@pytest.mark.parametrize("axis", [0, 2])
def test_a_figure_that_leans_is_stood_up(axis: int) -> None:
    upright = load_humanoid_bytes(build(Recipe(names=MIXAMO, mesh=False)), "a.glb").skeleton
    humanoid = load_humanoid_bytes(_turned(Recipe(names=MIXAMO, mesh=False), 48.0, axis), "a.glb")
    found, expected = (skeleton.positions - skeleton.positions[0] for skeleton in (humanoid.skeleton, upright))
    assert np.allclose(found, expected, atol=0.01)
    assert any("leans by 4" in note for note in humanoid.meta.notes)


@pytest.mark.parametrize(("vrm", "degrees"), [("1", 48.0), ("0", 48.0), ("1", 90.0), ("", 75.0), ("", 180.0)])
def test_a_figure_that_lies_is_refused_as_not_upright(vrm: str, degrees: float) -> None:
    recipe = Recipe(vrm=vrm, heading=np.pi if vrm == "0" else 0.0)
    with pytest.raises(InputError, match=r"does not stand upright, it leans by \d+ degrees"):
        load_humanoid_bytes(_turned(recipe, degrees), "lies.vrm")


@pytest.mark.parametrize(("unit", "head"), sampled([(0.18, 0.5), (1.0, 0.26), (0.36, 0.26), (0.7, 0.5), (1.5, 0.5)], 2))
def test_a_vrm_is_in_metres(unit: float, head: float, tmp_path: Path) -> None:
    path = tmp_path / "box.vrm"
    path.write_bytes(build(Recipe(vrm="1", body=box_body(head), unit=unit)))
    humanoid, surface = load_with_surface(path)
    assert humanoid.rig is not None
    assert humanoid.rig.scale == 1.0
    assert crown_of(humanoid, surface) == pytest.approx(unit * box_body(head).points[:, 1].max(), abs=0.01 * unit)
    true = crown_of(humanoid, surface)
    again, surface = load_with_surface(path, LoadSettings(height=true))
    assert crown_of(again, surface) == pytest.approx(true)


@pytest.mark.long
@pytest.mark.parametrize("unit", sampled([100.0, 0.1, 2.2]))
def test_a_vrm_of_no_walkers_size_is_refused_and_can_be_scaled(unit: float, tmp_path: Path) -> None:
    path = tmp_path / "box.vrm"
    path.write_bytes(build(Recipe(vrm="1", body=box_body(), unit=unit)))
    with pytest.raises(InputError, match=r"m tall \(a VRM is in metres\): avatars of 0.3 to 3 m can walk; --height"):
        load_with_surface(path)
    humanoid, surface = load_with_surface(path, LoadSettings(height=1.7))
    assert crown_of(humanoid, surface) == pytest.approx(1.7)


@pytest.mark.parametrize(
    ("data", "name", "words"),
    [
        (b"", "a.glb", "a.glb is empty"),
        (b"", "a.wrl", "a.wrl is empty"),
        (b"\x00\x01\x02\x03\x04", "a.glb", "begins with the bytes 00 01 02 03 04"),
        (b'{"asset"', "a.gltf", "line 1, column 9 is not as JSON goes on"),
        (b'{"a": "\xff"}', "a.gltf", "its byte 7 is not UTF-8 text"),
        (b'{"a": ' + b"1" * 5000 + b"}", "a.gltf", "too large a number"),
        (b"\x1f\x8bxxxx", "a.x3dz", "its gzip data are damaged"),
        (b'{"asset": {"version": "2.0"}, "nodes": [{"name": "a"}]}', "a.gltf", "no skeleton of a humanoid"),
    ],
)
def test_messages_are_for_people(data: bytes, name: str, words: str) -> None:
    with pytest.raises(InputError) as caught:
        load_humanoid_bytes(data, name)
    assert words in str(caught.value)
    assert "bones.json" not in str(caught.value)
    assert "b'" not in str(caught.value)


def test_a_scale_is_told_by_the_name_of_its_node() -> None:
    text = build_hanim(HanimRecipe("vrml", "2.0", points=4)).decode()
    name = 'name "l_hip"'
    assert name in text
    with pytest.raises(InputError, match="the scale of the node 'l_hip' is"):
        load_humanoid_bytes(text.replace(name, f"{name} scale 1 2 1").encode(), "a.wrl")


def test_a_picture_that_is_missing_and_one_of_elsewhere_are_told_apart(tmp_path: Path) -> None:
    text = build_hanim(HanimRecipe("vrml", "2.0", points=4)).decode()
    for url, why in (("skin.png", "there is no such file beside the scene"), ("http://a.b/c.png", "only files beside")):
        path = tmp_path / "a.wrl"
        path.write_text(
            text.replace("appearance Appearance {", f'appearance Appearance {{ texture ImageTexture {{ url "{url}" }}')
        )
        assert any(why in note for note in Humanoid.load(path).meta.notes), url


def test_misplaced_optional_bones_are_left_out_with_a_note() -> None:
    def move_toes(content: dict[str, Any]) -> None:
        _human_bones(content)["leftToes"]["node"] = len(content["nodes"])
        content["nodes"].append({"name": "stray"})

    humanoid = load_humanoid_bytes(_changed(Recipe(vrm="1"), move_toes), "a.vrm")
    assert not humanoid.skeleton.has("leftToes")
    assert any("leftToes" in note for note in humanoid.meta.notes)


def test_more_than_three_spine_nodes_are_thinned() -> None:
    def add_spines(content: dict[str, Any]) -> None:
        for number in (1, 2, 3):
            _node(content, f"spine_0{number}")["name"] = f"spine_0{2 * number - 1}"
        for number in (2, 4):
            below, above = _node(content, f"spine_0{number - 1}"), len(content["nodes"])
            content["nodes"].append({"name": f"spine_0{number}", "children": below["children"]})
            below["children"] = [above]

    skeleton = load_humanoid_bytes(_changed(Recipe(names=UNREAL), add_spines), "ue5.glb").skeleton
    assert {"spine", "chest", "upperChest"} <= set(skeleton.names)


def test_a_gltf_with_neighbouring_buffer(tmp_path: Path) -> None:
    glb = build(Recipe(names=MIXAMO))
    content = json_of(glb)
    size = int.from_bytes(glb[12:16], "little")
    content["buffers"][0]["uri"] = "body data.bin".replace(" ", "%20")
    (tmp_path / "body data.bin").write_bytes(glb[28 + size :])
    (tmp_path / "figure.gltf").write_text(json.dumps(content))
    humanoid = Humanoid.load(tmp_path / "figure.gltf")
    again = load_humanoid_bytes(glb, "figure.glb")
    assert np.array_equal(humanoid.capsules.radii, again.capsules.radii)
    assert humanoid.glb is not None
    assert np.array_equal(load_humanoid_bytes(humanoid.glb, "x").capsules.radii, again.capsules.radii)
    assert humanoid.source == tmp_path / "figure.gltf"


@pytest.mark.parametrize("name", ["there_is_none.vrm", "", "\0"])
def test_a_path_without_a_file(tmp_path: Path, name: str) -> None:
    with pytest.raises(InputError):
        Humanoid.load(tmp_path / name)


@needs_shared
@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("malformed_vrm/malformed_glb_json.vrm", "JSON part cannot be read"),
        ("malformed_vrm/nonobject_vrm_extension.vrm", "must be an object"),
        ("malformed_vrm/unmapped_humanoid_node.vrm", "spine.node is 999"),
    ],
)
def test_real_files_that_are_refused(name: str, words: str) -> None:
    assert SHARED is not None
    with pytest.raises(InputError, match=words):
        Humanoid.load(SHARED / "avatars" / name)


@pytest.mark.long
@needs_shared
def test_a_real_avatar_that_needs_meshopt_and_quantisation() -> None:
    assert SHARED is not None
    humanoid, surface = load_with_surface(SHARED / "avatars" / "glb" / "VALID_AIAN_M_1_Casual.glb")
    assert len(surface.vertices.positions) > 30_000
    assert surface.vertices.positions[:, 1].min() == pytest.approx(0.0, abs=0.02)
    assert 1.7 < crown_of(humanoid, surface) < 1.9
    assert not any("average proportions" in note for note in humanoid.meta.notes)
