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
from sampled import sampled

DT, FORWARD = 1 / 60, Command(forward=1.0)


@pytest.fixture(scope="module")
def humanoid() -> Humanoid:
    return Humanoid.default()


def test_a_whiff_of_velocity_hides_no_stop(humanoid: Humanoid) -> None:
    wall = Obstacles.boxes(np.array([[0.0, 1.0, 2.0]]), np.array([[0.0, 0, 0, 1]]), np.array([[4.0, 1.0, 0.1]]))
    scene = replace(Scene.load("empty"), obstacles=wall)
    controller = Controller(humanoid, scene)
    for _ in range(360):
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


@pytest.mark.parametrize("turn", sampled([1.0, -1.0]))
def test_after_a_turn_in_place_the_avatar_comes_to_a_stand(turn: float, humanoid: Humanoid) -> None:
    for held in range(30, 46):  # released at any moment between key frames
        controller = Controller(humanoid, Scene.load("empty"))
        for _ in range(held):
            controller.step(Command(turn=turn), DT)
        frames = [controller.step(Command(), DT) for _ in range(90)]
        assert is_still(frames[-1].root[3:6]), held
        assert np.array_equal(frames[-1].q, frames[-2].q)


@pytest.mark.long
@pytest.mark.parametrize("place", [(0.0, 0.0), (-0.3, -0.4)])
def test_who_stands_hard_by_a_thing_that_was_pushed_stops_planning(place: tuple[float, float]) -> None:
    """The thing has come as near as things may, so there is no room for steps: legs glide to their stand."""
    crate = {"type": "box", "center": [2.0, 0.8, 2.5], "size": [0.5, 1.6, 0.5], "yaw": 0.4}
    controller = Controller(Humanoid.default(), Scene.of("push", [crate], finish=(0.0, 6.0)))
    controller.push(0, place)
    frames = [controller.step(Command(), DT) for _ in range(420)]
    plans = [frame.plan.number for frame in frames[-120:] if frame.plan]
    assert plans[-1] - plans[0] <= 1
    assert 0.0 < frames[-1].clearance < 0.05
