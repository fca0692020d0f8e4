"""What we export as others read it: three.js, three-vrm, X_ITE, and Khronos' validator."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from avatar_builder import Recipe, build, json_of
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.loading.avatar_file import load_humanoid_bytes
from elbowroom.body.loading.hanim_names import hanim_name
from elbowroom.export.animation import Animation
from elbowroom.export.formats import FORMATS, RootMotion, Wishes
from elbowroom.export.writers import WRITERS
from elbowroom.geometry import quaternion
from gltf_judge import validated
from made_recording import made_recording
from three_judge import ThreeJudge
from x_ite import XIte

STOCK = Humanoid.default()
MILLIMETRE = 1e-3
FRAMES = (0, 7, 19, 39)


@pytest.fixture(scope="module")
def three(chromium: Any) -> Iterator[ThreeJudge]:
    judge = ThreeJudge(chromium)
    yield judge
    judge.close()


@pytest.fixture(scope="module")
def x_ite(chromium: Any) -> Iterator[XIte]:
    judge = XIte(chromium)
    yield judge
    judge.close()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("exported")


@pytest.fixture(scope="module", params=["stock", "bones only", "faces -Z, turned"])
def avatar(request: pytest.FixtureRequest) -> Humanoid:
    if request.param == "stock":
        return STOCK
    recipe = Recipe(vrm="1") if request.param == "bones only" else Recipe(heading=np.pi, spin=True, unit=100.0)
    return load_humanoid_bytes(build(recipe), "made.glb")


def animation_of(avatar: Humanoid, folder: Path) -> Animation:
    return Animation.of(made_recording(folder / f"{avatar.name}.elbow", STOCK, 40).recording, avatar)


def written(animation: Animation, avatar: Humanoid, ending: str, root: str = "hips") -> bytes:
    chosen = FORMATS[ending]
    return WRITERS[ending](animation, avatar, chosen.layout(Wishes(root))).data


@pytest.mark.parametrize("root", [RootMotion.HIPS, RootMotion.ROOT])
def test_three_shows_an_exported_glb_where_we_do(
    three: ThreeJudge, avatar: Humanoid, folder: Path, root: RootMotion
) -> None:
    animation = animation_of(avatar, folder)
    glb = written(animation, avatar, "glb", root.value)
    names = [node.get("name") for node in json_of(glb)["nodes"]]
    nodes = [names.index(bone) for bone in avatar.skeleton.names]
    found = np.array(three.nodes(glb, 0, [frame / animation.fps for frame in FRAMES]))[:, nodes, :3]
    assert np.abs(found - animation.joints_in_world()[list(FRAMES)]).max() < MILLIMETRE


@pytest.mark.parametrize("root", ["hips", "root"])
def test_three_plays_an_exported_bvh_where_we_do(three: ThreeJudge, folder: Path, root: str) -> None:
    animation = animation_of(STOCK, folder)
    text = written(animation, STOCK, "bvh", root).decode()
    shown = three.bvh(text, [frame / animation.fps for frame in FRAMES])
    found = np.array([[pose[bone] for bone in STOCK.skeleton.names] for pose in shown]) * 0.01
    assert np.abs(found - animation.joints_in_world()[list(FRAMES)]).max() < MILLIMETRE


def test_three_vrm_plays_an_exported_vrm_animation_as_we_do(three: ThreeJudge, folder: Path) -> None:
    animation = animation_of(STOCK, folder)
    vrma = written(animation, STOCK, "vrma")
    shown = three.bones(STOCK.glb or b"", vrma, [frame / animation.fps for frame in FRAMES])
    hips, turn = animation.hips_in_world()
    for frame, pose in zip(FRAMES, shown, strict=True):
        np.testing.assert_allclose(pose["hips"][4:], hips[frame], atol=1e-4)
        wanted = dict(zip(STOCK.skeleton.names, [turn[frame], *animation.rotations[frame, 1:]], strict=True))
        for bone, found in pose.items():
            if not bone.endswith("Eye"):
                assert quaternion.angle_between(np.array(found[:4]), wanted[bone]) < 1e-4, bone


@pytest.mark.parametrize("root", ["hips", "root"])
def test_x_ite_moves_an_exported_figure_as_we_do(x_ite: XIte, folder: Path, root: str) -> None:
    animation = animation_of(STOCK, folder)
    text = written(animation, STOCK, "x3d", root).decode()
    shown = x_ite.moved(text, [frame / (len(animation) - 1) for frame in FRAMES])["shown"]
    found = np.array([[pose[hanim_name(bone)] for bone in STOCK.skeleton.names] for pose in shown])
    assert np.abs(found - animation.joints_in_world()[list(FRAMES)]).max() < MILLIMETRE


@pytest.mark.parametrize("ending", ["glb", "vrma"])
@pytest.mark.parametrize("root", ["hips", "none"])
def test_the_validator_finds_no_error(avatar: Humanoid, folder: Path, ending: str, root: str) -> None:
    """None but those that the avatar's own file had."""
    own = errors_in(avatar.glb or b"") if ending == "glb" else set()
    assert not errors_in(written(animation_of(avatar, folder), avatar, ending, root)) - own
    assert not own or avatar is not STOCK


def errors_in(glb: bytes) -> set[str]:
    return {str(told["code"]) for told in validated(glb)["issues"]["messages"] if told["severity"] == 0}
