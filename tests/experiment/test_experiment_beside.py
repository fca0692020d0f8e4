"""Trials with plans made beside playback: answers come late, frames do not wait, nothing touches."""

import time
from typing import Any, cast

import pytest

from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.control.plans.desk import Job
from elbowroom.experiment.beside import BesideDesk
from elbowroom.experiment.crossing import DT, controller_for, run_timed_crossing
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.world.scene import Scene

ANSWER = cast(Any, object())


class SlowDesk(BesideDesk):
    """As if every plan took so many frames longer."""

    def __init__(self, frames: int) -> None:
        super().__init__(DT)
        self._more = frames

    def submit(self, job: Job) -> None:
        super().submit(job)
        self._frames += self._more


def test_an_answer_is_held_back_for_as_long_as_it_took() -> None:
    desk = BesideDesk(0.01)
    assert desk.take() is None

    def job() -> Any:
        time.sleep(0.035)
        return ANSWER

    desk.submit(job)
    assert desk.last >= 0.035
    assert desk.processor < 0.5 * desk.last
    assert [desk.take() for _ in range(4)] == [None] * 4
    later = [desk.take() for _ in range(1000)]
    assert later.count(ANSWER) == 1
    assert later.index(ANSWER) + 4 == pytest.approx(desk.last / 0.01, abs=2.0)
    assert not desk.busy
    assert desk.take() is None


def test_a_plan_that_is_let_go_is_never_heard_of() -> None:
    desk = BesideDesk(0.01)
    desk.submit(lambda: ANSWER)
    desk.forget()
    assert not desk.busy
    assert desk.take() is None


@pytest.mark.parametrize("frames", [0, 6])
def test_a_walk_with_late_plans_is_straight_and_touches_nothing(frames: int) -> None:
    settings = CrossingSettings("exact", seed=3, live=True)
    desk = SlowDesk(frames)
    controller = controller_for(proportional_humanoid(1.72), Scene.load("b"), settings, desk=desk)
    clearances = []
    result, times = run_timed_crossing(controller, settings, lambda frame, _: clearances.append(frame.clearance), desk)
    assert result.passed
    assert result.straight
    assert min(clearances) >= 0.0
    assert len(times.plan_ms) == result.plans_total
    assert times.plan_ms.sum() <= 1e3 * desk.spent + 1.0
