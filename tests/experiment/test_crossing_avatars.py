"""Avatars of others cross scene A as the stock avatar does: H-Anim, a robot of VRML97, VRM, glTF."""

from pathlib import Path

import pytest

from elbowroom.body.loading.avatar_file import load_humanoid
from elbowroom.experiment.crossing import CrossingResult, controller_for, run_crossing
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.world.scene import Scene
from sampled import sampled
from shared_data import SHARED, needs_shared

HANIM = sorted(SHARED.glob("avatars/hanim_*/*")) if SHARED else []
OTHERS = sorted([*SHARED.glob("avatars/glb/*"), *SHARED.glob("avatars/vrm[01]/*")]) if SHARED else []
RODS = "debug_robot.vrm"  # each of its limbs is three crossing rods half a metre long: it may well go round all of it


def crossed(path: Path) -> CrossingResult:
    settings = CrossingSettings(seed=0)
    result = run_crossing(controller_for(load_humanoid(path), Scene.load("a"), settings), settings)
    assert result.passed or path.name == RODS
    assert result.least_clearance >= 0.0
    return result


@needs_shared
@pytest.mark.parametrize("path", sampled(HANIM), ids=lambda path: path.name)
def test_h_anim_crosses_scene_a_straight(path: Path) -> None:
    assert crossed(path).straight


@needs_shared
@pytest.mark.long
@pytest.mark.parametrize("path", OTHERS, ids=lambda path: path.name)
def test_all_others_cross_scene_a_straight(path: Path) -> None:
    result = crossed(path)
    assert result.straight or path.name == RODS
