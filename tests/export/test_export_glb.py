"""The avatar's own file with the motion in it: read again, every bone is where the page shows it."""

import base64
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from avatar_builder import Recipe, build, json_of
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid_bytes
from elbowroom.errors import InputError
from elbowroom.export.animation import Animation
from elbowroom.export.avatar_glb import avatar_glb
from elbowroom.export.formats import FORMATS, RootMotion, Wishes
from elbowroom.export.writers import WRITERS
from elbowroom.formats.animations import read_animations, take_of
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.gltf_animating import NodeMotion, continuous, with_animation
from elbowroom.formats.nodes import read_nodes
from elbowroom.formats.packing import write_glb
from elbowroom.geometry import quaternion
from made_recording import made_recording
from sampled import sampled

Floats = NDArray[np.float64]

BODY = Humanoid.default()
RECIPES = {
    "VRM 1.0": Recipe(vrm="1"),
    "VRM 0.x, faces -Z": Recipe(vrm="0", heading=np.pi, spin=True),
    "turned nodes, arms down": Recipe(arms_down=0.9, spin=True, between=True),
    "centimetres": Recipe(unit=100.0, root_scale=0.01, legs_apart=0.2),
    "no mesh, no buffer": Recipe(mesh=False, between=True),
}


@cache
def body(name: str) -> Humanoid:
    return load_humanoid_bytes(build(RECIPES[name]), "made.vrm" if "VRM" in name else "made.glb")


def animated(humanoid: Humanoid, folder: Path) -> Animation:
    return Animation.of(made_recording(folder / "run.elbow", BODY, 12).recording, humanoid, 30.0)


def avatar_file(animation: Animation, humanoid: Humanoid, root: RootMotion) -> bytes:
    """The avatar's file whatever its licence says."""
    return avatar_glb(animation, humanoid, root)


def joints_of(glb: bytes, names: tuple[str, ...] | None, humanoid: Humanoid) -> Floats:
    """World places (F, J, 3) of the joints in the first animation of a file, by our own readers."""
    gltf = parse_gltf(glb, "made.glb")
    tree = read_nodes(gltf)
    take = take_of(read_animations(gltf, len(tree))[0], tree, "made")
    assert humanoid.rig is not None
    nodes = humanoid.rig.nodes if names is None else np.array([tree.names.index(name) for name in names])
    return take.world(nodes)[1]


def wanted(animation: Animation, root: RootMotion) -> Floats:
    joints = animation.joints_in_world()
    if root is not RootMotion.NONE:
        return joints
    back = quaternion.conjugate(animation.turns())
    return quaternion.rotate(back[:, None], joints - animation.places[:, None])


def written(animation: Animation, humanoid: Humanoid, ending: str, root: RootMotion) -> tuple[bytes, tuple[str, ...]]:
    chosen = FORMATS[ending]
    result = WRITERS[ending](animation, humanoid, chosen.layout(Wishes(root.value)))
    return result.data, result.notes


def test_every_format_that_can_be_chosen_has_its_writer() -> None:
    assert WRITERS.keys() == FORMATS.keys()


@pytest.mark.parametrize("root", RootMotion)
@pytest.mark.parametrize("name", RECIPES)
def test_every_rig_moves_as_the_page_shows_it(name: str, root: RootMotion, tmp_path: Path) -> None:
    humanoid = body(name)
    animation = animated(humanoid, tmp_path)
    glb = avatar_file(animation, humanoid, root)
    np.testing.assert_allclose(joints_of(glb, None, humanoid), wanted(animation, root), atol=1e-5)


@pytest.mark.parametrize("root", RootMotion)
def test_the_stock_avatar_leaves_with_its_mesh_and_its_licence(root: RootMotion, tmp_path: Path) -> None:
    animation = animated(humanoid := BODY, tmp_path)
    glb, notes = written(animation, humanoid, "glb", root)
    assert notes == ()
    content, before = json_of(glb), json_of(humanoid.glb or b"")
    assert content["meshes"] == before["meshes"]
    assert content["extensions"] == before["extensions"]
    np.testing.assert_allclose(joints_of(glb, None, humanoid), wanted(animation, root), atol=1e-5)


