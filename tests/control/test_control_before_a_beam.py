"""Who has come to a stand with the face at a beam takes a step back, bends, and passes."""

import math
import random

import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.control.controller import Controller
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from late_desk import LateDesk

BEYOND = 2.8  # metres
PATIENCE = 8.0  # seconds


@pytest.mark.parametrize(
    ("z", "phase"),
    [
        (1.77, 0.0),
        *(pytest.param(*at, marks=pytest.mark.long) for at in ((1.65, 1.9), (1.72, 1.9), (1.8, 1.9), (1.805, 0.0))),
    ],
)
def test_who_stands_at_a_beam_passes_under_it(z: float, phase: float) -> None:
    controller = Controller(Humanoid.default(), Scene.load("beam"), start=RootState(0.0, z, phase=phase))
    time = 0.0
    while controller.root.z < BEYOND:
        frame = controller.step(Command(forward=1.0, direction=0.0), 1 / 60)
        assert frame.clearance >= 0.0
        time += 1 / 60
        assert time < PATIENCE, f"still at z {controller.root.z:.3f}: {frame.plan and frame.plan.local.blockade}"


@pytest.mark.parametrize("z", [1.72, pytest.param(1.805, marks=pytest.mark.long)])
def test_so_does_one_whose_hand_is_not_still(z: float) -> None:
    controller = Controller(Humanoid.default(), Scene.load("beam"), start=RootState(0.0, z, phase=0.0))
    chance, time = random.Random(1), 0.0
    while controller.root.z < BEYOND:
        frame = controller.step(Command(forward=1.0, direction=math.radians(chance.uniform(-4.0, 4.0))), 1 / 60)
        assert frame.clearance >= 0.0
        time += 1 / 60
        assert time < 2.0 * PATIENCE, f"still at z {controller.root.z:.3f}"


@pytest.mark.parametrize("seed", [1, 15, 35])
def test_who_has_found_a_way_keeps_to_it_however_late_plans_come(seed: int) -> None:
    """One slower than asked for was given up each time that the commanded one was tried again, for one that ends."""
    chance = random.Random(seed)
    desk = LateDesk(chance.choice([0, 2, 6, 15, 30]))
    command = Command(run=chance.random() < 0.7, forward=chance.uniform(0.5, 1.0), direction=0.0)
    scene, begins = Scene.load("beam"), chance.uniform(0.0, 1.0)
    controller, time = Controller(Humanoid.default(), scene, ahead=Lookahead(desk=desk)), 0.0
    while not scene.finished(controller.root):
        desk.next_turn()
        frame = controller.step(command if time > begins else Command(), 1 / 60)
        assert frame.clearance >= 0.0
        time += 1 / 60
        assert time < 3.0 * PATIENCE, f"still at z {controller.root.z:.3f}"
