"""When a command differs so much from the planned one that playback cannot wait for the next key frame."""

import math

import pytest

from elbowroom.control.steering import checked, overturned, steady
from elbowroom.errors import InputError
from elbowroom.planning.command import Command, changed

WALK = Command(forward=1.0)
IDLE = Command()


def towards(degrees: float) -> Command:
    return Command(forward=1.0, direction=math.radians(degrees))


@pytest.mark.parametrize(
    ("planned", "command"),
    [
        (WALK, IDLE),
        (IDLE, WALK),
        (WALK, Command(forward=-1.0)),
        (WALK, Command(forward=1.0, run=True)),
        (WALK, Command(forward=0.5)),
        (WALK, Command(forward=1.0, strafe=1.0)),
        (WALK, Command(forward=1.0, turn=0.5)),
        (WALK, towards(0)),
        (towards(0), towards(25)),
        (towards(170), towards(-165)),
    ],
)
def test_other_wishes_are_changes(planned: Command, command: Command) -> None:
    assert changed(planned, command)


@pytest.mark.parametrize(
    ("planned", "command"),
    [
        (WALK, WALK),
        (IDLE, IDLE),
        (WALK, Command(forward=0.9, strafe=0.1, turn=0.1)),
        (towards(0), towards(10)),
        (towards(175), towards(-175)),
        (towards(0), towards(360)),
    ],
)
def test_small_corrections_wait_for_the_next_key_frame(planned: Command, command: Command) -> None:
    assert not changed(planned, command)
    assert not overturned(planned, command)


def test_letting_go_and_turning_back_overturn_the_plan() -> None:
    assert overturned(WALK, IDLE)
    assert overturned(WALK, Command(forward=-0.5))
    assert overturned(towards(0), towards(120))
    assert not overturned(IDLE, WALK)
    assert not overturned(IDLE, IDLE)
    assert not overturned(WALK, Command(strafe=0.5, forward=0.5))


def test_shares_are_clipped() -> None:
    assert checked(Command(forward=3.0, strafe=-2.0, turn=0.5)) == Command(1.0, -1.0, 0.5)


@pytest.mark.parametrize(
    "command",
    [
        Command(forward=math.nan),
        Command(turn=math.inf),
        Command(direction=-math.inf),
        Command(way=((0.0, 1.0), (2.0, math.nan))),
    ],
)
def test_what_is_no_number_is_refused(command: Command) -> None:
    with pytest.raises(InputError, match="finite"):
        checked(command)


def test_a_trembling_stick_asks_for_the_same() -> None:
    held = Command(forward=0.97, direction=3.14)
    assert steady(held, Command(forward=0.98, direction=3.145)) is held
    assert steady(held, Command(forward=0.98, direction=-3.14)) is held  # across the back
    turned, slower = Command(forward=0.97, direction=3.16), Command(forward=0.94, direction=3.14)
    assert steady(held, turned) is turned
    assert steady(held, slower) is slower
    strafing, running = Command(forward=1.0, strafe=0.03), Command(forward=1.0, run=True)
    assert steady(WALK, strafing) is strafing
    assert steady(WALK, running) is running


def test_letting_go_of_a_stick_and_barely_moving_it_are_heard() -> None:
    barely = Command(forward=0.01)
    assert steady(IDLE, barely) is barely
    assert steady(barely, IDLE) is IDLE


@pytest.mark.parametrize("noise", [0.0, 1e-9, -1e-9, 5e-324])
def test_what_no_hand_can_ask_for_is_not_asked_for(noise: float) -> None:
    assert Command(forward=1.0, strafe=noise, turn=noise).straight
    assert not Command(forward=1.0, strafe=noise, turn=noise).turns
    assert not Command(forward=noise).straight
    assert Command(forward=noise, turn=-0.5).turns
    assert not Command(forward=1.0, strafe=0.5).straight
