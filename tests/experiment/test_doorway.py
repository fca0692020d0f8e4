"""A doorway narrower than the shoulders: passed with a turned torso, by the exact planner alone, touching nothing."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.frame import Frame
from elbowroom.experiment.crossing import controller_for, run_crossing
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.world.scene import Scene

DOORWAY = Scene.load("doorway")
AVATAR = Humanoid.default()


def cross(planner: str, limit: float, seed: int = 1) -> tuple[bool, NDArray[np.float64], NDArray[np.float64]]:
    """Whether it went straight, and the frames' configurations and root states."""
    settings, frames = CrossingSettings(planner=planner, seed=seed, limit=limit), list[Frame]()

    def keep(frame: Frame, dt: float) -> None:
        frames.append(frame)

    result = run_crossing(controller_for(AVATAR, DOORWAY, settings), settings, keep)
    return result.straight, np.array([frame.q for frame in frames]), np.array([frame.root for frame in frames])


def test_the_exact_planner_turns_passes_and_turns_back_and_touches_nothing() -> None:
    pytest.importorskip("coal")
    straight, q, roots = cross("exact", 15.0)
    assert straight
    within = np.abs(roots[:, 1] - 2.2) < 0.1
    assert np.abs(roots[within, 2]).min() > np.radians(70.0)
    assert abs(roots[-1, 2]) < np.radians(10.0)
    assert abs(roots[-1, 0]) < 0.1
    verdict = judge(ShownMotion.at_rate(q, roots), AVATAR, DOORWAY, JudgeSettings(mesh=False))
    assert verdict.clean, verdict.capsules.contacts[0]


def test_the_papers_search_does_not_get_through() -> None:
    straight, _, roots = cross("figure6", 4.0)
    assert not straight
    assert roots[:, 1].max() < 2.2
