"""The order of the flows: plan, play, reset as in the paper's Figure 4, against a naive twin of the figure."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Phase
from elbowroom.control.plans import planners as module
from elbowroom.control.plans.canned import canned_walk
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.planning.command import Command
from elbowroom.planning.result import LocalPlan, PlanStatus
from elbowroom.planning.root.memory import RootMemory
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.plan import RootPlan, RootPlanKind
from elbowroom.planning.root.query import Asked
from elbowroom.world.scene import Scene

HUMANOID = proportional_humanoid(1.72)
INTERVAL, DT, SIZE = 0.25, 1 / 64, 3  # binary fractions: no rounding in the twin's sums
WALK = Command(forward=1.0)


class FakeRootPlanner:
    """Walks straight on at once."""

    memory = RootMemory()

    def __init__(self, humanoid: Humanoid, scene: Scene, above: object = None) -> None:
        pass

    def reset(self) -> None:
        pass

    def plan(self, asked: Asked) -> RootPlan:
        states = np.tile(asked.start.as_array(), (asked.horizon + 1, 1))
        states[:, 3] = asked.command.forward
        states[:, 1] += asked.command.forward * asked.interval * np.arange(asked.horizon + 1)
        return RootPlan(RootPath(asked.start_time, asked.interval, states), RootPlanKind.STRAIGHT, (0.0, 0.0), 0, 0)


class FakePlanner:
    """Succeeds or fails as it is told."""

    def __init__(self, outcomes: Iterator[bool]) -> None:
        self.outcomes = outcomes

    def reset(self) -> None:
        pass

    def plan(self, path: RootPath, start: np.ndarray, rng: np.random.Generator) -> LocalPlan:
        found = canned_walk(path, start)
        stands = not path.states[:, 3:6].any()  # asked after a failure, for the limbs alone: that is not the figure's
        if not stands and next(self.outcomes, True):
            return found
        return LocalPlan(PlanStatus.EXHAUSTED, found.configurations[:0], found.goals, ())


@pytest.fixture
def make(monkeypatch: pytest.MonkeyPatch):  # type: ignore[no-untyped-def]
    def controller(outcomes: list[bool], scene: str = "empty") -> Controller:
        monkeypatch.setattr(module, "RootPlanner", FakeRootPlanner)
        monkeypatch.setattr(module, "make_planner", lambda *_: FakePlanner(iter(outcomes)))
        return Controller(HUMANOID, Scene.load(scene), ahead=Lookahead(SIZE, INTERVAL))

    return controller


def naive_flows(outcomes: list[bool], steps: int) -> list[Phase]:
    """Figure 4 with a queue that is only a number: the time until which there is something to play."""
    answers = iter(outcomes)
    flows = []
    time = planned_at = 0.0
    queue_ends = next_key = 0.0
    flow = Phase.PLAN
    held = False
    for _ in range(steps):
        if flow is Phase.RESET and held and time - planned_at < INTERVAL:
            flows.append(Phase.PLAY)
        else:
            flows.append(flow)
            if flow is not Phase.PLAY:
                start = next_key if queue_ends > time else time
                planned_at = time
                if next(answers, True):
                    queue_ends = start + SIZE * INTERVAL
                    first_key = start if start > time else start + INTERVAL
                    next_key = first_key
        held = queue_ends <= time
        time += DT
        while next_key <= time and next_key < queue_ends:
            next_key += INTERVAL
        if queue_ends <= time:
            flow = Phase.RESET
        elif time - planned_at > INTERVAL:
            flow = Phase.PLAN
        else:
            flow = Phase.PLAY
    return flows


@pytest.mark.long
@settings(deadline=None, max_examples=30)
@given(outcomes=st.lists(st.booleans(), max_size=20))
def test_flows_follow_the_figure(outcomes: list[bool]) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "RootPlanner", FakeRootPlanner)
        patch.setattr(module, "make_planner", lambda *_: FakePlanner(iter(outcomes)))
        controller = Controller(HUMANOID, Scene.load("empty"), ahead=Lookahead(SIZE, INTERVAL))
        flows = [controller.step(WALK, DT).phase for _ in range(300)]
    assert flows == naive_flows(outcomes, 300)


def test_a_turn_that_plans_plays_as_well(make) -> None:  # type: ignore[no-untyped-def]
    controller = make([])
    frame = controller.step(WALK, DT)
    assert frame.phase is Phase.PLAN
    assert frame.time == DT
    assert frame.q[1] > controller.start.z


def test_failed_plans_leave_what_is_in_the_queue(make) -> None:  # type: ignore[no-untyped-def]
    controller = make([True] + 100 * [False])
    frames = [controller.step(WALK, DT) for _ in range(int(2 * SIZE * INTERVAL / DT))]
    fills = [frame.fill for frame in frames]
    assert all(after <= before for before, after in pairwise(fills))
    assert fills[-1] == 0
    moving = [frame for frame in frames if frame.fill]
    assert not any(frame.stuck for frame in moving)
    assert frames[-1].stuck
    assert np.array_equal(frames[-1].root[3:6], np.zeros(3))


def test_while_stuck_planning_is_tried_once_an_interval(make) -> None:  # type: ignore[no-untyped-def]
    controller = make(100 * [False])
    numbers = [controller.step(WALK, DT).plan.number for _ in range(int(10 * INTERVAL / DT))]
    assert numbers[-1] <= 11


def test_a_new_wish_is_planned_for_at_once(make) -> None:  # type: ignore[no-untyped-def]
    controller = make([])
    for _ in range(10):
        controller.step(WALK, DT)
    frame = controller.step(Command(forward=1.0, strafe=1.0), DT)
    assert frame.phase is Phase.PLAN
    assert frame.key_frames.times[0] == pytest.approx(frame.time - DT + INTERVAL)


@pytest.mark.parametrize("command", [Command(), Command(forward=-1.0)])
def test_letting_go_and_turning_back_reset(make, command: Command) -> None:  # type: ignore[no-untyped-def]
    controller = make([True, False])
    for _ in range(10):
        controller.step(WALK, DT)
    frame = controller.step(command, DT)
    assert frame.phase is Phase.RESET
    assert frame.fill == 0
    assert frame.stuck is not command.idle


@pytest.mark.parametrize("command", [Command(), Command(forward=-1.0)])
def test_who_finds_no_other_way_does_not_stand_in_the_way_of_what_moves(make, command: Command) -> None:  # type: ignore[no-untyped-def]
    """What was planned among things that move is free: it is gone on with, until it ends."""
    controller = make([True] + 100 * [False], "traffic")
    for _ in range(10):
        controller.step(WALK, DT)
    before = controller.root
    frames = [controller.step(command, DT) for _ in range(int(0.5 / DT))]
    assert frames[0].phase is Phase.RESET
    assert frames[0].fill > 0
    assert controller.root.z == pytest.approx(before.z + 0.5)
