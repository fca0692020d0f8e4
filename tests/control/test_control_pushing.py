"""Obstacles that are pushed while somebody walks: evaded, never let into the body, recorded and played again."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.control.recordings.recorded_things import told
from elbowroom.control.recordings.recording import Recorder, Recording
from elbowroom.control.recordings.replay import replay
from elbowroom.control.things.loose import FASTEST, pushable, scene_without
from elbowroom.errors import InputError
from elbowroom.planning.command import Command
from elbowroom.server.standalone.frames import posed_frames
from elbowroom.server.wire.pose_frame import parse
from elbowroom.world.moving_format import MAX_KEYS
from elbowroom.world.scene import Scene

STEP = 1 / 60
THINGS: list[dict[str, Any]] = [
    {"type": "box", "name": "crate", "center": [2.0, 0.8, 2.5], "size": [0.5, 1.6, 0.5], "yaw": 0.4},
    {"type": "cylinder", "name": "column", "center": [-2.0, 0.9, 1.0], "radius": 0.2, "height": 1.8},
    {"type": "sphere", "name": "ball", "center": [1.6, 1.1, 0.0], "radius": 0.3},
    {"type": "box", "name": "wall", "center": [0.0, 1.0, -5.0], "size": [6.0, 2.0, 0.2]},
]


def controller(planner: str = "exact") -> Controller:
    return Controller(Humanoid.default(), Scene.of("push", THINGS, finish=(0.0, 6.0)), planner=planner)


@pytest.mark.parametrize("planner", ["exact", pytest.param("figure6", marks=pytest.mark.long)])
def test_nobody_who_walks_or_stands_is_touched_by_what_is_pushed_at_him(planner: str) -> None:
    rng = np.random.default_rng(7)
    walker = controller(planner)
    places = [thing.copy() for thing in walker.scene.obstacles.centers]
    moved = 0.0
    for step in range(500):
        if step % 25 == 0:
            root = walker.root
            aim = np.array([root.x, root.z]) + rng.normal(0.0, 0.3, 2)
            walker.push(int(rng.integers(3)), (float(aim[0]), float(aim[1])))
        if step % 120 == 110:
            walker.let_go()
        frame = walker.step(Command(forward=1.0 if step < 300 else 0.0), STEP)
        assert not frame.touching
        assert frame.clearance > 0.0
        for number, thing in walker.things.items():
            way = float(np.hypot(*(thing.center - places[number])[[0, 2]]))
            assert way <= FASTEST * STEP + 1e-9
            moved += way
            places[number] = thing.center
    assert moved > 3.0


@pytest.mark.long
def test_a_pushed_box_stops_before_who_has_no_room_to_leave() -> None:
    beside = [{"type": "box", "center": [0.0, 1.0, z], "size": [4.0, 2.0, 0.2]} for z in (-0.6, 0.6)]
    scene = Scene.of("between", [*THINGS[:1], *beside], finish=(0.0, 6.0))
    walker = Controller(Humanoid.default(), scene)
    walker.push(0, (0.0, 0.0))
    for _ in range(400):
        frame = walker.step(Command(), STEP)
        assert frame.clearance > 0.0
    assert np.abs(walker.things[0].velocity).max() < 0.01
    assert walker.hand is not None


@pytest.mark.long
def test_who_stands_makes_way_for_what_comes() -> None:
    walker = controller()
    walker.push(0, (0.0, 0.0))
    for _ in range(240):
        walker.step(Command(), STEP)
    assert np.hypot(walker.root.x, walker.root.z) > 0.1


@pytest.mark.long
def test_what_was_pushed_is_in_the_way_where_it_was_left_and_back_after_a_reset() -> None:
    walker = controller()
    walker.push(0, (0.0, 2.5))
    for _ in range(240):
        walker.step(Command(), STEP)
    walker.let_go()
    assert walker.things[0].place == pytest.approx((0.0, 2.5), abs=0.02)
    aside = max(abs(walker.step(Command(forward=1.0), STEP).root[0]) for _ in range(300))
    assert aside > 0.3
    walker.reset()
    assert len(walker.things) == 0
    fresh = controller()
    for _ in range(200):
        frame, other = walker.step(Command(forward=1.0), STEP), fresh.step(Command(forward=1.0), STEP)
        assert frame.q.tobytes() == other.q.tobytes()


def test_only_what_is_upright_and_small_is_pushed_and_only_over_the_ground() -> None:
    walker = controller()
    assert pushable(walker.scene) == (0, 1, 2)
    low: list[dict[str, Any]] = [
        {"type": "box", "center": [0.0, 0.08, 2.0], "size": [1.0, 0.16, 0.4]},
        {"type": "cylinder", "center": [1.5, 0.05, 2.0], "radius": 0.3, "height": 0.1},
    ]
    kerb = Scene.of("kerb", [*low, THINGS[0]], finish=(0.0, 6.0))
    assert not kerb.ground.plain
    assert pushable(kerb) == (2,)
    assert scene_without(kerb, frozenset({2})).ground.plain is False
    for number in (3, 17, -1):
        with pytest.raises(InputError, match="push"):
            walker.push(number, (0.0, 0.0))
    with pytest.raises(InputError, match="no place"):
        walker.push(0, (float("nan"), 0.0))
    walker.push(0, (1e9, -1e9))
    assert walker.hand is not None
    assert abs(walker.hand.place[0]) <= 0.5 * walker.scene.ground_size[0] + abs(walker.scene.ground_center[0])


@pytest.mark.long
def test_a_push_is_recorded_played_again_bit_for_bit_and_told_as_a_track(tmp_path: Path) -> None:
    walker, path = controller(), tmp_path / "push.elbow"
    shown = []
    with Recorder(path, walker) as recorder:
        for step in range(260):
            if step in (20, 60, 61):
                walker.push(0, (-1.0 + 0.01 * step, 2.4))
            if step == 150:
                walker.let_go()
            command = Command(forward=1.0)
            recorder.append(walker.step(command, STEP), STEP)
            shown.append([*walker.things[0].place] if 0 in walker.things else [2.0, 2.5])
    recording = Recording(path)
    assert replay(recording, Humanoid.default()).identical
    assert recording.note is None
    scene = recording.scene()
    assert "crate" not in scene.obstacles.standing_names
    track = scene.obstacles.moving.tracks[-1]
    times = STEP * np.arange(1, len(shown) + 1)
    centers, _ = track.poses(times)
    assert centers[:, [0, 2]] == pytest.approx(np.array(shown), abs=1e-9)
    few = Scene.from_dict(told(scene).to_dict()).obstacles.moving.tracks[-1]
    assert len(few.times) < MAX_KEYS
    assert few.poses(times)[0] == pytest.approx(centers, abs=5e-3)


@pytest.mark.long
def test_a_run_that_began_anew_after_a_push_is_told_as_one_scene_as_it_was(tmp_path: Path) -> None:
    fan = {"type": "box", "name": "fan", "size": [0.3, 1.0, 0.3], "repeat": "loop"}
    quarter = [{"center": [3.0 + k, 0.5, 3.0], "yaw": 1.5 * k, "seconds": 0.31} for k in (0, 1, 2)]
    scene = Scene.of("anew", THINGS, finish=(0.0, 6.0), moving=[{**fan, "track": quarter}])
    walker, path, shown = Controller(Humanoid.default(), scene), tmp_path / "anew.elbow", []
    with Recorder(path, walker) as recorder:
        for step in range(200):
            anew = step in (90, 150)
            if anew:
                walker.reset()
            if step in (20, 100):
                walker.push(step // 100, (0.4, 2.0))
            command = Command(forward=1.0)
            frame = walker.step(command, STEP)
            recorder.append(frame, STEP)
            shown.append((walker.surroundings.obstacles.moving.poses(frame.time), dict(walker.things), frame))
    recording = Recording(path)
    told_scene, clock = recording.scene(), recording.clock(recording.steps())
    moving = told_scene.obstacles.moving
    assert moving.names == ("fan", "crate", "column")
    centers, yaws = moving.poses(clock.ends)
    for step, ((around, turned), things, _) in enumerate(shown):
        assert centers[step, 0] == pytest.approx(around[0, 0], abs=1e-6)
        assert np.cos(yaws[step, 0] - turned[0, 0]) == pytest.approx(1.0, abs=1e-9)
        for number in (0, 1):
            place = things[number].center if number in things else scene.obstacles.centers[number]
            assert centers[step, 1 + number] == pytest.approx(place, abs=1e-6)
    frames = [parse(frame) for frame in posed_frames(recording, Humanoid.default())]
    assert [one.clearance for one in frames] == pytest.approx([frame.clearance for *_, frame in shown], abs=1e-5)
    assert Scene.from_dict(told(told_scene).to_dict()).obstacles.moving.names == moving.names
    assert replay(recording, Humanoid.default()).identical
