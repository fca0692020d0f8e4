"""The judge on recordings: real ones that touch and that do not, torn ones, empty ones; and how smooth a motion is."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from elbowroom.body.dof import DOF
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.root import ROOT_STATE
from elbowroom.control.controller import Controller
from elbowroom.control.recordings.recording import ASSIST, RESTART, Recorder, Recording, RecordingHeader
from elbowroom.errors import InputError
from elbowroom.experiment.judge.derivatives import derivatives
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import Verdict, judge_recording
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from judged_bodies import T_POSE, gliding, scene_with, upright, write_recording

BODY = proportional_humanoid(1.72)
DT = 1 / 60
WALL = scene_with(upright(((0.0, 1.0, 3.0), (2.0, 2.0, 0.2))))


def walked(path: Path, scene: str, seconds: float, assist: bool) -> tuple[float, Verdict]:
    """The least clearance that the controller told of, and the verdict on what it showed."""
    controller = Controller(BODY, Scene.load(scene), seed=0, assist=assist)
    told = np.inf
    with Recorder(path, controller) as recorder:
        for _ in range(round(seconds / DT)):
            frame = controller.step(Command(forward=1.0), DT)
            recorder.append(frame, DT)
            told = min(told, frame.clearance)
    return told, judge_recording(Recording(path), BODY)


def header(scene: Scene = WALL) -> dict[str, Any]:
    import json

    return dict(json.loads(RecordingHeader.of(Controller(BODY, scene)).to_json()))


def test_a_walk_with_assistance_is_clean(tmp_path: Path) -> None:
    told, verdict = walked(tmp_path / "run.elbow", "c", 4.0, assist=True)
    assert verdict.clean
    assert verdict.frames == 240
    assert verdict.poses == 4 * 239 + 1
    least = verdict.capsules.least
    assert least is not None
    assert 0.0 <= least.clearance <= told + 1e-5
    assert least.clearance == pytest.approx(told, abs=2e-3)  # between two frames it may be a little less


def test_a_walk_without_assistance_touches(tmp_path: Path) -> None:
    told, verdict = walked(tmp_path / "run.elbow", "c", 4.0, assist=False)
    assert not verdict.clean
    assert verdict.capsules.touching > 10
    assert verdict.capsules.touching_assisted == 0
    assert verdict.capsules.deepest >= -told - 1e-5
    assert verdict.capsules.contacts[0].obstacle in Scene.load("c").obstacles.standing_names


def test_a_torn_recording_is_judged_to_its_last_whole_chunk(tmp_path: Path) -> None:
    path = tmp_path / "torn.elbow"
    q, roots = gliding(T_POSE, 150, speed=1.2)
    write_recording(path, header(), q, roots)
    assert not judge_recording(Recording(path), BODY).clean
    path.write_bytes(path.read_bytes()[:-23])  # the end mark, 16 bytes, and some of the last chunk
    recording = Recording(path)
    verdict = judge_recording(recording, BODY)
    assert verdict.frames == 120
    assert recording.note is not None
    assert verdict.clean  # the wall is reached after the second chunk


def test_a_recording_of_nothing_is_no_clean_one(tmp_path: Path) -> None:
    path = tmp_path / "nothing.elbow"
    write_recording(path, header(), np.zeros((0, DOF)), np.zeros((0, ROOT_STATE)))
    with pytest.raises(InputError, match=r"nothing\.elbow: holds no frames"):
        judge_recording(Recording(path), BODY)


@pytest.mark.parametrize(("name", "value"), [("q", np.nan), ("root", np.inf)])
def test_a_pose_that_is_none_is_refused(tmp_path: Path, name: str, value: float) -> None:
    path = tmp_path / "odd.elbow"
    q, roots = gliding(T_POSE, 5, speed=1.0)
    (q if name == "q" else roots)[3, 6] = value
    write_recording(path, header(), q, roots)
    with pytest.raises(InputError, match="frame 3"):
        judge_recording(Recording(path), BODY)


def test_a_jump_through_a_wall_touches_nothing_and_a_stride_does(tmp_path: Path) -> None:
    q, roots = gliding(T_POSE, 2, speed=240.0, z=1.0)  # from 1 m to 5 m, the wall is at 3 m
    for flags, clean in ((np.array([ASSIST, ASSIST | RESTART]), True), (np.array([ASSIST, ASSIST]), False)):
        path = tmp_path / "jump.elbow"
        write_recording(path, header(), q, roots, flags)
        assert judge_recording(Recording(path), BODY).clean is clean


def test_a_wrong_rate_is_refused() -> None:
    for rate in (0.0, -1.0, np.nan, 1e6):
        with pytest.raises(InputError, match="rate"):
            JudgeSettings(rate=rate)


def test_derivatives_of_a_sine() -> None:
    """q = A sin(w t) has the extremes A w, A w^2, A w^3."""
    times, amplitude, omega = np.arange(600) / 60, 0.4, 3.0
    q, roots = np.zeros((600, DOF)), np.zeros((600, ROOT_STATE))
    q[:, 7] = amplitude * np.sin(omega * times)
    roots[:, 0] = 0.5 * times**2
    figures = derivatives(ShownMotion.at_rate(q, roots))
    arm = figures["leftArm"]
    for extent, order in ((arm.speed, 1), (arm.acceleration, 2), (arm.jerk, 3)):
        assert extent.max == pytest.approx(amplitude * omega**order, rel=1e-2)
        assert 0.9 * extent.max < extent.p99 <= extent.max
    assert figures["rightArm"].speed.max == figures["waist"].jerk.max == 0.0
    assert figures["root"].acceleration.max == pytest.approx(1.0, rel=1e-6)
    assert figures["root"].speed.max == pytest.approx(9.975, rel=1e-3)


def test_derivatives_stop_at_a_jump() -> None:
    q, roots = gliding(T_POSE, 10, speed=1.0)
    roots[5:, 1] += 7.0
    jumps = np.isin(np.arange(10), (0, 5))
    figures = derivatives(ShownMotion(np.arange(10) / 60, q, roots, jumps, np.ones(10, bool)))
    assert figures["root"].speed.max == pytest.approx(1.0)
    assert figures["root"].jerk.max == pytest.approx(0.0, abs=1e-6)
