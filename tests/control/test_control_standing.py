"""Standing is noticed, however little is left of a velocity, and only once what is shown stands."""

from dataclasses import replace

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.planning.command import Command
from elbowroom.planning.stillness import is_still
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

DT, FORWARD = 1 / 60, Command(forward=1.0)


@pytest.fixture(scope="module")
def humanoid() -> Humanoid:
    return Humanoid.default()


def test_a_whiff_of_velocity_hides_no_stop(humanoid: Humanoid) -> None:
    wall = Obstacles.boxes(np.array([[0.0, 1.0, 2.0]]), np.array([[0.0, 0, 0, 1]]), np.array([[4.0, 1.0, 0.1]]))
    scene = replace(Scene.load("empty"), obstacles=wall)
    controller = Controller(humanoid, scene)
    for _ in range(240):
        frame = controller.step(FORWARD, DT)
    assert frame.stuck
    for velocity in (1e-19, -1e-44):
        controller._shown.root[3:6] = velocity
        assert controller.step(FORWARD, 0.0).stuck


def test_an_idle_avatar_with_a_whiff_of_velocity_stops_planning(humanoid: Humanoid) -> None:
    controller = Controller(humanoid, Scene.load("empty"))
    controller._shown.root[3:6] = 1e-19
    plans = [frame.plan.number for frame in (controller.step(Command(), DT) for _ in range(60)) if frame.plan]
    assert plans[-1] <= 2


@pytest.mark.parametrize("turn", [1.0, -1.0])
def test_after_a_turn_in_place_the_avatar_comes_to_a_stand(turn: float, humanoid: Humanoid) -> None:
    for held in range(30, 46):  # released at any moment between key frames
        controller = Controller(humanoid, Scene.load("empty"))
        for _ in range(held):
            controller.step(Command(turn=turn), DT)
        frames = [controller.step(Command(), DT) for _ in range(90)]
        assert is_still(frames[-1].root[3:6]), held
        assert np.array_equal(frames[-1].q, frames[-2].q)
