"""Obstacles that are no boxes: walked among, judged by another library, in a stock scene and in random courses."""

from itertools import pairwise

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.recordings.recording import Recorder, Recording
from elbowroom.experiment.crossing import controller_for, run_crossing
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.experiment.gauntlet.course import make_course
from elbowroom.experiment.gauntlet.shapes import in_shapes
from elbowroom.experiment.gauntlet.trial import controller_on, walk_course
from elbowroom.experiment.gauntlet.trial_settings import TrialSettings
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge_recording
from elbowroom.world.obstacles.closest_points import closest_points
from elbowroom.world.obstacles.shapes import Box
from elbowroom.world.scene import Scene
from sampled import sampled

AVATAR = Humanoid.default()


@pytest.fixture(autouse=True)
def coal() -> None:
    pytest.importorskip("coal")


def test_scene_shapes_has_every_shape_and_is_crossed_without_touching(tmp_path: object) -> None:
    scene, settings = Scene.load("shapes"), CrossingSettings(planner="exact", seed=1)
    standing = {type(shape).__name__ for shape in scene.obstacles.shapes}
    moving = {type(track.shape).__name__ for track in scene.obstacles.moving.tracks}
    assert standing == {"Box", "Sphere", "Capsule", "Cylinder", "Hull"}
    assert moving == {"Sphere", "Capsule", "Cylinder", "Hull"}
    controller, path = controller_for(AVATAR, scene, settings), f"{tmp_path}/run.elbow"
    with Recorder(path, controller) as recorder:
        result = run_crossing(controller, settings, recorder.append)
    assert result.straight
    verdict = judge_recording(Recording(path), AVATAR, JudgeSettings(mesh=False))
    assert verdict.clean, verdict.capsules.contacts


@pytest.mark.parametrize("level", sampled([2, 5]))
def test_cut_boxes_stay_within_what_they_were(level: int) -> None:
    rng = np.random.default_rng(level)
    made = make_course(level, 3)
    cut = in_shapes(made)
    assert make_course(level, 3).fingerprint == made.fingerprint == cut.fingerprint
    assert any(not isinstance(shape, Box) for shape in cut.scene.obstacles.shapes)
    again = in_shapes(made)
    assert again.scene.to_dict() == cut.scene.to_dict()
    for start, end in pairwise(rng.uniform(-3.0, 9.0, (40, 3))):
        segment = np.concatenate([start, end])
        before = np.subtract(*closest_points(segment, made.scene.obstacles.standing))
        after = np.subtract(*closest_points(segment, cut.scene.obstacles.standing))
        assert np.all(np.linalg.norm(after, axis=1) >= np.linalg.norm(before, axis=1) - 1e-5)


def test_a_course_of_shapes_is_crossed() -> None:
    course = in_shapes(make_course(3, 4))
    result = walk_course(controller_on(AVATAR, course, TrialSettings()), course)
    assert result.crossed
    assert result.touching_frames == 0
