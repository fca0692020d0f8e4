"""Whatever a program hands over: a controller takes it, or says in one sentence what is wrong with it, and goes on."""

import math
from typing import Any

import numpy as np
import pytest

import elbowroom as er

AVATAR = er.Humanoid.default()
SCENE = er.Scene.load("empty")
ODD: tuple[Any, ...] = (math.nan, math.inf, "1", None, [1.0], 10**400, 1j)
AHEAD = er.Command(forward=1.0)


@pytest.fixture(scope="module")
def controller() -> er.Controller:
    return er.Controller(AVATAR, SCENE, assist=False)


def refused(call: Any, begins: str) -> None:
    with pytest.raises(er.InputError) as caught:
        call()
    assert str(caught.value).startswith(begins)
    assert len(str(caught.value)) < 1000
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("odd", ODD, ids=lambda odd: str(odd)[:8])
@pytest.mark.parametrize("name", ["forward", "strafe", "turn", "direction"])
def test_a_command_holds_numbers(controller: er.Controller, name: str, odd: Any) -> None:
    if name == "direction" and odd is None:
        return
    command = er.Command(**{name: odd})
    refused(lambda: controller.step(command, 1 / 60), "command: ")
    refused(lambda: controller.goto((1.0, 1.0), command), "command: ")
    assert np.isfinite(controller.step(AHEAD, 1 / 60).q).all()


@pytest.mark.parametrize("way", [3, None, "ab", (math.nan, 1.0), ((1.0,),), ((1.0, "x"),)])
def test_a_way_is_of_corners(controller: er.Controller, way: Any) -> None:
    refused(lambda: controller.step(er.Command(forward=1.0, way=way), 1 / 60), "command: ")


def test_a_step_takes_a_command_and_seconds(controller: er.Controller) -> None:
    no_commands: tuple[Any, ...] = (None, 3, "forward", (1.0, 0.0, 0.0))
    for odd in no_commands:
        refused(lambda odd=odd: controller.step(odd, 1 / 60), "command: ")
        refused(lambda odd=odd: controller.goto((1.0, 1.0), odd), "command: ")
    for odd in ODD:
        refused(lambda odd=odd: controller.step(AHEAD, odd), "dt: ")


@pytest.mark.parametrize(
    "place", [None, 3, (), (1.0,), (1.0, 2.0, 3.0, 4.0), ("a", "b"), (1e300, 1.0), np.ones((2, 2))]
)
def test_a_place_has_two_or_three_numbers(controller: er.Controller, place: Any) -> None:
    refused(lambda: controller.goto(place), "goto: ")


@pytest.mark.parametrize("odd", ODD, ids=lambda odd: str(odd)[:8])
def test_a_start_is_of_numbers(odd: Any) -> None:
    controller = er.Controller(AVATAR, SCENE, assist=False)
    before = controller.root
    for name in er.RootState._fields:
        start = er.RootState(**{name: odd})
        refused(lambda start=start: er.Controller(AVATAR, SCENE, start=start), "start: ")
        refused(lambda start=start: controller.reset(start), "start: ")
    for other in (3, (1.0, 2.0), er.RootState):
        refused(lambda other=other: controller.reset(other), "start: ")
    assert controller.root == before


@pytest.mark.parametrize(
    ("options", "begins"),
    [
        ({"humanoid": None}, "humanoid: None is no Humanoid: Humanoid.load makes one"),
        ({"scene": "d"}, "scene: d is no Scene: Scene.load makes one"),
        ({"humanoid": SCENE, "scene": AVATAR}, "humanoid: "),
        ({"motions": "walk.bvh"}, "motions: walk.bvh is no MotionSet: motions_of makes one"),
        ({"planner": None}, "planner"),
        ({"seed": 1.5}, "seed: 1.5"),
        ({"seed": None}, "seed: None"),
        ({"ahead": er.Lookahead(interval="x")}, "interval: x"),  # type: ignore[arg-type]
    ],
)
def test_a_controller_is_made_of_what_it_says(options: dict[str, Any], begins: str) -> None:
    given: dict[str, Any] = {"humanoid": AVATAR, "scene": SCENE} | options
    refused(lambda: er.Controller(**given), begins)
