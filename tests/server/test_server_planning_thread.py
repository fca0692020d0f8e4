"""Planning in a thread: playback never waits for it, failures arrive, and what is given up is never heard of."""

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import closing
from typing import Any

import pytest

from elbowroom.planning.command import Command
from elbowroom.server.sessions.planning_thread import PlanningThread
from elbowroom.server.sessions.walk import Walk, WalkSettings
from elbowroom.server.stores.library import Library

LONG = 120.0  # seconds: only a hang lasts longer
WALK, BACK = Command(forward=1.0), Command(forward=-1.0)
DT = 1 / 60


class GatedExecutor(ThreadPoolExecutor):
    """Jobs wait before a gate."""

    def __init__(self) -> None:
        super().__init__(4)
        self.gate = threading.Event()
        self.jobs: list[Future[Any]] = []

    def submit(self, job: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        def gated() -> Any:
            assert self.gate.wait(LONG)
            return job(*args, **kwargs)

        self.jobs.append(super().submit(gated))
        return self.jobs[-1]


@pytest.fixture(scope="module")
def library() -> Iterator[Library]:
    with closing(Library.open("d")) as opened:
        yield opened


@pytest.fixture
def executor() -> Iterator[GatedExecutor]:
    with GatedExecutor() as made:
        yield made
        made.gate.set()


def walk_of(library: Library, executor: GatedExecutor) -> Walk:
    desk = PlanningThread(executor)
    return Walk(library.avatars.get("stock"), library.scenes["d"], WalkSettings(), desk=desk)


def under_way(library: Library, executor: GatedExecutor) -> Walk:
    """A walk at some speed, whose next plan is not made before the gate opens."""
    walk = walk_of(library, executor)
    executor.gate.set()
    while walk.frame.root[3] < 0.5:
        walk.step(WALK, DT)
        wait(executor.jobs)
    executor.gate.clear()
    return walk


def test_playback_goes_on_while_a_plan_is_made(library: Library, executor: GatedExecutor) -> None:
    walk = under_way(library, executor)
    plans, began = walk.plans, walk.frame
    for _ in range(60):  # if a turn waited for the plan, this would never end
        walk.step(WALK, DT)
        assert walk.frame.clearance >= 0.0
    assert walk.frame.root[1] > began.root[1] + 0.5
    assert walk.plans <= plans + 1
    executor.gate.set()
    while walk.plans == plans:  # that plan may have come too late; then there is another
        wait(executor.jobs)
        walk.step(WALK, DT)


def test_one_session_waits_for_no_other(library: Library, executor: GatedExecutor) -> None:
    slow, other = walk_of(library, executor), walk_of(library, executor)
    slow.step(WALK, DT)
    executor.gate.set()
    for _ in range(30):
        other.step(WALK, DT)
        wait(executor.jobs[1:])
    assert other.frame.root[1] > other.scene.start.z + 0.1


def test_what_a_plan_raises_is_raised_where_it_is_taken() -> None:
    with ThreadPoolExecutor(1) as threads:
        desk = PlanningThread(threads)
        desk.submit(lambda: 1 // 0)  # type: ignore[arg-type, return-value]
        threads.submit(lambda: None).result()
        assert desk.busy
        with pytest.raises(ZeroDivisionError):
            desk.take()
        assert not desk.busy


def test_a_plan_that_was_given_up_is_never_heard_of(library: Library, executor: GatedExecutor) -> None:
    walk = walk_of(library, executor)
    walk.step(WALK, DT)
    walk.reset()
    executor.gate.set()
    wait(executor.jobs)
    executor.gate.clear()  # the next plan is not made before this one would be heard of
    walk.step(Command(), DT)
    assert walk.plans == 0


def test_a_plan_for_what_is_not_wanted_any_more_is_called_off(library: Library, executor: GatedExecutor) -> None:
    walk = under_way(library, executor)
    jobs = len(executor.jobs)
    while len(executor.jobs) == jobs:
        walk.step(WALK, DT)
    walk.step(BACK, DT)  # while the plan is in the making
    executor.gate.set()
    assert executor.jobs[-1].result() is None
    walk.step(BACK, DT)
    assert len(executor.jobs) == jobs + 2
    assert executor.jobs[-1].result() is not None
    while not walk.heeds(BACK):
        walk.step(BACK, DT)
        wait(executor.jobs)
        assert walk.frame.clearance >= 0.0
