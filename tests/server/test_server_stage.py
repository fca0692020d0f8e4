"""Stage and walk without a network: clock, counters, speeds."""

import asyncio
import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from elbowroom.body.stock import stock_avatar_path
from elbowroom.errors import InputError
from elbowroom.experiment.rehearsal import rehearse_detour
from elbowroom.planning.command import Command
from elbowroom.planning.root.pace import at_speed
from elbowroom.planning.root.plan import RootPlanKind
from elbowroom.planning.root.settings import RootMotionSettings
from elbowroom.server.entrance.rate_limit import TokenBucket
from elbowroom.server.kernels.warmup import warm_up
from elbowroom.server.schema.commands import ClockMessage, Input, Overlays, Push
from elbowroom.server.schema.progress import Notice, Plan, Pong
from elbowroom.server.sessions.outbox import MAX_WAITING, Outbox, SlowClientError
from elbowroom.server.sessions.stage import STEP, Stage
from elbowroom.server.sessions.walk import Walk, WalkSettings
from elbowroom.server.stores.library import Library
from elbowroom.server.wire.pose_frame import parse
from sent_files import add_avatar

MOTION = RootMotionSettings()


@pytest.fixture(scope="module")
def library() -> Iterator[Library]:
    opened = Library.open("empty")
    yield opened
    opened.close()


@pytest.fixture
def walk(library: Library) -> Walk:
    return Walk(library.avatars.get("stock"), library.scenes["empty"], WalkSettings())


@pytest.fixture
def stage(walk: Walk) -> Stage:
    return Stage(walk, 0.0)


def test_simulated_time_follows_the_clock_whatever_the_ticks(stage: Stage) -> None:
    rng, now = np.random.default_rng(0), 0.0
    stage.obey(Input(seq=1, forward=1.0), 0.0)
    for gap in rng.uniform(0.0, 0.03, 200):
        now += gap
        stage.advance(now)
    assert stage.walk.frame.time == pytest.approx(now)


def test_the_pose_depends_on_time_and_not_on_how_often_it_is_asked_for(library: Library, stage: Stage) -> None:
    other = Stage(Walk(library.avatars.get("stock"), library.scenes["empty"], WalkSettings()), 0.0)
    for one in (stage, other):
        one.obey(Input(seq=1, forward=1.0), 0.0)
    for i in range(60):
        stage.advance((i + 1) / 60)
    for i in range(240):
        other.advance((i + 1) / 240)
    assert stage.walk.place.z == pytest.approx(other.walk.place.z, abs=0.05)


def test_a_long_gap_is_not_made_up_for(stage: Stage) -> None:
    stage.advance(5.0)
    assert stage.walk.frame.time == pytest.approx(0.1)
    stage.advance(4.0)
    assert stage.walk.frame.time == pytest.approx(0.1)


def test_speed_and_pause(stage: Stage) -> None:
    stage.set_clock(ClockMessage(speed=0.5))
    stage.advance(0.1)
    assert stage.walk.frame.time == pytest.approx(0.05)
    stage.set_clock(ClockMessage(steps=3))
    assert stage.walk.frame.time == pytest.approx(0.05 + 3 * STEP)
    assert stage.paused
    stage.advance(0.2)
    assert stage.walk.frame.time == pytest.approx(0.05 + 3 * STEP)
    stage.set_clock(ClockMessage(paused=False))
    stage.advance(0.3)
    assert stage.walk.frame.time == pytest.approx(0.1 + 3 * STEP)


def test_inputs_are_acknowledged_and_only_changes_count(stage: Stage) -> None:
    assert stage.obey(Input(seq=1, forward=1.0), 0.0)
    assert not stage.obey(Input(seq=2, forward=1.0), 0.0)
    assert parse(stage.frame(0.0)).acknowledged == 2
    stage.release()
    assert stage.obey(Input(seq=3, forward=1.0), 0.0)


