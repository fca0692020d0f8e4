"""Animations as three.js and three-vrm-animation play them, and clips on the page."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from animation_builder import animated_glb
from avatar_builder import MIXAMO, Recipe, build
from bvh_builder import BvhRecipe, random_motion, write_bvh
from elbowroom.body.loading.avatar_file import load_humanoid_bytes
from elbowroom.clips.files import parse_motion
from elbowroom.clips.retarget import retarget
from elbowroom.formats.animations import read_animations, take_of
from elbowroom.formats.gltf import parse_gltf
from elbowroom.formats.nodes import read_nodes
from elbowroom.geometry import quaternion
from live_page import LivePage
from shared_data import SHARED, needs_shared
from three_judge import ThreeJudge


@pytest.fixture(scope="module")
def three(chromium: Any) -> Iterator[ThreeJudge]:
    judge = ThreeJudge(chromium)
    yield judge
    judge.close()


def compare_nodes(three: ThreeJudge, glb: bytes, clip: int) -> None:
    """World positions and rotations of all nodes at five frames, relative to the height of the figure."""
    gltf = parse_gltf(glb, "a.glb")
    tree = read_nodes(gltf)
    take = take_of(read_animations(gltf, len(tree))[clip], tree, "a.glb")
    start = read_animations(gltf, len(tree))[clip].span[0]
    frames = np.unique(np.linspace(0, len(take) - 1, 5).astype(int))
    found = np.array(three.nodes(glb, clip, [start + float(frame) * take.frame_time for frame in frames]))
    turns, places = take.world(np.arange(len(tree)))
    height = np.ptp(places[..., 1])
    assert np.abs(places[frames] - found[..., :3]).max() <= 1e-4 * height
    assert quaternion.angle_between(turns[frames], found[..., 3:]).max() <= 1e-4


@pytest.mark.parametrize("mode", ["LINEAR", "STEP", "CUBICSPLINE"])
def test_animations_move_nodes_as_in_three_js(three: ThreeJudge, mode: str) -> None:
    recipe = Recipe(mesh=False, names=MIXAMO, arms_down=0.5, between=True, spin=True)
    compare_nodes(three, animated_glb(recipe, mode=mode, frames=9), 0)


@needs_shared
@pytest.mark.parametrize("clip", [0, 12, 43])
def test_real_animations_move_nodes_as_in_three_js(three: ThreeJudge, clip: int) -> None:
    assert SHARED is not None
    compare_nodes(three, (SHARED / "motions" / "m2m_human-base-animations.glb").read_bytes(), clip)


def compare_bones(three: ThreeJudge, vrma: bytes, name: str) -> None:
    """Normalised rotations of all bones of a VRM, and the way of its hips on the ground."""
    avatar = build(Recipe(vrm="1", mesh=False))
    humanoid = load_humanoid_bytes(avatar, "a.vrm")
    clip = parse_motion(vrma, name).clip()
    ours = retarget(clip.motion, humanoid.skeleton)
    frames = np.unique(np.linspace(0, len(ours) - 1, 5).astype(int))
    theirs = three.bones(avatar, vrma, [float(frame * ours.frame_time) for frame in frames])
    for frame, pose in zip(frames, theirs, strict=True):
        for joint, bone in enumerate(humanoid.skeleton.names):
            if bone in clip.motion.bones and bone in pose:
                away = quaternion.angle_between(ours.rotations[frame, joint], np.array(pose[bone][:4]))
                assert away <= 1e-4, (frame, bone)


def test_a_vrm_animation_poses_a_vrm_as_in_three_vrm(three: ThreeJudge) -> None:
    compare_bones(three, animated_glb(Recipe(mesh=False), vrma=True, frames=9), "made.vrma")


@needs_shared
def test_a_real_vrm_animation_poses_a_vrm_as_in_three_vrm(three: ThreeJudge) -> None:
    assert SHARED is not None
    compare_bones(three, (SHARED / "motions" / "three-vrm_test.vrma").read_bytes(), "test.vrma")


def test_a_motion_dropped_on_the_page_plays(open_page: Any, tmp_path: Path) -> None:
    live_page: LivePage = open_page()
    path = tmp_path / "dance.bvh"
    path.write_bytes(write_bvh(random_motion(np.random.default_rng(3), 60, smooth=8.0), BvhRecipe()))
    live_page.page.set_input_files("#file", str(path))
    playing = live_page.wait("s.settings.clip !== '' && s.simTime > 0.3")
    assert live_page.page.input_value("#clip") == playing["settings"]["clip"]
    assert "BVH, Y up, unit cm" in live_page.page.inner_text("#clip-facts")
    live_page.page.check("#clip-planned")
    live_page.wait("s.settings.clipAsPlanned")
    live_page.page.select_option("#clip", "")
    live_page.wait("s.settings.clip === ''")
    live_page.page.keyboard.press("w")
    assert not live_page.errors
