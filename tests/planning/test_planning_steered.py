"""What is planned while a user steers: something else is wanted in every plan, so only what is found soon is sought."""

import math

import numpy as np
import pytest

from elbowroom.body.dof import DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.planning.command import Command
from elbowroom.planning.exact.joint.step import JointStep
from elbowroom.planning.exact.plan.attempts import AttemptOrder
from elbowroom.planning.result import GroupEvidence, JointEvidence, LocalPlan, PlanStatus
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


def test_who_turns_all_the_time_gets_no_joint_step_while_walking(monkeypatch: pytest.MonkeyPatch) -> None:
    times = DT * np.arange(360.0)
    speeds, controller = walked((0.12 * np.sin(4.0 * times)).tolist(), monkeypatch)
    assert all(speed < 0.2 for speed in speeds)  # planned ahead of what is shown: who is about to stand
    assert controller.root.z > 2.0


def test_a_plan_in_a_hurry_is_soon_spent() -> None:
    searched = GroupEvidence(DofGroup.WAIST, PlanStatus.FOUND, 30_000, 1500, 0, 0)
    blank = np.zeros((0, 11))
    plain = LocalPlan(PlanStatus.FOUND, blank, blank, (searched,))
    joint = plain._replace(joint=JointEvidence(PlanStatus.FOUND, 300_000, 600_000, 0))
    counts = []
    for hurry in (True, False):
        order, count = AttemptOrder(), 0
        order.begin(hurry=hurry, moves=True)
        while not order.spent:
            order.enter_root(1000)
            order.enter(plain)
            count += 1
        counts.append(count)
        order.begin(hurry=hurry, moves=True)
        order.enter(joint)
        assert order.spent is hurry
    assert 0 < counts[0] < counts[1]
