"""Clips on the page's side of the server: kept, performed, configured, dropped."""

import asyncio
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from animation_builder import animated_glb
from avatar_builder import Recipe, build
from bvh_builder import BvhRecipe, random_motion, write_bvh
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, local_rotations
from elbowroom.clips.files import has_animations, is_motion_only, parse_motion
from elbowroom.clips.performance import perform
from elbowroom.errors import InputError
from elbowroom.geometry import quaternion
from elbowroom.planning.command import Command
from elbowroom.server.clip_walk import ClipWalk
from elbowroom.server.entrance.page_key import Sender
from elbowroom.server.schema.commands import Configure
from elbowroom.server.sessions.stage import Stage
from elbowroom.server.sessions.walk import WalkSettings
from elbowroom.server.sessions.wanted import Wanted
from elbowroom.server.stores.avatar_store import STOCK
from elbowroom.server.stores.clip_store import MAX_FILES, ClipStore
from elbowroom.server.stores.library import Library
from elbowroom.world.scene import Scene
from sent_files import add_clips

BVH = write_bvh(random_motion(np.random.default_rng(0), 60, smooth=8.0), BvhRecipe())
MINE = Sender("127.0.0.1", "0123456789abcdef" * 2)


@pytest.fixture(scope="module")
def library() -> Iterator[Library]:
    opened = Library.open("empty")
    yield opened
    opened.close()


def clip_walk(library: Library, *, as_planned: bool = False) -> ClipWalk:
    stored = add_clips(library.clips, BVH, "dance.bvh", library.avatars.folder)[0]
    asyncio.run(stored.read())
    return ClipWalk(library.avatars.get(STOCK), Scene.load("a"), WalkSettings(), stored, as_planned=as_planned)


def test_a_performance_begins_at_the_start_and_keeps_the_whole_body() -> None:
    scene, skeleton = Scene.load("a"), Humanoid.default().skeleton
    clip = parse_motion(BVH, "dance.bvh").clip()
    performance = perform(clip, skeleton, scene.start)
    moment = performance.at(0.5)
    np.testing.assert_allclose(performance.at(0.0).root[:3], scene.start[:3], atol=1e-9)
    frame = round(0.5 / performance.frame_time)
    in_world = quaternion.multiply(quaternion.about_axis(1, moment.root[2]), moment.rotations[0])
    turn = quaternion.multiply(in_world, quaternion.conjugate(clip.motion.turn("hips")[frame]))
    assert np.abs(turn[[0, 2]]).max() < 1e-6  # the whole dance is turned about the vertical alone
    knee = skeleton.index("leftLowerLeg")
    own = quaternion.multiply(quaternion.conjugate(clip.motion.turn("leftUpperLeg")), clip.motion.turn("leftLowerLeg"))
    assert quaternion.angle_between(moment.rotations[knee], own[frame]) < 1e-6


@pytest.mark.long
def test_as_planned_it_shows_the_planning_configuration_alone(library: Library) -> None:
    walk = clip_walk(library, as_planned=True)
    walk.step(Command(forward=1.0), 0.4)
    model = body_model(walk.avatar.humanoid)
    wanted = walk.avatar.poser.full_pose(local_rotations(model, walk.frame.q, walk.frame.root), np.zeros(3)).rotations
    np.testing.assert_array_equal(walk.node_pose().rotations, wanted)
    free = clip_walk(library)
    free.step(Command(), 0.4)
    assert np.abs(free.node_pose().rotations - wanted).max() > 0.05


@pytest.mark.long
def test_a_clip_begins_anew_and_jumps_there(library: Library) -> None:
    walk = clip_walk(library)
    stage = Stage(walk, 0.0)
    length = 59 / 30
    for number in range(1, 25):
        stage.advance(0.09 * number)
    assert walk.rounds == 1
    assert walk.frame.time == pytest.approx(0.09 * 24 - length, abs=0.02)
    stage.reset()
    assert walk.frame.time == 0.0
    assert stage.settings().clip == walk.stored.id


def test_configure_changes_what_is_shown(library: Library) -> None:
    walk = clip_walk(library)
    now = Wanted.of(walk)
    assert now.changed(Configure(clip="")).clip == ""
    assert now.changed(Configure(scene="b")).clip == walk.stored.id
    assert now.changed(Configure(clip_as_planned=True)).differs(now)
    assert not now.changed(Configure(planner="figure6")).differs(now)
    assert now.changed(Configure(planner="figure6", clip="")).differs(now)
    assert not now.changed(Configure(walk_speed=0.5)).differs(now)


def test_dropped_files_are_kept_and_the_oldest_goes(tmp_path: Path) -> None:
    store = ClipStore()
    first = add_clips(store, BVH, "0.bvh", tmp_path, MINE)[0]
    for number in range(1, MAX_FILES):
        add_clips(store, BVH, f"{number}.bvh", tmp_path, MINE)
    store.get(first.id)
    second = store.choices(MINE.key)[0]
    add_clips(store, BVH, "last.bvh", tmp_path, MINE)
    assert len(list(tmp_path.iterdir())) == MAX_FILES
    store.check(first.id)
    with pytest.raises(InputError, match="not known"):
        store.check(second.id)
    assert len(store.choices(MINE.key)) == MAX_FILES
    assert store.choices() == []


def test_what_is_shown_stays(tmp_path: Path) -> None:
    store = ClipStore()
    first = add_clips(store, BVH, "0.bvh", tmp_path)[0]
    store.hold("a session", first.id)
    for number in range(1, MAX_FILES + 2):
        add_clips(store, BVH, f"{number}.bvh", tmp_path)
    store.check(first.id)
    store.hold("a session")
    for number in range(MAX_FILES):
        add_clips(store, BVH, f"{number}.bvh", tmp_path)
    with pytest.raises(InputError, match="not known"):
        store.check(first.id)


def test_what_holds_no_motion_is_not_kept(tmp_path: Path) -> None:
    store = ClipStore()
    for data in (b"", b"HIERARCHY", BVH[:-400]):
        with pytest.raises(InputError):
            add_clips(store, data, "a.bvh", tmp_path)
    assert store.choices() == []


def test_files_are_told_apart_by_content() -> None:
    avatar, moving = build(Recipe()), animated_glb(Recipe())
    assert is_motion_only(BVH, "a.glb")
    assert is_motion_only(animated_glb(vrma=True), "a.glb")
    assert is_motion_only(animated_glb(Recipe(mesh=False)), "a.vrm")
    assert not is_motion_only(avatar, "a.bvh")
    assert not is_motion_only(moving, "a.bvh")
    assert has_animations(moving, "a")
    assert not has_animations(avatar, "a")
    assert not has_animations(BVH, "a")