def test_a_jump_changes_the_epoch_and_a_new_avatar_the_revision(library: Library, stage: Stage) -> None:
    first = parse(stage.frame(0.0))
    stage.reset()
    second = parse(stage.frame(0.1))
    assert second.epoch != first.epoch
    assert second.avatar_revision == first.avatar_revision
    stage.walk.crossed = 3
    other = add_avatar(library.avatars, stock_avatar_path().read_bytes(), "other.vrm")
    stage.show(Walk(other, library.scenes["empty"], WalkSettings()))
    third = parse(stage.frame(0.2))
    assert third.avatar_revision == stage.revision != second.avatar_revision
    assert stage.walk.crossed == 3
    stage.show(Walk(other, library.scenes["a"], WalkSettings()))
    assert (stage.walk.crossed, stage.walk.stuck_times) == (0, 0)


def test_crossing_counts_once_until_the_avatar_was_back_at_the_start(walk: Walk) -> None:
    def cross() -> float:
        for _ in range(60 * 30):
            seconds = walk.step(Command(forward=1.0, run=True), STEP)
            if seconds is not None:
                return seconds
        raise AssertionError("never crossed")

    for _ in range(60):
        assert walk.step(Command(), STEP) is None
    start, finish = walk.scene.start, walk.scene.finish
    way = math.hypot(finish.position[0] - start.x, finish.position[1] - start.z)
    first = cross()
    assert way / MOTION.run_speed < first < 2.0 * way / MOTION.run_speed + 1.0
    assert all(walk.step(Command(forward=1.0), STEP) is None for _ in range(30))
    assert (walk.crossed, walk.finished) == (1, True)
    walk.reset()
    assert not walk.finished
    assert cross() == pytest.approx(first, abs=0.2)
    assert walk.crossed == 2


def test_who_hardly_moves_at_the_start_has_not_set_off(walk: Walk) -> None:
    walk.step(Command(), 1.0)
    for speed, began in ((1e-19, walk.frame.time), (0.1, -1.0)):
        walk._started = -1.0
        walk._wait_for_start(walk.place._replace(forward=speed, lateral=-1e-44))
        assert walk._started == began


def test_status_and_plan_tell_what_the_controller_did(stage: Stage) -> None:
    stage.overlays = Overlays(capsules=True, plan=True)
    stage.obey(Input(seq=1, forward=1.0), 0.0)
    for i in range(30):
        stage.advance((i + 1) / 60)
        stage.frame((i + 1) / 60)
    status, plan = stage.status(0.5), stage.plan()
    assert status.plans >= 1
    assert status.plan_status == "found"
    assert [group.group for group in status.groups] == ["waist", "head", "leftArm", "rightArm"]
    assert status.checks == sum(group.checks for group in status.groups)
    assert 0.0 < status.frame_ms_p50 <= status.frame_ms_p95
    assert (status.clearance, status.nearest) == (None, None)
    assert status.queue_fill == status.queue_size
    assert len(plan.ghosts) >= status.queue_fill > 0
    assert plan.times == sorted(plan.times)


@given(forward=st.floats(-1, 1), strafe=st.floats(-1, 1), speed=st.floats(0.2, 2.0), run=st.booleans())
def test_walking_speed_becomes_a_share_of_the_planners_own(
    forward: float, strafe: float, speed: float, run: bool
) -> None:
    scaled = at_speed(Command(forward, strafe, 0.3, 1.0, run), speed)
    assert (scaled.turn, scaled.direction) == (0.3, 1.0)
    assert abs(scaled.forward) <= 1.0
    assert abs(scaled.strafe) <= abs(strafe)
    if forward > 0.0:
        reached = scaled.forward * (MOTION.run_speed if scaled.run else MOTION.walk_speed)
        wanted = forward * speed * (MOTION.run_speed / MOTION.walk_speed if run else 1.0)
        assert reached == pytest.approx(min(wanted, MOTION.run_speed))
    assert at_speed(Command(forward, strafe), MOTION.walk_speed).forward == pytest.approx(forward)


def test_warming_up_leaves_nothing_to_compile(library: Library) -> None:
    warm_up(library)
    assert library.warm.is_set()
    compiled: list[str] = []
    warm_up(library, lambda name, number: compiled.append(f"{number} {name}"))
    assert compiled == []


