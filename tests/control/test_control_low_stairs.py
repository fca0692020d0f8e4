"""A stair that leads under the edge of a floor: up with the head bowed, down backwards, judged by coal."""

import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.journey import JourneyState
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.planning.command import Command
from elbowroom.planning.navigation.backwards import stretch_from
from elbowroom.planning.navigation.girth import girth_of
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.world.scene import Scene

AVATAR = Humanoid.default()
GIRTH = girth_of(AVATAR)
BEGIN, STEPS, UNDER = 2.0, 7, 3  # metres; treads; the one whose far edge lies under the edge of the floor above
EVEN, STEEP = (0.17, 0.28), (0.2, 0.22)  # rise and depth of a tread, metres
LONGEST = 30.0  # seconds


def box(begin: float, end: float, low: float, high: float) -> dict[str, Any]:
    return {
        "type": "box",
        "center": [0.0, 0.5 * (low + high), 0.5 * (begin + end)],
        "size": [1.8, high - low, end - begin],
    }


def places_of(tread: tuple[float, float]) -> tuple[tuple[float, float, float], tuple[float, float, float]]:
    """Where one stands below the stair and above it."""
    return (0.0, 0.0, 0.4), (0.0, tread[0] * STEPS, BEGIN + tread[1] * STEPS + 1.2)


def stair_under(less: float, tread: tuple[float, float], *, up: bool = True) -> Scene:
    """A stair between walls, with `less` headroom than the avatar is tall over one of its treads."""
    rise, deep = tread
    treads = [box(BEGIN + deep * i, BEGIN + deep * (i + 1), 0.0, rise * (i + 1)) for i in range(STEPS)]
    floor = box(BEGIN + deep * STEPS, BEGIN + deep * STEPS + 3.0, 0.0, rise * STEPS)
    ceiling = rise * UNDER + GIRTH.tall - less
    above = {**box(0.6, BEGIN + deep * UNDER, ceiling, ceiling + 0.3), "name": "floor above"}
    walls = [{"type": "box", "center": [x, 2.0, 3.5], "size": [0.2, 4.0, 12.0]} for x in (-1.0, 1.0)]
    scene = Scene.of("low stair", [*walls, *treads, floor, above], start=(0.0, 0.4), finish=(0.0, 5.0))
    x, height, z = places_of(tread)[0 if up else 1]
    return replace(scene, start=RootState(x=x, z=z, height=height, heading=0.0 if up else math.pi))


@cache
def walked(less: float, tread: tuple[float, float], up: bool) -> tuple[JourneyState, list[Frame]]:
    controller, frames = Controller(AVATAR, stair_under(less, tread, up=up)), list[Frame]()
    journey = controller.goto(places_of(tread)[1 if up else 0])
    while journey.walking and len(frames) < 60 * LONGEST:
        frames.append(controller.step(Command(), 1 / 60))
    return journey.state, frames


@pytest.mark.long
@pytest.mark.parametrize("up", [True, False], ids=["up", "down"])
@pytest.mark.parametrize("tread", [EVEN, STEEP], ids=["even", "steep"])
@pytest.mark.parametrize("less", [0.03, 0.1, 0.2, 0.3])
def test_one_goes_under_what_hangs_low_over_a_stair(less: float, tread: tuple[float, float], up: bool) -> None:
    state, frames = walked(less, tread, up)
    assert state is JourneyState.ARRIVED
    assert not any(frame.stuck or frame.touching for frame in frames)
    motion = ShownMotion.at_rate(np.stack([frame.q for frame in frames]), np.stack([frame.root for frame in frames]))
    verdict = judge(motion, AVATAR, stair_under(less, tread, up=up), JudgeSettings(mesh=False))
    assert verdict.clean, verdict.capsules.contacts[:3]


@pytest.mark.parametrize("tread", [EVEN, STEEP], ids=["even", "steep"])
def test_a_stair_is_gone_down_backwards_where_it_leads_under_something_low(tread: tuple[float, float]) -> None:
    below, above = places_of(tread)
    for less, low in ((-0.3, False), (0.1, True), (0.3, True)):
        navigator = Navigator(AVATAR, stair_under(less, tread))
        assert not stretch_from(navigator.find(below, above), below, backwards=False).backwards
        down = navigator.find(above, below)
        first = stretch_from(down, above, backwards=False)
        assert not first.backwards
        assert (first.way.goal[2] > BEGIN + tread[1] * STEPS) is low, "one turns before the stair, or nowhere"
        if low:
            turned = stretch_from(down, first.way.goal, backwards=False)
            assert turned.backwards
            assert turned.way.goal[1] == pytest.approx(0.0), "one turns again on the floor"
            middle = (0.0, tread[0] * (UNDER - 1), BEGIN + tread[1] * (UNDER - 1.5))
            assert stretch_from(down, middle, backwards=True).backwards, "nobody turns on the treads"


def test_a_way_down_that_is_low_is_walked_with_the_back_ahead() -> None:
    """The body turns on the floor, and not on the treads."""
    controller = Controller(AVATAR, stair_under(0.2, EVEN, up=False))
    controller.goto(places_of(EVEN)[0])
    begin = BEGIN + EVEN[1] * STEPS
    while controller.root.z > begin - 0.3:
        controller.step(Command(), 1 / 60)
        if controller.root.z < begin:
            assert abs(math.remainder(controller.root.heading, math.tau)) < 0.35
            assert controller.root.forward <= 0.0
