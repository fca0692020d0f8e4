"""Plans that take their time: playback goes on, touches nothing, slows down where no plan comes, and walks on."""

from functools import partial

import numpy as np
import pytest

from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.plans.desk import Job
from elbowroom.control.plans.foresight import Foresight, Haste
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.planning.command import Command, changed
from elbowroom.world.scene import Scene
from late_desk import LateDesk
from sampled import sampled

HUMANOID = proportional_humanoid(1.72)
DT = 1 / 60
SECOND = 60  # turns
WALK = Command(forward=1.0)
ROOT_ACCELERATION = 8.0  # m/s^2: braking from a walk within half of the time that slowing down takes


def late_walk(
    scene: str, turns: int, commands: list[Command], planner: str = "exact"
) -> tuple[Controller, list[Frame]]:
    desk = LateDesk(turns)
    controller = Controller(HUMANOID, Scene.load(scene), planner=planner, ahead=Lookahead(desk=desk))
    frames = []
    for command in commands:
        desk.next_turn()
        frames.append(controller.step(command, DT))
    return controller, frames


def root_accelerations(frames: list[Frame]) -> np.ndarray:
    places = np.array([frame.root[:2] for frame in frames])
    lengths: np.ndarray = np.linalg.norm(np.diff(places, 2, axis=0), axis=1)
    return lengths / DT**2


def restless(seed: int, turns: int) -> list[Command]:
    rng = np.random.default_rng(seed)
    commands: list[Command] = []
    while len(commands) < turns:
        forward, strafe = rng.choice([1.0, 1.0, 0.5, 0.0, -1.0]), rng.choice([0.0, 0.0, 1.0, -1.0])
        turn = rng.uniform(-1, 1) if rng.random() < 0.3 else 0.0
        commands += [Command(float(forward), float(strafe), float(turn))] * int(rng.integers(5, 90))
    return commands[:turns]


@pytest.mark.parametrize("turns", [1, SECOND])
def test_scene_d_is_crossed_without_a_halt_however_long_plans_take(turns: int) -> None:
    controller, frames = late_walk("d", turns, [WALK] * (6 * SECOND))
    assert controller.scene.finished(controller.root)
    assert min(frame.clearance for frame in frames) >= 0.0
    assert not any(frame.stuck for frame in frames)
    assert controller.late_plans == 0
    started = next(i for i, frame in enumerate(frames) if frame.root[3] > 0.3)
    assert started < turns + 30
    assert min(frame.root[3] for frame in frames[started:]) > 0.2
    assert root_accelerations(frames).max() < ROOT_ACCELERATION


@pytest.mark.parametrize("planner", ["exact", "figure6"])
@pytest.mark.parametrize("seed", sampled([0, 1]))
def test_a_planner_that_takes_a_second_never_makes_the_avatar_touch(planner: str, seed: int) -> None:
    commands = [WALK] * (2 * SECOND) + restless(seed, 6 * SECOND) + [Command()] * (3 * SECOND) + [WALK] * (3 * SECOND)
    _, frames = late_walk("acdb"[seed], SECOND, commands, planner)
    assert min(frame.clearance for frame in frames) >= 0.0
    times = np.array([frame.time for frame in frames])
    np.testing.assert_allclose(np.diff(times), DT)
    quiet = frames[11 * SECOND - 1]
    assert not quiet.root[3:6].any()
    before, after = quiet.root[:2], frames[-1].root[:2]
    assert np.hypot(*(after - before)) > 0.05 or frames[-1].stuck


def test_a_queue_that_runs_out_is_played_slower_and_stands_before_its_end() -> None:
    _, frames = late_walk("empty", 2 * SECOND, [WALK] * (5 * SECOND), "figure6")
    speeds = np.array([frame.root[3] for frame in frames])
    moving = np.flatnonzero(speeds > 0.1)
    stops = np.flatnonzero(speeds[moving[0] :] == 0.0)
    assert len(stops)
    assert speeds[-SECOND:].max() > 0.3
    assert root_accelerations(frames).max() < ROOT_ACCELERATION


@pytest.mark.parametrize("command", [Command(), Command(forward=-1.0), Command(forward=1.0, direction=1.2)])
def test_a_changed_command_shows_within_a_tenth_of_a_second(command: Command) -> None:
    walked = [WALK] * (2 * SECOND)
    _, frames = late_walk("empty", 1, [*walked, *[command] * 12])
    _, held_on = late_walk("empty", 1, [*walked, *[WALK] * 12])
    differs = [a.q.tobytes() != b.q.tobytes() for a, b in zip(frames, held_on, strict=True)]
    first = differs.index(True) - len(walked)
    assert 0 <= first < 0.1 / DT
    assert np.abs(frames[-1].root[3] - held_on[-1].root[3]) > 0.1 or command.direction is not None
    assert root_accelerations(frames).max() < ROOT_ACCELERATION


