"""Bones are found in rigs of many tools by name, and by shape alone where names say nothing."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from avatar_builder import MIXAMO, UNREAL, Recipe, build, json_of
from elbowroom.body.bone_mapping.conventions import CONVENTIONS, Convention, plain
from elbowroom.body.bone_mapping.file_nodes import FileNodes
from elbowroom.body.bone_mapping.mapping import map_bones
from elbowroom.body.bone_mapping.override import override_nodes, parse_override
from elbowroom.body.bone_mapping.spelling import simplified
from elbowroom.body.bones import REQUIRED
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid_bytes, load_with_surface
from elbowroom.body.loading.settings import LoadSettings
from elbowroom.body.loading.size import crown_of
from elbowroom.errors import InputError
from elbowroom.formats.packing import write_glb
from odd_bodies import SKELETON
from sampled import sampled
from shared_data import SHARED, needs_shared


def _nodes(names: Callable[[str], str], controls: bool = False, seed: int = 0) -> FileNodes:
    """The nodes of `SKELETON` under other names, shuffled, below a root; with IK targets if asked for."""
    rng = np.random.default_rng(seed)
    rows = [("scene", -1, np.zeros(3))]
    rows += [
        (names(bone), int(SKELETON.parents[j]) + 1, SKELETON.positions[j]) for j, bone in enumerate(SKELETON.names)
    ]
    if controls:
        for bone in ("leftFoot", "rightFoot", "leftHand", "rightHand"):
            rows.append((f"IK-{bone}", 0, SKELETON.positions[SKELETON.index(bone)]))
            rows.append((f"{bone}-pole", len(rows) - 1, SKELETON.positions[SKELETON.index(bone)] + 0.5))
    order = rng.permutation(len(rows))
    place = {int(old): new for new, old in enumerate(order)}
    chosen = [rows[int(old)] for old in order]
    return FileNodes(
        tuple(name for name, _, _ in chosen),
        np.array([place[parent] if parent >= 0 else -1 for _, parent, _ in chosen]),
        np.array([position for _, _, position in chosen]),
        frozenset(new for new, (name, _, _) in enumerate(chosen) if name != "scene"),
    )


def _told(convention: Convention) -> Callable[[str], str]:
    """The first name of each bone in a convention."""
    spine = convention.spine.split("|")

    def name(bone: str) -> str:
        if bone in convention.middle:
            return convention.middle[bone].split("|")[0]
        if bone in ("spine", "chest", "upperChest"):
            return spine[min(("spine", "chest", "upperChest").index(bone), len(spine) - 1)]
        side = 0 if bone.startswith("left") else 1
        stem = bone.removeprefix("left").removeprefix("right")
        names = convention.limbs.get(stem)
        return f"unnamed {bone}" if names is None else names.split("|")[0].replace("{}", convention.sides[side])

    return name


def _found_right(nodes: FileNodes, bones: dict[str, int]) -> None:
    for bone, node in bones.items():
        assert np.allclose(nodes.positions[node], SKELETON.positions[SKELETON.index(bone)]), bone


@pytest.mark.parametrize("convention", CONVENTIONS, ids=[convention.name for convention in CONVENTIONS])
@pytest.mark.parametrize("prefix", ["", "Armature|", "hero:"])
def test_each_table_names_its_own_rig(convention: Convention, prefix: str) -> None:
    told = _told(convention)
    nodes = _nodes(lambda bone: prefix + told(bone))
    mapping = map_bones(nodes)
    assert mapping.missing == ()
    _found_right(nodes, {bone: node for bone, node in mapping.nodes.items() if bone not in ("chest", "upperChest")})
    assert mapping.how["leftLowerArm"] == convention.name
    assert mapping.how["rightUpperLeg"] == convention.name


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("controls", [False, True])
def test_names_that_say_nothing_leave_the_shape(seed: int, controls: bool) -> None:
    nodes = _nodes(lambda bone: f"Bone.{SKELETON.index(bone):03d}", controls, seed)
    mapping = map_bones(nodes)
    assert mapping.missing == ()
    _found_right(nodes, mapping.nodes)
    assert set(mapping.how.values()) == {"topology"}


def test_the_shape_needs_no_t_pose_and_no_unit() -> None:
    glb = build(Recipe(names={bone: f"n{i}" for i, bone in enumerate(SKELETON.names)}, arms_down=1.1, elbows=0.8,
                       legs_apart=0.2, spin=True, unit=100.0))  # fmt: skip
    humanoid = load_humanoid_bytes(glb, "made.glb")
    named = {source.bone: source.name for source in humanoid.meta.bones}
    assert all(named[bone] == f"n{SKELETON.index(bone)}" for bone in REQUIRED)


@pytest.mark.long
def test_sides_without_names_come_from_the_toes() -> None:
    for heading in (0.0, np.pi):
        glb = build(Recipe(names={bone: f"n{i}" for i, bone in enumerate(SKELETON.names)}, heading=heading))
        humanoid = load_humanoid_bytes(glb, "made.glb")
        assert humanoid.rig is not None
        assert np.isclose(np.cos(humanoid.rig.facing), np.cos(heading))
        named = {source.bone: source.name for source in humanoid.meta.bones}
        assert named["leftHand"] == f"n{SKELETON.index('leftHand')}"


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("mixamorig:LeftForeArm", "left forearm"),
        ("mixamorig7:RightHandThumb1", "right handthumb1"),
        ("Armature|hand_l", "left hand"),
        ("J_Bip_L_UpperArm", "left upperarm"),
        ("DEF-upper_arm.R", "right upperarm"),
        ("Bip001 L Thigh", "left thigh"),
        ("thumb_01_r", "right thumb1"),
        ("spine_02", "spine2"),
        ("upperleg.l", "left upperleg"),
        ("", ""),
    ],
)
def test_names_are_simplified(name: str, expected: str) -> None:
    assert simplified(name) == expected


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ("mixamorig:LeftArm", "mixamorig7LeftArm"),
        ("Armature|DEF-upper_arm.L", "DEF-upper_armL"),
        ("Bip01 L Thigh", "Bip001_L_Thigh"),
        ("ValveBiped.Bip01_L_Thigh", "Bip01 L Thigh"),
    ],
)
def test_spellings_of_one_name(one: str, other: str) -> None:
    assert plain(one) == plain(other)


def test_the_override_has_the_last_word() -> None:
    nodes = _nodes(lambda bone: MIXAMO.get(bone, bone))
    other = nodes.names.index(MIXAMO["upperChest"])
    mapping = map_bones(nodes, {"chest": other, "leftToes": None})
    assert mapping.nodes["chest"] == other
    assert mapping.how["chest"] == "override"
    assert "leftToes" not in mapping.nodes
    assert "upperChest" not in mapping.nodes


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (b'{"hips": "nowhere"}', "hips"),
        (b'{"hip": "Hips"}', '"hip" is no bone'),
        (b'{"hips": 4000}', "hips is 4000"),
        (b'{"hips": [1]}', "hips"),
        (b'{"hips": "Hips", "spine": "Hips"}', "a node of its own"),
        (b'{"hips": "Twice"}', "only one node"),
        (b"[]", "not an object"),
        (b'{"hips": ', "cannot be read"),
    ],
)
def test_a_wrong_override_gets_one_line(text: bytes, words: str) -> None:
    nodes = _nodes(lambda bone: {"leftToes": "Twice", "rightToes": "Twice"}.get(bone, MIXAMO.get(bone, bone)))
    with pytest.raises(InputError, match=words) as caught:
        override_nodes(parse_override(text, "a.bones.json"), nodes)
    assert "\n" not in str(caught.value)
    assert "a.bones.json" in str(caught.value)


def test_an_override_beside_the_file_is_read(tmp_path: Path) -> None:
    (tmp_path / "a.glb").write_bytes(build(Recipe(names=UNREAL)))
    (tmp_path / "a.glb.bones.json").write_text('{"chest": "spine_03", "upperChest": null}')
    (tmp_path / "other.json").write_text('{"leftToes": null}')
    beside = {source.bone: source for source in Humanoid.load(tmp_path / "a.glb").meta.bones}
    assert (beside["chest"].name, beside["chest"].how) == ("spine_03", "override")
    told = Humanoid.load(tmp_path / "a.glb", LoadSettings(bones=tmp_path / "other.json"))
    assert not told.skeleton.has("leftToes")
    assert told.skeleton.has("upperChest")


def _without(bones: set[str], recipe: Recipe) -> bytes:
    """The file less some bones: their names are taken away and what hung on them is cut off."""
    glb = build(recipe)
    content = json_of(glb)
    for node in content["nodes"]:
        children = [c for c in node.get("children", []) if content["nodes"][c]["name"] not in bones]
        node.pop("children", None)
        if children:
            node["children"] = children
    for number, node in enumerate(content["nodes"]):
        if node["name"] in bones:
            node["name"] = f"cut{number}"
    size = int.from_bytes(glb[12:16], "little")
    content.pop("skins")
    for node in content["nodes"]:
        node.pop("skin", None)
        node.pop("mesh", None)
    return write_glb(content, glb[28 + size :])


def test_hands_and_feet_without_nodes_are_added() -> None:
    names = {bone: bone for bone in SKELETON.names}
    glb = _without({"leftHand", "rightHand", "leftFoot", "rightFoot"}, Recipe(names=names, arms_down=1.2))
    humanoid = load_humanoid_bytes(glb, "stumps.glb")
    how = {source.bone: source.how for source in humanoid.meta.bones}
    assert how["leftHand"] == how["rightFoot"] == "added"
    skeleton = humanoid.skeleton
    for bone in ("leftHand", "rightHand", "leftFoot", "rightFoot"):
        gap = skeleton.positions[skeleton.index(bone)] - SKELETON.positions[SKELETON.index(bone)]
        assert np.linalg.norm(gap - [0.0, gap[1], 0.0]) < 0.03
    again = load_humanoid_bytes(humanoid.glb or b"", "again.glb")
    assert np.allclose(again.skeleton.positions, skeleton.positions, atol=1e-6)


def test_arms_beside_the_spine_go_where_the_trunk_takes_them() -> None:
    glb = build(Recipe(names=UNREAL, spin=True, arms_down=0.7))
    content = json_of(glb)
    by_name = {node["name"]: i for i, node in enumerate(content["nodes"])}
    for side in "lr":
        _rehang(content, by_name[f"clavicle_{side}"], by_name["pelvis"])
    size = int.from_bytes(glb[12:16], "little")
    humanoid = load_humanoid_bytes(write_glb(content, glb[28 + size :]), "beside.glb")
    assert any("hung on" in note for note in humanoid.meta.notes)
    parent = int(humanoid.skeleton.parents[humanoid.skeleton.index("leftShoulder")])
    assert humanoid.skeleton.names[parent] == "upperChest"
    assert humanoid.rig is not None
    nodes = json_of(humanoid.glb or b"")["nodes"]
    chest, clavicle = (int(humanoid.rig.nodes[humanoid.skeleton.index(b)]) for b in ("upperChest", "leftShoulder"))
    assert clavicle in nodes[chest]["children"]


def _rehang(content: dict[str, list[dict[str, list[int]]]], node: int, parent: int) -> None:
    for other in content["nodes"]:
        if node in other.get("children", []):
            other["children"].remove(node)
    content["nodes"][parent]["children"].append(node)


_WORDS = {
    "hips": "pelvis",
    "spine": "spine",
    "chest": "chest",
    "upperChest": "upperChest",
    "neck": "neck",
    "head": "head",
}
_LIMBS = {"Shoulder": "clavicle", "UpperArm": "armUpper", "LowerArm": "armLower", "Hand": "hand",
          "UpperLeg": "legUpper", "LowerLeg": "legLower", "Foot": "foot", "Toes": "toe"}  # fmt: skip


@pytest.mark.parametrize("name", ["{}{}0001_bind_JNT", "{}{}_joint", "rig:{}{}_JNT", "{}{}Bone"])
def test_words_that_only_say_that_it_is_a_joint_are_passed_over(name: str) -> None:
    def called(bone: str) -> str:
        side = {"left": "L_", "right": "R_"}.get(bone.removesuffix(bone.removeprefix("left").removeprefix("right")), "")
        stem = bone.removeprefix("left").removeprefix("right")
        return name.format(side, _WORDS.get(bone) or _LIMBS[stem])

    nodes = _nodes(called)
    mapping = map_bones(nodes)
    _found_right(nodes, mapping.nodes)
    assert mapping.nodes.keys() >= REQUIRED
    assert "topology" not in mapping.how.values()


def _trunk_first(names: dict[str, str]) -> bytes:
    """A figure whose pelvis, with the legs on it, hangs on the first bone of the trunk."""
    glb = build(Recipe(names=names))
    content = json_of(glb)
    numbers = {node["name"]: number for number, node in enumerate(content["nodes"])}
    hips, spine, root = numbers[names["hips"]], numbers[names["spine"]], numbers["root"]
    _rehang(content, spine, root)
    _rehang(content, hips, spine)
    place = {number: content["nodes"][number]["translation"] for number in (hips, spine)}
    content["nodes"][spine]["translation"] = [a + b for a, b in zip(place[hips], place[spine], strict=True)]
    content["nodes"][hips]["translation"] = [-value for value in place[spine]]
    size = int.from_bytes(glb[12:16], "little")
    return write_glb(content, glb[28 + size :])


@pytest.mark.parametrize("told", [True, False])
def test_a_pelvis_below_the_trunk_changes_places_with_it(tmp_path: Path, told: bool) -> None:
    names = UNREAL if not told else UNREAL | {"hips": "a", "spine": "b", "chest": "c", "upperChest": "d"}
    path = tmp_path / "odd.glb"
    path.write_bytes(_trunk_first(names))
    if told:
        (tmp_path / "odd.glb.bones.json").write_text('{"hips": "a", "spine": "b", "chest": "c", "upperChest": "d"}')
    humanoid = Humanoid.load(path)
    assert any("above the hips" in note for note in humanoid.meta.notes)
    found, places = humanoid.skeleton, SKELETON.positions
    assert {"hips", "spine", "chest", "upperChest"} <= set(found.names)
    for bone in found.names:
        ours = found.positions[found.index(bone)] - found.positions[0]
        assert np.allclose(ours, places[SKELETON.index(bone)] - places[0], atol=1e-5), bone
    assert humanoid.rig is not None
    content = json_of(humanoid.glb or b"")
    hips, spine = (int(humanoid.rig.nodes[found.index(bone)]) for bone in ("hips", "spine"))
    assert spine in content["nodes"][hips]["children"]


@pytest.mark.parametrize("height", [0.5, 1.2, 2.5])
def test_an_avatar_as_tall_as_asked(tmp_path: Path, height: float) -> None:
    (tmp_path / "a.glb").write_bytes(build(Recipe(names=UNREAL)))
    humanoid, points = load_with_surface(tmp_path / "a.glb", LoadSettings(height=height))
    assert crown_of(humanoid, points) == pytest.approx(height)
    assert humanoid.rig is not None
    ankle = humanoid.skeleton.positions[humanoid.skeleton.index("leftFoot")]
    assert np.allclose(humanoid.rig.to_model(humanoid.rig.to_file(ankle)), ankle)


@pytest.mark.parametrize("height", [0.0, -1.0, 10.0, float("nan")])
def test_heights_of_no_humanoid(height: float) -> None:
    with pytest.raises(InputError, match="height"):
        LoadSettings(height=height)


@needs_shared
@pytest.mark.parametrize(
    ("name", "how", "named"),
    sampled(
        [
            ("glb/CesiumMan.glb", "topology", {"leftHand": "Skeleton_arm_joint_L__2_", "rightFoot": "leg_joint_R_3"}),
            ("glb/KayKit_Knight.glb", "KayKit", {"leftHand": "wrist.l", "leftFoot": "foot.l", "hips": "hips"}),
            ("glb/m2m_human-male.glb", "Unreal", {"leftToes": "ball_l"}),
            ("glb/VALID_AIAN_M_1_Casual.glb", "Mixamo", {"rightLowerArm": "RightForeArm"}),
            ("../motions/m2m_human-base-animations.glb", "Rigify", {"spine": "DEF-spine.001"}),
        ],
        2,
    ),
)
def test_real_rigs(name: str, how: str, named: dict[str, str]) -> None:
    assert SHARED is not None
    sources = {source.bone: source for source in Humanoid.load(SHARED / "avatars" / name).meta.bones}
    assert sources["leftUpperArm"].how == how
    assert {bone: sources[bone].name for bone in named} == named


@needs_shared
def test_a_box_man_gets_hands_and_feet_and_arms_on_his_spine() -> None:
    assert SHARED is not None
    humanoid, points = load_with_surface(SHARED / "avatars" / "glb" / "boxman.glb")
    how = {source.bone: source.how for source in humanoid.meta.bones}
    assert [bone for bone, source in how.items() if source == "added"] == [
        "leftHand", "leftFoot", "rightHand", "rightFoot",
    ]  # fmt: skip
    assert crown_of(humanoid, points) == pytest.approx(1.028, abs=0.01)
