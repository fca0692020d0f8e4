"""Going somewhere: a click or a tap on the floor, a drag that is none, a key that takes over."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from live_page import LivePage

Open = Callable[..., LivePage]


def beside_the_feet(state: dict[str, Any], right: float, up: float) -> tuple[float, float]:
    """A spot in the view so many pixels from the avatar's feet."""
    return state["feet"][0] + right, state["feet"][1] - up


def test_a_click_on_the_floor_is_gone_to_and_a_key_takes_over(open_page: Open) -> None:
    live = open_page("scene=empty")
    live.settle()
    live.page.mouse.click(*beside_the_feet(live.state(), 140, 40))
    place = live.wait("s.going && s.going.state === 'walking'")["going"]["place"]
    assert math.hypot(*place) > 0.5, "that was at the avatar's feet"
    live.wait("s.going.state === 'arrived'")
    live.settle()
    root = live.state()["root"]
    assert math.hypot(root["x"] - place[0], root["z"] - place[2]) < 0.4
    live.page.mouse.click(*beside_the_feet(live.state(), -140, 60))
    live.wait("s.going.state === 'walking'")
    live.page.keyboard.down("s")
    live.wait("s.going.state === 'taken over'")
    live.page.keyboard.up("s")


@pytest.mark.long
def test_a_drag_looks_around_and_goes_nowhere(open_page: Open) -> None:
    live = open_page("scene=empty")
    live.settle()
    heading = live.state()["cameraHeading"]
    x, y = beside_the_feet(live.state(), 140, 40)
    live.page.mouse.move(x, y)
    live.page.mouse.down()
    live.page.mouse.move(x + 120, y, steps=6)
    live.page.mouse.up()
    live.wait(f"Math.abs(s.cameraHeading - {heading}) > 0.2")
    assert live.state()["going"] is None


@pytest.mark.long
def test_a_tap_goes_there_on_either_half_of_a_touch_screen(open_page: Open) -> None:
    live = open_page("scene=empty", has_touch=True, viewport=(800, 600))
    live.settle()
    for right in (110, -110):
        live.page.touchscreen.tap(*beside_the_feet(live.state(), right, 40))
        live.wait("s.going && s.going.state === 'walking'")
        live.wait("s.going.state === 'arrived'")
        live.settle()


def test_a_wall_is_no_floor(open_page: Open) -> None:
    live = open_page("scene=a")
    live.settle()
    live.page.mouse.click(500, 20)  # the sky, or the top of something
    live.page.mouse.click(*beside_the_feet(live.state(), 140, 20))
    live.wait("s.going")
    assert math.hypot(*live.state()["going"]["place"]) < 3.0
