"""Things pushed over the floor while the avatar walks: by mouse, by finger, by keys."""

from collections.abc import Callable
from typing import Any

import pytest

from live_page import LivePage

Open = Callable[..., LivePage]

SIDEBOARD = 3  # of scene D, to the left of the way
STARTS_AT = 0.6  # metres to the left


def grasp(live: LivePage, number: int) -> tuple[float, float]:
    """Press the mouse on an obstacle's middle; where that is in the view."""
    live.settle()
    x, y = live.state()["obstaclesOnScreen"][number]
    live.page.mouse.move(x, y)
    live.page.mouse.down()
    live.wait(f"s.held === {number}")
    return x, y


def pushed(live: LivePage, number: int, condition: str) -> dict[str, Any]:
    """Wait until a condition on the place `c` of a thing that was pushed holds."""
    return live.wait(f"s.pushed.some(({{ number, center: c }}) => number === {number} && ({condition}))")


def test_a_thing_is_pushed_into_the_way_with_the_mouse_and_the_avatar_evades_it(open_page: Open) -> None:
    live = open_page("scene=d", viewport=(1280, 800))
    live.wait("s.scene === 'd'")
    view = live.state()["cameraHeading"]
    x, y = grasp(live, SIDEBOARD)
    live.page.keyboard.down("w")
    live.wait("s.root.z > 0.3")
    live.page.mouse.move(x + 120, y, steps=12)
    pushed(live, SIDEBOARD, f"c[0] < {STARTS_AT - 0.25}")
    for _ in range(8):
        state = live.wait_for_pictures(1)
        assert not state["touching"]
        assert state["clearance"] > 0.0
    live.page.mouse.up()
    live.page.keyboard.up("w")
    state = live.wait("s.held === null")
    assert state["cameraHeading"] == view
    live.page.keyboard.press("k")
    live.wait("s.replay && s.replay.time > 0 || s.replay")
    live.page.keyboard.press("Escape")
    live.page.keyboard.press("r")
    live.wait("s.pushed.length === 0")


@pytest.mark.long
def test_a_finger_pushes_on_the_right_half(open_page: Open) -> None:
    live = open_page("scene=d", viewport=(800, 600), has_touch=True)
    live.wait("s.scene === 'd'")
    live.settle()
    number = 1  # the sideboard to the right of the way
    x, y = live.state()["obstaclesOnScreen"][number]
    assert 400 < x < 720
    touch = live.page.context.new_cdp_session(live.page)
    point = {"x": x, "y": y}
    touch.send("Input.dispatchTouchEvent", {"type": "touchStart", "touchPoints": [point]})
    live.wait(f"s.held === {number}")
    touch.send("Input.dispatchTouchEvent", {"type": "touchMove", "touchPoints": [{"x": x + 80, "y": y}]})
    live.wait(f"s.pushed.some(({{ number }}) => number === {number})")
    touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    live.wait("s.held === null")


def test_keys_take_one_thing_after_the_other_in_hand_and_arrows_push_it(open_page: Open) -> None:
    live = open_page("scene=d")
    live.wait("s.scene === 'd'")
    live.page.keyboard.press("g")
    first = live.wait("s.held !== null")["held"]
    live.page.keyboard.press("g")
    second = live.wait(f"s.held !== null && s.held !== {first}")["held"]
    live.page.keyboard.down("ArrowUp")
    live.wait(f"s.pushed.some(({{ number }}) => number === {second})")
    live.page.keyboard.up("ArrowUp")
    assert live.state()["root"]["z"] < 0.1
    live.page.keyboard.press("Escape")
    live.wait("s.held === null")
