"""What is planned while a user steers: something else is wanted in every plan, so only what is found soon is sought."""

import math
from dataclasses import replace

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.planning.command import Command, trembles
from elbowroom.planning.exact.joint.step import JointStep
from elbowroom.planning.exact.plan.full_plan import FullPlan
from elbowroom.planning.exact.plan.new_plan import NewPlan
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

DT = 1 / 60


def walked(directions: list[float], monkeypatch: pytest.MonkeyPatch) -> tuple[list[float], Controller]:
    """Walk through D, a frame for each direction; the speeds of the root at which a joint step was made."""
    speeds: list[float] = []
    controller = Controller(Humanoid.default(), Scene.load("d"))
    search = JointStep.search

    def counted(step: JointStep, *args: object) -> object:
        speeds.append(math.hypot(controller.root.forward, controller.root.lateral))
        return search(step, *args)  # type: ignore[arg-type]

    monkeypatch.setattr(JointStep, "search", counted)
    for direction in directions:
        frame = controller.step(Command(forward=1.0, direction=direction), DT)
        assert not frame.touching
    return speeds, controller


def _pillar(width: float) -> Scene:
    obstacles = [{"type": "box", "center": [0.0, 1.1, 2.5], "size": [width, 2.2, 0.5]}]
    return Scene.from_dict({**Scene.load("empty").to_dict(), "obstacles": obstacles})


@pytest.mark.parametrize("width", [0.6, 1.2, 1.6])
def test_who_pulls_back_to_his_line_is_led_past_a_pillar_without_turning_about(width: float) -> None:
    controller, turned = Controller(Humanoid.default(), _pillar(width)), 0.0
    for _ in range(360):
        root = controller.root
        back = max(-0.5, min(0.5, -1.5 * root.x))
        assert not controller.step(Command(forward=1.0, direction=back), DT).touching
        turned += abs(controller.root.heading - root.heading)
    assert controller.root.z > 5.0  # 6 s; as fast as one who does not pull, less a second
    assert turned < 2.5  # radians in all


def test_who_turns_all_the_time_gets_no_joint_step_while_walking(monkeypatch: pytest.MonkeyPatch) -> None:
    times = DT * np.arange(360.0)
    speeds, controller = walked((0.12 * np.sin(4.0 * times)).tolist(), monkeypatch)
    assert all(speed < 0.2 for speed in speeds)  # planned ahead of what is shown: who is about to stand
    assert controller.root.z > 2.0


def test_who_stands_gives_the_same_answer_soon_and_never_asks_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    """In a blind alley, with keys that flip: each wish is thought through a part at a time, and then known."""
    walls = Obstacles.boxes(
        [(0.0, 1.0, 1.0), (0.55, 1.0, 0.0), (-0.55, 1.0, 0.0)], [(0.0, 0.0, 0.0, 1.0)] * 3,
        [(0.6, 1.0, 0.05), (0.05, 1.0, 1.0), (0.05, 1.0, 1.0)],
    )  # fmt: skip
    controller, asked = Controller(Humanoid.default(), replace(Scene.load("empty"), obstacles=walls)), []
    plan = UpperBodyPlanner.plan

    def counted(body: UpperBodyPlanner, path: RootPath, *args: object, **named: object) -> object:
        asked.append(path.states.tobytes())
        return plan(body, path, *args, **named)  # type: ignore[arg-type]

    monkeypatch.setattr(UpperBodyPlanner, "plan", counted)
    wishes = Command(forward=1.0, direction=0.0), Command(forward=1.0, direction=0.5)
    counts = []
    for number in range(4):
        asked.clear()
        for _ in range(120):
            frame = controller.step(wishes[number % 2], DT)
            assert not frame.touching
        counts.append(len(asked))
    assert math.hypot(controller.root.forward, controller.root.lateral) < 1e-3
    assert counts[-1] <= 2


def test_a_hand_that_trembles_asks_for_nothing_new(monkeypatch: pytest.MonkeyPatch) -> None:
    """Walking on in the open, plans are gone on with whatever a hand does that means the same."""
    steady = Command(forward=1.0, direction=0.0)
    assert trembles(steady, Command(forward=0.99, direction=math.radians(1.5)))
    for other in (Command(forward=1.0, direction=0.1), Command(forward=0.9, direction=0.0), Command(forward=1.0)):
        assert not trembles(steady, other)
    made, counts, new = NewPlan.made, [], []

    def counted(plan: NewPlan, left: FullPlan | None) -> FullPlan:
        new.append(plan)
        return made(plan, left)

    monkeypatch.setattr(NewPlan, "made", counted)
    controller = Controller(Humanoid.default(), Scene.load("empty"))
    for number in range(240):
        controller.step(Command(forward=1.0, direction=0.015 * math.sin(0.3 * number)), DT)
        counts.append(len(new))
    assert counts[-1] == counts[60]
    controller.step(Command(forward=1.0, direction=0.3), DT)
    assert controller.root.z > 2.0
