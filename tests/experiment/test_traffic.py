"""Things that move by themselves: seen coming, evaded, and judged where they are at each moment."""

from dataclasses import replace

import numpy as np
import pytest

from elbowroom.body.dof import DOF
from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.recordings.recording import Recorder, Recording
from elbowroom.experiment.crossing import controller_for, run_crossing
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import Verdict, judge, judge_recording
from elbowroom.planning.command import Command
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Box
from elbowroom.world.obstacles.tracks.moving import Moving, Repeat, Track
from elbowroom.world.scene import Scene

AVATAR = Humanoid.default()
DT = 1 / 60
CAPSULES = JudgeSettings(mesh=False)
FORWARD = Command(forward=1.0)


@pytest.fixture(autouse=True)
def coal() -> None:
    pytest.importorskip("coal")


def rolling(x: float, z: float, to_x: float, to_z: float, seconds: float) -> Scene:
    """A box of 0.6 m that rolls once from one place to another."""
    centers = np.array([[x, 0.5, z], [to_x, 0.5, to_z]])
    track = Track("box", Box((0.6, 1.0, 0.6)), np.array([0.0, seconds]), centers, np.zeros(2), Repeat.ONCE)
    return replace(Scene.load("empty"), obstacles=Obstacles(moving=Moving((track,))))


def judged(frames: list[Frame], scene: Scene) -> Verdict:
    q, roots = np.array([frame.q for frame in frames]), np.array([frame.root for frame in frames])
    motion = replace(ShownMotion.at_rate(q, roots), clock=np.array([frame.time for frame in frames]))
    return judge(motion, AVATAR, scene, CAPSULES)


def walked(scene: Scene, command: Command, seconds: float) -> list[Frame]:
    controller = Controller(AVATAR, scene, planner="exact", seed=1)
    return [controller.step(command, DT) for _ in range(round(seconds / DT))]


def test_scene_traffic_is_crossed_and_nothing_is_touched(tmp_path: object) -> None:
    scene, settings = Scene.load("traffic"), CrossingSettings(planner="exact", seed=1)
    controller, path = controller_for(AVATAR, scene, settings), f"{tmp_path}/run.elbow"
    with Recorder(path, controller) as recorder:
        result = run_crossing(controller, settings, recorder.append)
    assert result.straight
    verdict = judge_recording(Recording(path), AVATAR, CAPSULES)
    assert verdict.clean, verdict.capsules.contacts


def test_the_judge_moves_what_moves() -> None:
    """A box that passes over a standing avatar touches it while it is there, and only then."""
    scene, frames = rolling(-3.0, 0.0, 3.0, 0.0, 6.0), 360
    verdict = judge(ShownMotion.at_rate(np.zeros((frames, DOF)), np.zeros((frames, 7))), AVATAR, scene, CAPSULES)
    contact = verdict.capsules.contacts[0]
    assert contact.obstacle == "box"
    touching = [(c.first, c.last) for c in verdict.capsules.contacts]
    assert 2.4 < min(first for first, _ in touching) < 2.6
    assert 3.4 < max(last for _, last in touching) < 3.6


@pytest.mark.long
def test_who_stands_steps_out_of_the_way_of_what_comes() -> None:
    scene = rolling(0.0, 4.0, 0.0, -4.0, 10.0)
    frames = walked(scene, Command(), 8.0)
    assert judged(frames, scene).clean
    assert np.hypot(*frames[-1].root[:2]) > 0.2


@pytest.mark.long
def test_who_walks_lets_the_crossing_box_pass() -> None:
    scene = rolling(-2.2, 1.8, 2.6, 1.8, 3.6)
    frames = walked(scene, FORWARD, 6.0)
    assert judged(frames, scene).clean
    assert frames[-1].root[1] > 3.0


@pytest.mark.long
def test_what_leaves_no_way_out_hits_and_says_so() -> None:
    """A wall that sweeps the whole floor, faster than anyone walks."""
    centers = np.array([[0.0, 1.0, 3.0], [0.0, 1.0, -6.0]])
    track = Track("wall", Box((9.0, 2.0, 0.3)), np.array([0.0, 2.0]), centers, np.zeros(2), Repeat.ONCE)
    scene = replace(Scene.load("empty"), obstacles=Obstacles(moving=Moving((track,))))
    frames = walked(scene, Command(), 2.0)
    touching = [frame for frame in frames if frame.touching]
    assert touching
    assert all(0.4 < frame.time < 1.5 for frame in touching)
    assert not judged(frames, scene).clean