def test_the_same_late_turns_give_the_same_frames() -> None:
    commands = restless(3, 4 * SECOND)
    (_, first), (_, second) = (late_walk("b", 7, commands) for _ in range(2))
    for one, other in zip(first, second, strict=True):
        assert one.q.tobytes() == other.q.tobytes()
        assert one.root.tobytes() == other.root.tobytes()


def test_a_reset_forgets_the_plan_in_the_making() -> None:
    desk = LateDesk(10)
    controller = Controller(HUMANOID, Scene.load("empty"), ahead=Lookahead(desk=desk))
    start = controller.step(Command(), 0.0).q
    for _ in range(30):
        desk.next_turn()
        controller.step(WALK, DT)
    while not desk.busy:
        desk.next_turn()
        controller.step(WALK, DT)
    controller.reset()
    frames = []
    for _ in range(20):
        desk.next_turn()
        frames.append(controller.step(Command(), DT))
    np.testing.assert_allclose([frame.q for frame in frames], [start] * len(frames), atol=1e-6)


def test_playback_never_plays_more_than_is_left() -> None:
    rng = np.random.default_rng(0)
    for _ in range(200):
        foresight, left, rates = Foresight(immediate=False), float(rng.uniform(0.0, 1.0)), [1.0]
        for _ in range(300):
            dt = float(rng.uniform(0.002, 0.025))
            rates.append(foresight.next_rate(left, dt, halting=False))
            left -= rates[-1] * dt
            assert left > -1e-12
        assert left < 1e-6
        assert rates[-1] < 1e-3


def test_a_plan_in_a_hurry_is_given_the_time_that_most_take_and_once_more_what_the_longest_took() -> None:
    foresight = Foresight(immediate=False)
    usual = foresight.lead(Haste.HURRY)
    foresight.waited(0.3, Haste.HURRY)
    assert foresight.lead(Haste.AGAIN) >= foresight.lead(Haste.HURRY) > 0.3  # all that is known
    for _ in range(5):
        foresight.waited(0.04, Haste.HURRY)
    assert foresight.lead(Haste.AGAIN) > 0.3
    assert usual < foresight.lead(Haste.HURRY) < 0.1  # one that took long makes nobody wait
    for _ in range(5):
        foresight.waited(0.12, Haste.AGAIN)
    assert foresight.lead(Haste.HURRY) > 0.12  # but those that do so often
    for _ in range(20):
        foresight.waited(0.01, Haste.HURRY)
    assert foresight.lead(Haste.AGAIN) < 0.1  # and what is long past is forgotten
    assert Foresight(immediate=True).lead(Haste.HURRY) == 0.0


class HiccupDesk(LateDesk):
    """A desk that takes longer over one plan in a hurry."""

    def __init__(self, long: int) -> None:
        super().__init__(1)
        self.long = long

    def submit(self, job: Job) -> None:
        super().submit(job)
        if self._answer is not None and changed(WALK, self._answer_to(job)):
            self._due, self.long = self._due + self.long, 0

    def _answer_to(self, job: Job) -> Command:
        assert isinstance(job, partial)
        command: Command = job.args[0].query.command
        return command


def test_a_plan_in_a_hurry_that_comes_too_late_is_soon_made_up_for() -> None:
    desk = HiccupDesk(5)
    controller = Controller(HUMANOID, Scene.load("empty"), ahead=Lookahead(desk=desk))
    turned, answered = Command(forward=1.0, strafe=1.0), 0
    for turn in range(3 * SECOND):
        desk.next_turn()
        frame = controller.step(turned if turn >= 2 * SECOND else WALK, DT)
        assert frame.clearance > 0.0
        if not answered and frame.plan is not None and frame.plan.command == turned:
            answered = turn
    assert controller.late_plans == 1
    assert 6 < answered - 2 * SECOND < 10


def test_what_is_planned_after_a_reset_is_what_was_planned_at_first() -> None:
    """Whether or not a plan was in the making; the planners, which take long to make, stay the same."""

    def crossing(controller: Controller, desk: LateDesk, turns: int) -> list[bytes]:
        shown = []
        for _ in range(turns):
            desk.next_turn()
            shown.append(controller.step(WALK, DT).q.tobytes())
        return shown

    desk = LateDesk(3)
    controller = Controller(HUMANOID, Scene.load("d"), ahead=Lookahead(desk=desk))
    controller.prepare()
    first = crossing(controller, desk, 4 * SECOND)
    for asks in (True, False):
        while desk.busy is not asks:
            crossing(controller, desk, 1)
        controller.reset()
        assert not desk.busy
        assert crossing(controller, desk, 4 * SECOND) == first
