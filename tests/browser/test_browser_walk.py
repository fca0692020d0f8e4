"""Walking: keys, camera, assist, gamepad, touch."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from live_page import LivePage
from live_server import LiveServer

Open = Callable[..., LivePage]

GAMEPAD = """
window.stick = [0, 0];
navigator.getGamepads = () => [{
  connected: true, mapping: "standard", id: "stub", index: 0, timestamp: 0,
  axes: [window.stick[0], window.stick[1], 0, 0],
  buttons: Array.from({ length: 17 }, () => ({ pressed: false, touched: false, value: 0 })),
}];
"""


def distance_to_boxes(boxes: list[dict[str, Any]], point: list[float]) -> float:
    """Distance from a point to the nearest box, the slow plain way; 0 inside."""
    distances = [np.inf]
    for box in boxes:
        x, y, z, w = box["rotation"]
        to_world = np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
            ]
        )
        inside = np.abs(to_world.T @ (np.array(point) - box["center"])) - np.array(box["form"]["size"]) / 2
        distances.append(float(np.linalg.norm(np.maximum(inside, 0.0))))
    return min(distances)


@pytest.mark.long
def test_held_keys_walk_through_scene_a(open_page: Open, live_server: LiveServer) -> None:
    boxes: Any = live_server.get_json("/api/scenes/a")["obstacles"]
    live = open_page("scene=a&speed=1.6", sparing=False)
    live.wait("s.scene === 'a'")
    start = live.state()["root"]
    keyboard = live.page.keyboard
    nearest = np.inf
    for _ in range(6):
        keyboard.down("w")
        for _ in range(400):
            state = live.wait("true")
            assert not state["touching"]
            nearest = min(nearest, distance_to_boxes(boxes, state["camera"]))
            if state["crossed"] or state["stuckNow"] or state["simTime"] > 90:
                break
            live.page.wait_for_timeout(50)
        keyboard.up("w")
        if state["crossed"]:
            break
        keyboard.down("s")
        live.page.wait_for_timeout(1200)
        keyboard.up("s")
    assert state["crossed"] == 1, state
    assert nearest > 0.05, "the camera went into a wall"
    live.page.wait_for_selector("#status:has-text('Through in')")
    assert "Least clearance" in live.page.inner_text("#finish")
    live.page.click("#finish-again")
    live.page.wait_for_selector("#finish", state="hidden")
    live.wait(f"Math.hypot(s.root.x - {start['x']}, s.root.z - {start['z']}) < 0.1")
    live.page.select_option("#course-level", "1")
    live.page.fill("#course-seed", "7")
    live.page.keyboard.press("Enter")
    live.wait("s.scene === 'gauntlet:1:7' && s.crossed === 0")
    assert live.page.input_value("#scene") == "gauntlet:1:7"
    live.page.fill("#course-seed", "8")
    live.page.click("#course-new")
    live.wait("s.scene === 'gauntlet:1:8'")
    live.page.keyboard.down("w")
    live.wait("s.heldKeys === 1")
    live.page.keyboard.up("w")
    live.page.click("#course-new")
    live.wait("s.scene.startsWith('gauntlet:1:') && s.scene !== 'gauntlet:1:8'")


def test_keys_are_released_on_blur(open_page: Open) -> None:
    live = open_page("scene=empty")
    live.wait("s.scene === 'empty'")
    live.page.keyboard.down("w")
    live.wait("s.heldKeys === 1 && s.root.z > 0.3")
    live.page.evaluate("window.dispatchEvent(new Event('blur'))")
    sent = live.wait("s.heldKeys === 0")["sent"]
    live.wait(f"s.acknowledged >= {sent}")
    live.settle()
    z = live.state()["root"]["z"]
    assert abs(live.wait_for_pictures(3)["root"]["z"] - z) < 0.02


def test_steering_keys_steer_past_lists(open_page: Open) -> None:
    live = open_page("scene=empty")
    live.page.focus("#scene")
    for key in ("w", "d", "t"):
        live.page.keyboard.down(key)
        assert live.state()["heldKeys"] == (key != "t")
        live.page.keyboard.up(key)
    live.wait("s.settings.assist === false")
    assert live.page.input_value("#scene") == "empty"
    assert live.state()["settings"]["scene"] == "empty"


@pytest.mark.long
def test_arrow_keys_belong_to_a_list_reached_by_key_until_escape(open_page: Open) -> None:
    live = open_page("scene=a")
    live.wait("s.scene === 'a'")
    live.page.focus("#scene")
    live.page.keyboard.press("ArrowDown")
    live.wait("s.scene === 'b'")
    assert live.state()["heldKeys"] == 0
    live.page.keyboard.press("Escape")
    live.page.keyboard.down("ArrowUp")
    live.wait("s.heldKeys === 1")
    live.page.keyboard.up("ArrowUp")


def test_after_a_click_on_a_control_all_keys_steer(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(1200, 800))
    live.page.click("#speed", position={"x": 40, "y": 8})
    chosen = live.page.input_value("#speed")
    live.page.keyboard.down("ArrowLeft")
    assert live.state()["heldKeys"] == 1
    live.page.keyboard.up("ArrowLeft")
    assert live.page.input_value("#speed") == chosen
    live.page.click("#scene")  # opens the list; a second click closes it without a choice
    live.page.keyboard.press("Escape")
    live.page.mouse.click(3, 400)
    live.page.click("#slow")
    live.page.click("label:has(#overlay-path)")
    live.wait("s.settings.speed < 1 && s.overlays.length === 1")
    live.page.keyboard.press("Space")
    state = live.wait("s.settings.paused")
    assert state["settings"]["speed"] < 1, "the space bar pressed the button again"
    assert state["overlays"] == ["path"]


def test_arrow_keys_turn_towards_the_side_of_the_picture(open_page: Open) -> None:
    live = open_page("scene=empty")
    live.wait("s.scene === 'empty'")
    live.page.keyboard.down("ArrowLeft")
    live.wait("s.root.heading > 0.6 && s.root.x > 0.1")
    live.page.keyboard.up("ArrowLeft")


@pytest.mark.long
def test_assist_off_goes_through_things(open_page: Open) -> None:
    live = open_page("scene=d&speed=0.4")  # slowly: it is within each thing for a while
    live.page.click("#assist")
    live.wait("s.settings.assist === false")
    live.page.keyboard.press("Escape")
    live.page.keyboard.down("w")
    state = live.wait("s.touching && s.touchingParts.length > 0")
    live.page.keyboard.up("w")
    assert set(state["touchingParts"]) <= set(live.page.evaluate("window.__app.bodyParts"))
    live.page.keyboard.press("t")
    live.wait("s.settings.assist === true")


def test_gamepad_walks(open_page: Open) -> None:
    live = open_page("scene=empty", script=GAMEPAD)
    live.wait("s.scene === 'empty'")
    live.page.evaluate("window.stick = [0.05, -0.1]")
    assert live.wait_for_pictures(3)["sent"] == 0, "inside the dead zone"
    live.page.evaluate("window.stick = [0, -1]")
    live.wait("s.root.z > 0.5")
    live.page.evaluate("window.stick = [0, 0]")


def test_touch_stick_walks_and_the_other_half_looks(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(390, 844), has_touch=True, is_mobile=True)
    live.wait("s.scene === 'empty'")
    touch = live.page.context.new_cdp_session(live.page)

    def send(kind: str, *points: tuple[int, int]) -> None:
        touches = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": touches})

    send("touchStart", (90, 640))
    send("touchMove", (90, 590))
    live.wait("s.root.z > 0.4")
    before = live.state()["cameraHeading"]
    send("touchStart", (90, 590), (300, 500))
    send("touchMove", (90, 590), (340, 500))
    live.wait(f"Math.abs(s.cameraHeading - {before}) > 0.1")
    send("touchEnd")
    sent = live.state()["sent"]
    live.wait(f"s.acknowledged >= {sent}")
    overflow = live.page.evaluate("document.documentElement.scrollWidth - innerWidth")
    assert overflow <= 0