def test_the_rehearsal_meets_a_way_round(library: Library) -> None:
    path = rehearse_detour(library.avatars.get("stock").humanoid)
    assert path.kind is RootPlanKind.DETOUR


@given(rate=st.floats(1, 100), burst=st.integers(1, 50), gaps=st.lists(st.floats(0, 0.2), min_size=1, max_size=200))
def test_a_bucket_lets_through_no_more_than_its_rate(rate: float, burst: int, gaps: list[float]) -> None:
    bucket, now, passed = TokenBucket(rate, float(burst)), 0.0, 0
    for gap in gaps:
        now += gap
        passed += bucket.allows(now)
    assert passed <= burst + rate * (now - gaps[0]) + 1e-6
    assert passed >= min(len(gaps), burst)


class Socket:
    """Takes what is sent; `take` says how many messages it reads before it blocks."""

    def __init__(self, take: int) -> None:
        self.sent: list[str | bytes] = []
        self._room = asyncio.Semaphore(take)

    async def send_text(self, text: str) -> None:
        await self._room.acquire()
        self.sent.append(text)

    async def send_bytes(self, data: bytes) -> None:
        await self._room.acquire()
        self.sent.append(data)


async def sent_by(outbox: Outbox, socket: Socket) -> None:
    task = asyncio.create_task(outbox.send_to(socket))  # type: ignore[arg-type]
    for _ in range(20):
        await asyncio.sleep(0)
    task.cancel()


def test_a_slow_client_gets_the_newest_frame_only() -> None:
    async def scenario() -> list[str | bytes]:
        outbox, socket = Outbox(), Socket(5)
        for i in range(10):
            outbox.put_frame(bytes([i]))
        outbox.put(Pong(1.0))
        await sent_by(outbox, socket)
        assert outbox.dropped == 9
        return socket.sent

    sent = asyncio.run(scenario())
    assert sent[1:] == [bytes([9])]
    assert isinstance(sent[0], str)
    assert "pong" in sent[0]


def test_only_the_newest_status_and_plan_wait() -> None:
    outbox, plan = Outbox(), Plan([], [], [], [], [], [])
    for _ in range(3 * MAX_WAITING):
        outbox.put(plan)
    outbox.put(Notice("info", "still there"))


def test_a_client_that_reads_nothing_is_given_up() -> None:
    outbox = Outbox()
    for i in range(MAX_WAITING):
        outbox.put(Pong(float(i)))
    with pytest.raises(SlowClientError):
        outbox.put(Pong(0.0))


def test_messages_keep_their_order() -> None:
    async def scenario() -> list[str | bytes]:
        outbox, socket = Outbox(), Socket(100)
        for i in range(5):
            outbox.put(Pong(float(i)))
        await sent_by(outbox, socket)
        return socket.sent

    assert [f'"t":{i}.0' in str(text) for i, text in enumerate(asyncio.run(scenario()))] == [True] * 5


def test_what_is_pushed_is_told_while_it_moves_and_is_back_after_a_reset(library: Library) -> None:
    walk = Walk(library.avatars.get("stock"), library.scenes["d"], WalkSettings())
    stage = Stage(walk, 0.0)
    assert stage.pushed() == []
    stage.push(Push(1, (-2.0, 1.75)))
    assert stage.restless is False
    told = [pushed for tick in range(1, 120) for pushed in (stage.advance(tick / 60), stage.pushed())[1]]
    assert {pushed.obstacle for pushed in told} == {1}
    assert told[-1].center[0] == pytest.approx(-2.0, abs=0.01)
    assert max(b.center[0] for b in told) <= -0.6
    assert all(a.time < b.time for a, b in pairwise(told))
    assert stage.status(2.0).clearance is not None
    for tick in range(120, 180):
        stage.advance(tick / 60)
        stage.pushed()
    assert stage.pushed() == []
    epoch = told[-1].epoch
    stage.reset()
    assert stage.pushed() == []
    assert walk.things == {}
    stage.push(Push(0, (3.0, 1.4)))
    stage.advance(3.1)
    assert [pushed.epoch for pushed in stage.pushed()] == [epoch + 1]
    with pytest.raises(InputError, match="by this number"):
        stage.push(Push(77, (0.0, 0.0)))
