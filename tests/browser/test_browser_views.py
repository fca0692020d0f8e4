"""Cameras: by key and by button, steering by each, and the side view in the corner."""

import math
from collections.abc import Callable

import pytest

from live_page import LivePage

Open = Callable[..., LivePage]

VIEWS = ("behind", "side", "front", "above", "orbit", "shoulder")


def test_keys_and_buttons_choose_a_camera_and_w_walks_away_from_the_back(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(1100, 700))
    live.wait("s.scene === 'empty'")
    for number, view in enumerate(VIEWS, 1):
        live.page.keyboard.press(str(number))
        live.wait(f"s.view === '{view}'")
        assert live.page.get_attribute(f"[data-action='view:{view}']", "aria-pressed") == "true"
    live.page.click("[data-action='view:front']")
    live.wait("s.view === 'front' && Math.cos(s.cameraHeading) < -0.99")
    z = live.state()["root"]["z"]
    live.page.keyboard.down("w")
    state = live.wait(f"s.root.z > {z} + 0.6")
    live.page.keyboard.up("w")
    assert state["view"] == "front"
    assert math.cos(state["cameraHeading"] - state["root"]["heading"]) < -0.9
    live.page.click("#view-button")
    live.wait("s.view === 'above'")
    live.page.keyboard.press("i")
    live.page.wait_for_selector("#inset:not([hidden])")
    live.page.click("label:has(#inset-shown)")
    live.page.wait_for_selector("#inset", state="hidden")


@pytest.mark.long
def test_the_address_says_what_is_shown_and_the_back_button_goes_back(open_page: Open) -> None:
    live = open_page("scene=empty&camera=side&speed=0.8&overlays=path", viewport=(1100, 700))
    state = live.wait("s.settings.walkSpeed === 0.8 && location.search.includes('planner=exact')")
    assert (state["view"], state["overlays"]) == ("side", ["path"])
    live.page.keyboard.press("3")
    live.wait("location.search.includes('camera=front')")
    live.page.select_option("#scene", "a")
    live.wait("location.search.includes('scene=a&')")
    live.page.keyboard.press("4")
    live.page.go_back()
    live.wait("s.scene === 'empty' && s.view === 'front'")
    live.page.go_forward()
    state = live.wait("s.scene === 'a' && s.view === 'above' && location.search.includes('scene=a&')")
    assert state["settings"]["walkSpeed"] == 0.8
    live.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    live.page.click("#share")
    live.page.wait_for_selector(".notice.info")
    assert live.page.evaluate("navigator.clipboard.readText()") == live.page.evaluate("location.href")
