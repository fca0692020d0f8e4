"""How high a step bodies take: as high as their own trunk lets a leg be raised."""

from functools import cache

import numpy as np
import pytest

from elbowroom.body.dof import SEARCH_ORDER, DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import RISES, ROOT_STATE
from elbowroom.control.controller import Controller
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.planning.command import Command
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.highest_step import as_stepped, highest_step
from elbowroom.planning.model.self_pairs import self_clearances, self_pairs
from elbowroom.planning.navigation.way import NoWayError
from elbowroom.planning.root.path import RootPath
from elbowroom.world.ground.ground import STEP, height_at
from elbowroom.world.scene import Scene
from sampled import sampled
from shared_data import SHARED, needs_shared

LITTLE = "glb/KayKit_Knight.glb"  # 0.96 m tall, with legs of 16 cm
STEPS = 4
GOAL = 4.5  # metres ahead, on the floor above


def stair(rise: float) -> Scene:
    """Steps of 28 cm that lead up to a floor."""
    ends = [(2.0 + 0.28 * i, 7.0) for i in range(STEPS)]
    boxes = [
        {"type": "box", "center": [0.0, 0.5 * rise * (i + 1), 0.5 * (a + b)], "size": [4.0, rise * (i + 1), b - a]}
        for i, (a, b) in enumerate(ends)
    ]
    return Scene.of("stair", boxes, finish=(0.0, GOAL))


@cache
def avatar(name: str) -> Humanoid:
    assert SHARED is not None
    return Humanoid.load(SHARED / "avatars" / name)


def touches_itself(humanoid: Humanoid, scene: Scene, turns: int) -> tuple[float, int]:
    """How far ahead one gets within some turns, and in how many poses parts of the body are in each other."""
    controller = Controller(humanoid, scene)
    frames = [controller.step(Command(forward=1.0), 1 / 60) for _ in range(turns)]
    motion = ShownMotion.at_rate(np.stack([frame.q for frame in frames]), np.stack([frame.root for frame in frames]))
    verdict = judge(motion, humanoid, scene, JudgeSettings(mesh=False))
    assert verdict.capsules.touching == 0
    return float(controller.root.z), verdict.itself.touching


def test_whoever_has_long_legs_takes_all_steps() -> None:
    stock = Humanoid.default()
    assert highest_step(stock) == STEP
    scene = stair(0.17)
    assert as_stepped(scene, stock) is scene


@needs_shared
@pytest.mark.parametrize(
    "name", sampled([LITTLE, "vrm0/Godette_vrm_v4.vrm", "glb/boxman.glb", "glb/m2m_human-male.glb"])
)
def test_legs_stay_out_of_the_trunk_on_steps_that_are_taken(name: str) -> None:
    humanoid = avatar(name)
    model, highest = body_model(humanoid), highest_step(humanoid)
    assert highest > 0.0
    states = np.zeros((40, ROOT_STATE))
    states[:, 3], states[:, 6] = np.linspace(0.0, 0.6, 40), np.linspace(0.0, 3.0, 40) % 1.0
    states[:, RISES + 2] = highest
    uppers = natural_walk()(RootPath(0.0, 1.0, states))
    assert self_clearances(model, self_pairs(model), states, uppers)[SEARCH_ORDER.index(DofGroup.WAIST)].min() >= 0.0


@needs_shared
def test_steps_that_are_too_high_are_in_the_way_and_a_way_says_so() -> None:
    humanoid, high, low = avatar(LITTLE), stair(0.17), stair(0.03)
    ground = as_stepped(high, humanoid).ground
    assert height_at(high.ground, 0.0, 2.1, 0.0) == pytest.approx(0.17)
    assert height_at(ground, 0.0, 2.1, 0.0) == pytest.approx(0.0)
    assert as_stepped(high, humanoid) is as_stepped(high, humanoid), "one for all"
    with pytest.raises(NoWayError, match="steps of 4 cm are the highest"):
        Controller(humanoid, high).goto((0.0, 0.17 * STEPS, GOAL))
    Controller(humanoid, low).goto((0.0, 0.03 * STEPS, GOAL))


@needs_shared
@pytest.mark.long
def test_little_legs_stop_before_high_steps_and_go_up_low_ones_out_of_their_own_body() -> None:
    (up, in_itself), (stopped, held_in_itself) = (
        touches_itself(avatar(LITTLE), stair(rise), 360) for rise in (0.03, 0.17)
    )
    assert up > GOAL
    assert stopped < 2.0
    assert in_itself == held_in_itself == 0