def test_an_avatar_that_forbids_it_stays_at_home_and_its_bones_move(tmp_path: Path) -> None:
    """The made VRM 1.0 says nothing about redistribution, which by its specification forbids it."""
    humanoid = body("VRM 1.0")
    animation = animated(humanoid, tmp_path)
    glb, notes = written(animation, humanoid, "glb", RootMotion.HIPS)
    assert notes == (
        "made: its licence forbids redistribution, so putting into another file is not done: "
        "a figure of bones shows the motion",
    )
    assert "extensions" not in json_of(glb)
    names = humanoid.skeleton.names
    np.testing.assert_allclose(joints_of(glb, names, humanoid), wanted(animation, RootMotion.HIPS), atol=1e-5)


@pytest.mark.parametrize("root", [RootMotion.HIPS, RootMotion.NONE])
def test_a_vrm_animation_holds_the_same_motion(root: RootMotion, tmp_path: Path) -> None:
    animation = animated(humanoid := BODY, tmp_path)
    data, _ = written(animation, humanoid, "vrma", root)
    names = humanoid.skeleton.names
    np.testing.assert_allclose(joints_of(data, names, humanoid), wanted(animation, root), atol=1e-5)
    bones = json_of(data)["extensions"]["VRMC_vrm_animation"]["humanoid"]["humanBones"]
    assert {"hips", "leftToes"} <= bones.keys()
    assert not {"leftEye", "rightEye"} & bones.keys()


def test_formats_with_a_convention_of_their_own_take_no_wishes() -> None:
    with pytest.raises(InputError, match="unit: cannot be chosen in GLB"):
        FORMATS["glb"].layout(Wishes(unit="cm"))
    with pytest.raises(InputError, match="root: root is not possible in VRM animation: choose hips or none"):
        FORMATS["vrma"].layout(Wishes("root"))


def _with_uri_buffer(glb: bytes) -> bytes:
    """The same file with its buffer in the JSON."""
    content = json_of(glb)
    size = int.from_bytes(glb[12:16], "little")
    binary = glb[28 + size :]
    content["buffers"] = [{"byteLength": len(binary), "uri": "data:;base64," + base64.b64encode(binary).decode()}]
    return write_glb(content, b"")


def _with_matrices(glb: bytes) -> bytes:
    """The same file whose nodes have matrices."""
    content, size = json_of(glb), int.from_bytes(glb[12:16], "little")
    tree = read_nodes(parse_gltf(glb, "made.glb"))
    local = np.tile(np.eye(4), (len(tree), 1, 1))
    local[:, :3, :3] = quaternion.to_matrix(tree.rotations) * tree.scales[:, None, :]
    local[:, :3, 3] = tree.translations
    for node, matrix in zip(content["nodes"], local, strict=True):
        for key in ("translation", "rotation", "scale"):
            node.pop(key, None)
        node["matrix"] = matrix.T.ravel().tolist()
    return write_glb(content, glb[28 + size :])


@pytest.mark.parametrize("change", sampled([_with_uri_buffer, _with_matrices]))
def test_files_that_are_stored_otherwise_move_too(change: Any, tmp_path: Path) -> None:
    humanoid = load_humanoid_bytes(change(build(Recipe(spin=True, between=True))), "made.glb")
    animation = animated(humanoid, tmp_path)
    glb = avatar_file(animation, humanoid, RootMotion.HIPS)
    np.testing.assert_allclose(joints_of(glb, None, humanoid), wanted(animation, RootMotion.HIPS), atol=1e-5)
    moving = {channel["target"]["node"] for channel in json_of(glb)["animations"][0]["channels"]}
    assert not any("matrix" in json_of(glb)["nodes"][node] for node in moving)
    assert load_humanoid_bytes(glb, "again.glb").skeleton.names == humanoid.skeleton.names


def test_animations_that_the_file_has_come_after_ours(tmp_path: Path) -> None:
    humanoid = body("no mesh, no buffer")
    animation = animated(humanoid, tmp_path)
    once = avatar_file(animation, humanoid, RootMotion.HIPS)
    twice = with_animation(once, "nod", 0.1, [NodeMotion(0, np.tile(quaternion.IDENTITY, (3, 1)))])
    assert [one["name"] for one in json_of(twice)["animations"]] == ["nod", "run"]


def test_neighbouring_rotations_have_the_same_sign() -> None:
    rng = np.random.default_rng(0)
    turns = quaternion.from_rotation_vector(np.cumsum(0.2 * rng.normal(size=(200, 3)), axis=0))
    flipped = turns * rng.choice([-1.0, 1.0], (200, 1))
    found = continuous(flipped)
    assert (np.sum(found[1:] * found[:-1], axis=1) > 0.0).all()
    assert quaternion.angle_between(found, turns).max() < 1e-6
