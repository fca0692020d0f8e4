"""How long commands wait: until a motion is shown that was planned for them, or for what was asked for later."""

from typing import NamedTuple

import pytest

from elbowroom.planning.command import Command, changed
from elbowroom.server.sessions.heeded import Heeded
from elbowroom.server.sessions.meter import Meter
from elbowroom.server.sessions.punctuality import Punctuality

AHEAD, ASIDE, BACK = Command(forward=1.0), Command(strafe=1.0), Command(forward=-1.0)


class _Path(NamedTuple):
    start_time: float


class _Root(NamedTuple):
    path: _Path


class _Report(NamedTuple):
    number: int
    command: Command
    root: _Root


class _Frame(NamedTuple):
    time: float
    plan: _Report | None


def frame(time: float, number: int, command: Command, start: float) -> _Frame:
    return _Frame(time, _Report(number, command, _Root(_Path(start))))


def follow(*frames: _Frame) -> Command:
    heeded = Heeded()
    for one in frames:
        heeded.follow(one)  # type: ignore[arg-type]
    return heeded.command


def test_a_plan_is_shown_from_its_start_on() -> None:
    planned = frame(1.0, 1, AHEAD, 1.2)
    assert follow(_Frame(0.9, None)) == Command()
    assert follow(planned) == Command()
    assert follow(planned, frame(1.2, 1, AHEAD, 1.2)) == AHEAD


def test_until_the_next_plan_begins_the_one_before_is_shown() -> None:
    first, second = frame(1.0, 1, AHEAD, 1.2), frame(1.1, 2, ASIDE, 1.6)
    assert follow(first, second, frame(1.3, 2, ASIDE, 1.6)) == AHEAD
    assert follow(first, second, frame(1.7, 2, ASIDE, 1.6)) == ASIDE


def test_a_plan_in_whose_place_another_comes_is_never_shown() -> None:
    first, second = frame(1.0, 1, AHEAD, 1.5), frame(1.1, 2, BACK, 1.3)
    assert follow(first, second, frame(1.6, 2, BACK, 1.3)) == BACK


def heard_for(punctuality: Punctuality, now: float, planned: Command) -> None:
    punctuality.heard(now, lambda command: not changed(planned, command))


def test_what_is_shown_for_a_later_command_answers_the_earlier_ones_too() -> None:
    meter = Meter()
    punctuality = Punctuality(meter)
    punctuality.asked(1.0, AHEAD)
    punctuality.asked(1.2, ASIDE)
    punctuality.asked(1.3, BACK)
    heard_for(punctuality, 1.35, ASIDE)
    assert meter.answers.read()[0][-1] == 2
    heard_for(punctuality, 1.4, ASIDE)
    assert meter.answers.read()[0][-1] == 2
    heard_for(punctuality, 1.5, BACK)
    assert punctuality.answer_ms == pytest.approx((200.0, 347.0, 350.0), abs=1.0)


def test_a_hand_that_turns_on_is_one_command_until_it_wants_something_else() -> None:
    punctuality = Punctuality(meter := Meter())
    for n in range(30):
        punctuality.asked(0.01 * n, Command(forward=1.0, direction=0.01 * n))
    heard_for(punctuality, 0.3, Command(forward=1.0, direction=0.3))
    assert meter.answers.read()[0][-1] == 1


def test_nothing_waits_across_a_new_beginning() -> None:
    punctuality = Punctuality(meter := Meter())
    punctuality.asked(1.0, AHEAD)
    punctuality.begin()
    heard_for(punctuality, 9.0, AHEAD)
    assert meter.answers.read()[0][-1] == 0


def test_what_is_never_answered_is_bounded() -> None:
    punctuality = Punctuality(meter := Meter())
    for n in range(10_000):
        punctuality.asked(0.01 * n, (AHEAD, BACK)[n % 2])
    heard_for(punctuality, 100.0, BACK)
    assert meter.answers.read()[0][-1] < 100
