"""Humanoids of H-Anim and a robot of VRML97 cross scene A as the stock avatar does."""

from pathlib import Path

import pytest

from elbowroom.body.loading import load_humanoid
from elbowroom.experiment.crossing import CrossingSettings, controller_for, run_crossing
from elbowroom.world.scene import Scene
from shared_data import SHARED, needs_shared

FILES = sorted(SHARED.glob("avatars/hanim_*/*")) if SHARED else []


@needs_shared
@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_they_cross_scene_a_straight(path: Path) -> None:
    settings = CrossingSettings(seed=0)
    result = run_crossing(controller_for(load_humanoid(path), Scene.load("a"), settings), settings)
    assert result.passed
    assert result.straight
    assert result.least_clearance >= 0.0
