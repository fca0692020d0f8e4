"""Avatars of others on random courses made for their bodies: what is shown of them, the mesh, touches nothing."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.experiment.crossing import DT
from elbowroom.experiment.gauntlet.course import Course, CourseMaker, NoCourseError
from elbowroom.experiment.gauntlet.trial import TrialResult, controller_on, walk_course
from elbowroom.experiment.gauntlet.trial_settings import TrialSettings
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.verdict import BodyVerdict, judge
from shared_data import SHARED, needs_shared

pytestmark = needs_shared

LEVEL = 3
SEEDS, WALKS = 12, 3  # the first courses that there are among so many seeds
AVATARS = [
    "vrm0/Robot.vrm",
    "glb/m2m_human-male.glb",
    "glb/VALID_AIAN_M_1_Casual.glb",
    "glb/KayKit_Knight.glb",
    "hanim_x3d/JoeKick.x3d",
]


def opened(name: str, seed: int) -> tuple[Humanoid, Course]:
    assert SHARED is not None
    humanoid = Humanoid.load(SHARED / "avatars" / Path(name))
    return humanoid, CourseMaker.of(humanoid).course(LEVEL, seed)


def walked(controller: Controller, humanoid: Humanoid, course: Course) -> tuple[TrialResult, BodyVerdict]:
    """How the walk went, and what the judge says of the mesh in it."""
    shown: list[Frame] = []
    result = walk_course(controller, course, lambda frame, _dt: shown.append(frame))
    q, roots = np.stack([frame.q for frame in shown]), np.stack([frame.root for frame in shown])
    verdict = judge(ShownMotion.at_rate(q, roots, 1.0 / DT), humanoid, course.scene).mesh
    assert verdict is not None
    return result, verdict


@pytest.mark.long
def test_past_the_first_obstacles_the_mesh_stays_free_and_without_planning_it_touches() -> None:
    humanoid, course = opened("hanim_x3d/JoeKick.x3d", 1)
    piece = replace(course, limit=5.0)
    result, mesh = walked(controller_on(humanoid, piece, TrialSettings()), humanoid, piece)
    assert result.touching_frames == mesh.touching == 0
    assert mesh.least is not None
    assert mesh.least.clearance < 0.1
    _, canned = walked(Controller(humanoid, course.scene, assist=False), humanoid, course)
    assert canned.touching > 10
    assert canned.deepest > 0.02


@pytest.mark.long
@pytest.mark.parametrize("name", AVATARS)
def test_the_mesh_touches_nothing_on_whole_courses(name: str) -> None:
    walks = 0
    for seed in range(SEEDS):
        try:
            humanoid, course = opened(name, seed)
        except NoCourseError:  # a body as broad as a barrel gets none from some seeds
            continue
        walks += 1
        result, mesh = walked(controller_on(humanoid, course, TrialSettings()), humanoid, course)
        assert result.crossed, seed
        assert mesh.touching == 0, seed
        if walks == WALKS:
            return
    raise AssertionError(f"{walks} of {SEEDS} seeds give {name} a course")
