"""The scene that needs bent knees: crossed by who can crouch, and by nobody else."""

from dataclasses import replace

import numpy as np
import pytest

from elbowroom.body.dof import LOWERING, DofGroup, limits
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.control.frame import Frame
from elbowroom.experiment.crossing import CrossingResult, controller_for, run_crossing
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.world.scene import Scene
from sampled import sampled
from stiff import forbid_crouching

HUMANOID = Humanoid.default()


BEAM = Scene.load("beam")


def lower(scene: Scene, by: float) -> Scene:
    """The same with all obstacles lower, metres."""
    document = scene.to_dict()
    for obstacle in document["obstacles"]:
        obstacle["center"][1] -= by
    return Scene.from_dict(document)


def cross(
    seed: int, limit: float, humanoid: Humanoid = HUMANOID, scene: Scene = BEAM
) -> tuple[CrossingResult, list[Frame]]:
    settings = CrossingSettings(planner="exact", seed=seed, limit=limit)
    frames: list[Frame] = []
    controller = controller_for(humanoid, scene, settings)
    return run_crossing(controller, settings, lambda frame, dt: frames.append(frame)), frames


@pytest.mark.parametrize("seed", sampled([0, 1]))
def test_the_beam_is_passed_straight_with_bent_knees_and_touches_nothing(seed: int) -> None:
    result, frames = cross(seed, 20.0)
    assert result.straight
    q, roots = np.array([frame.q for frame in frames]), np.array([frame.root for frame in frames])
    assert q[:, LOWERING].max() > 0.2
    assert q[0, LOWERING] == 0.0
    verdict = judge(ShownMotion.at_rate(q, roots), HUMANOID, Scene.load("beam"), JudgeSettings(mesh=seed == 0))
    assert verdict.capsules.touching == 0
    assert verdict.mesh is None or verdict.mesh.touching == 0


def test_lower_than_a_bent_back_it_is_passed_by_who_can_crouch() -> None:
    result, frames = cross(0, 20.0, scene=lower(BEAM, 0.12))
    assert result.passed
    assert min(frame.clearance for frame in frames) >= 0.0


@pytest.mark.parametrize(
    ("humanoid", "under"), [(HUMANOID, 1.10), (proportional_humanoid(1.3), 0.83)], ids=["stock", "a smaller one"]
)
def test_a_beam_hardly_above_the_pelvis_is_passed_bent_from_the_hips(humanoid: Humanoid, under: float) -> None:
    """The lowest there is, 1.10 m for an avatar of 1.72 m and 0.83 for one of 1.3; back, hips and knees share it."""
    beam = {"type": "box", "name": "beam", "center": [0.0, under + 0.3, 1.6], "size": [6.0, 0.6, 0.2]}
    scene = Scene.of("low", [beam], finish=(0.0, 3.0))
    result, frames = cross(0, 25.0, humanoid, scene)
    assert result.passed
    assert min(frame.clearance for frame in frames) >= 0.0
    q, roots = np.array([frame.q for frame in frames]), np.array([frame.root for frame in frames])
    assert np.all(q[:, LOWERING] < 0.6)
    assert np.deg2rad(40.0) < q[:, DofGroup.WAIST.at.start].max() <= np.deg2rad(80.0)
    verdict = judge(ShownMotion.at_rate(q, roots), humanoid, scene, JudgeSettings(mesh=False))
    assert verdict.capsules.touching == 0
    assert verdict.itself.touching == 0


def test_a_body_that_cannot_crouch_stops_before_it(monkeypatch: pytest.MonkeyPatch) -> None:
    forbid_crouching(monkeypatch)
    assert not limits(DofGroup.WAIST)[2].any()
    result, frames = cross(0, 7.0, replace(HUMANOID), lower(BEAM, 0.12))
    assert not result.passed
    assert 1.0 < frames[-1].q[1] < 2.0
    assert min(frame.clearance for frame in frames) >= 0.0
