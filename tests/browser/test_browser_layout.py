"""Panels: none on another, none over the avatar, all within reach of a thumb, all of them gone on request."""

from collections.abc import Callable

import pytest

from elbowroom.world.scene import Scene
from live_page import LivePage
from sampled import sampled

Open = Callable[..., LivePage]

PANELS = ("#brand", "#bar", "#hud", "#status", "#menu", "#inset")
SIZES = [(1280, 720), (900, 600), (621, 700), (390, 844), (844, 390), (320, 568)]
PHONES = [pytest.param((390, 844), id="portrait"), pytest.param((844, 390), id="landscape")]
SMALLEST = """
() => [...document.querySelectorAll("button, select, input:not([hidden]), summary")]
  .map((control) => control.closest("label") ?? control)
  .map((control) => [control.id || control.className || control.textContent, control.getBoundingClientRect()])
  .filter(([, box]) => box.width > 0 && (box.width < 44 || box.height < 44))
  .map(([name, box]) => `${name}: ${box.width} x ${box.height}`)
"""

AT_THE_TOP = """
(titles) => titles.map((title) => {
  document.querySelector("#place").textContent = title;
  const boxes = ["#brand", "#brand h1", "#place", "#bar", "#hud"]
    .map((name) => [name, document.querySelector(name).getBoundingClientRect().toJSON()]);
  return Object.fromEntries(boxes);
})
"""


def boxes(live: LivePage) -> dict[str, dict[str, float]]:
    """The panels that can be seen, and where."""
    found = {name: live.page.locator(name) for name in PANELS}
    return {name: panel.bounding_box() for name, panel in found.items() if panel.is_visible()}


def overlap(a: dict[str, float], b: dict[str, float]) -> bool:
    across = a["x"] < b["x"] + b["width"] and b["x"] < a["x"] + a["width"]
    return across and a["y"] < b["y"] + b["height"] and b["y"] < a["y"] + a["height"]


def test_no_panel_lies_on_another(open_page: Open) -> None:
    live = open_page("scene=doorway", viewport=SIZES[0])  # a long title
    live.page.wait_for_selector("#status:not(:empty)")
    live.page.keyboard.press("i")
    for width, height in SIZES:
        live.page.set_viewport_size({"width": width, "height": height})
        live.settle_panels()
        found = boxes(live)
        assert {"#brand", "#bar", "#hud", "#status", "#inset"} <= set(found)
        for one, box in found.items():
            assert (box["x"] >= 0, box["x"] + box["width"] <= width) == (True, True), (one, width)
            assert box["y"] + box["height"] <= height
            assert [other for other in found if other != one and overlap(box, found[other])] == [], (one, width)


@pytest.mark.parametrize(
    ("lang", "touch"), sampled([("en", False), ("en", True), ("zh-Hant", False), ("zh-Hant", True)], 3)
)
def test_the_title_ends_before_the_bar_on_a_narrow_page(open_page: Open, lang: str, *, touch: bool) -> None:
    """At 640 px all of the bar is beside it, and nothing is left out yet; what is too long is cut, not laid over."""
    live = open_page(f"scene=empty&lang={lang}", viewport=(640, 480), has_touch=touch, is_mobile=touch)
    titles = [Scene.load(name).title for name in Scene.stock_names()] + ["A scene that somebody gave a long name"]
    for width in (640, 700) if touch else (640, 621, 700):
        live.page.set_viewport_size({"width": width, "height": 480})
        live.settle_panels()
        for found in live.page.evaluate(AT_THE_TOP, titles):
            brand, bar, hud = found["#brand"], found["#bar"], found["#hud"]
            assert brand["width"] > 0, width
            assert not overlap(brand, bar), (width, found)
            assert not overlap(brand, hud), (width, found)
            assert not overlap(bar, hud), (width, found)
            assert bar["x"] + bar["width"] <= width
            for part in ("#brand h1", "#place"):  # neither sticks out of its box
                assert found[part]["x"] + found[part]["width"] <= brand["x"] + brand["width"], (width, found)


@pytest.mark.long
def test_the_card_at_the_finish_lies_on_no_panel(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=SIZES[0])
    live.page.evaluate("document.querySelector('#finish').hidden = false")
    for width, height in (*SIZES, (915, 412)):
        live.page.set_viewport_size({"width": width, "height": height})
        live.settle_panels()
        card = live.page.locator("#finish").bounding_box()
        assert card is not None
        found = {name: box for name, box in boxes(live).items() if name in ("#brand", "#bar", "#hud")}
        assert [name for name, box in found.items() if overlap(box, card)] == [], (width, height)


@pytest.mark.long
def test_h_and_the_address_hide_everything_but_the_world(open_page: Open) -> None:
    live = open_page("scene=empty")
    assert "#bar" in boxes(live)
    live.page.keyboard.press("h")
    assert boxes(live) == {}
    live.page.keyboard.press("Escape")
    assert {"#brand", "#bar", "#hud"} <= set(boxes(live))
    assert boxes(open_page("scene=empty&ui=0")) == {}


@pytest.mark.parametrize("viewport", PHONES)
def test_on_a_phone_the_whole_avatar_is_in_sight(open_page: Open, viewport: tuple[int, int]) -> None:
    live = open_page("scene=a", viewport=viewport, has_touch=True, is_mobile=True)
    live.wait("s.scene === 'a'")
    live.page.wait_for_selector("#status:not(:empty)")
    feet = live.state()["feet"]
    assert feet[1] + 12 < boxes(live)["#status"]["y"]


@pytest.mark.parametrize("viewport", [PHONES[0], pytest.param((844, 390), id="landscape", marks=pytest.mark.long)])
def test_on_a_phone_every_control_is_as_large_as_a_thumb(open_page: Open, viewport: tuple[int, int]) -> None:
    live = open_page(viewport=viewport, has_touch=True, is_mobile=True)
    live.page.tap("#menu-button")
    live.page.wait_for_selector("#menu:not(.closed)")
    assert live.page.evaluate(SMALLEST) == []
    live.page.tap("#menu-button")
    live.page.tap("#help-button")
    live.page.wait_for_selector("#help[open]")
    assert live.page.evaluate(SMALLEST) == []
    assert live.page.inner_text("#help h3 >> nth=0") == "Touch"


def test_on_a_phone_panels_can_be_hidden_and_come_back(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(844, 390), has_touch=True, is_mobile=True)
    live.page.tap("#hud-close")
    assert "#hud" not in boxes(live)
    live.page.tap("#menu-button")
    live.page.tap("#hide-all")
    assert boxes(live) == {}
    live.page.tap("#show-all")
    assert {"#brand", "#bar"} <= set(boxes(live))
    live.page.tap("label:has(#hud-shown)")
    assert "#hud" in boxes(live)


@pytest.mark.long
def test_a_page_that_stands_still_keeps_its_line(open_page: Open) -> None:
    live = open_page("scene=empty")
    live.page.evaluate("() => { const end = performance.now() + 9000; while (performance.now() < end); }")
    count = live.state()["framesReceived"]
    live.wait(f"s.framesReceived > {count + 4}")  # of who stands still frames are few
    assert live.state()["timesOpened"] == 1
    assert live.page.is_hidden("#veil")
