"""All of the page by gamepad alone."""

from collections.abc import Callable

import pytest

from live_page import LivePage

Open = Callable[..., LivePage]

A, B, X, Y, LB, RB, RT, BACK, START, UP, DOWN, LEFT, RIGHT = 0, 1, 2, 3, 4, 5, 7, 8, 9, 12, 13, 14, 15

PAD = """
window.pad = { axes: [0, 0, 0, 0], down: [], tapped: null, read: 0 };
navigator.getGamepads = () => {
  const pad = window.pad, down = pad.tapped === null ? pad.down : [pad.tapped];
  pad.tapped = null;
  pad.read += 1;
  return [{
    connected: true, mapping: "standard", id: "stub", index: 0, timestamp: 0, axes: pad.axes,
    buttons: Array.from({ length: 17 }, (_, i) => ({ pressed: down.includes(i), touched: false, value: 0 })),
  }];
};
"""
TAP = """async (button) => {
  window.pad.tapped = button;
  for (const until = window.pad.read + 2; window.pad.read < until;) await new Promise(requestAnimationFrame);
}"""


def press(live: LivePage, *buttons: int) -> None:
    """Press buttons one after the other, each until the page has read it once: held, it would act again."""
    for button in buttons:
        live.page.evaluate(TAP, button)


def focused(live: LivePage) -> str:
    found: str = live.page.evaluate("document.activeElement.id")
    return found


def go_down_to(live: LivePage, element: str) -> None:
    """Press the cross downwards until an element has the focus."""
    for _ in range(60):
        press(live, DOWN)
        if focused(live) == element:
            return
    raise AssertionError(f"{element} is not reached")


@pytest.mark.long
def test_menu_lists_and_help_are_worked_by_the_pad(open_page: Open) -> None:
    live = open_page("scene=a", viewport=(640, 480), script=PAD, sparing=False)
    live.wait("s.scene === 'a'")
    press(live, START)
    live.page.wait_for_selector("#menu:not(.closed)")
    assert focused(live) == "scene"
    press(live, RIGHT)
    live.wait("s.scene !== 'a'")
    go_down_to(live, "overlay-capsules")
    press(live, A)
    live.wait("s.overlays.includes('capsules')")
    live.page.focus("#help-button")
    press(live, A)
    live.page.wait_for_selector("#help[open]")
    press(live, B)
    live.page.wait_for_selector("#help:not([open])", state="attached")
    press(live, B)
    live.page.wait_for_selector("#menu.closed", state="attached")


@pytest.mark.long
def test_finish_card_and_timeline_are_worked_by_the_pad(open_page: Open) -> None:
    live = open_page("scene=doorway&speed=1.6", viewport=(1000, 600), script=PAD, sparing=False)
    live.wait("s.scene === 'doorway'")
    live.page.evaluate("window.pad.axes = [0, -1, 0, 0]")
    live.wait("s.crossed === 1")
    live.page.evaluate("window.pad.axes = [0, 0, 0, 0]")
    live.page.wait_for_selector("#finish:not([hidden])")
    for _ in range(8):
        press(live, DOWN)
        if focused(live) == "finish-replay":
            break
    press(live, A)
    live.wait("s.replay && s.replay.duration > 1")
    live.page.focus("#replay input[type=range]")
    press(live, A)
    before = live.state()["replay"]["time"]
    press(live, RIGHT)
    assert live.state()["replay"]["time"] > before
    live.page.focus("#replay-play")
    playing = live.state()["replay"]["playing"]
    press(live, A)
    live.wait(f"s.replay.playing !== {str(playing).lower()} || s.replay.time > {before + 0.4}")
    press(live, B)
    live.wait("s.replay === null")
    press(live, 8)
    live.wait("s.root.z < 0.2")


@pytest.mark.long
def test_a_scene_is_built_by_the_pad(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(900, 600), script=PAD, sparing=False)
    live.wait("s.scene === 'empty'")
    before = live.state()["camera"]
    press(live, START)
    live.page.wait_for_selector("#menu:not(.closed)")
    live.page.focus("[data-action=farther]")
    press(live, A)
    live.wait(f"Math.hypot(...s.camera.map((at, i) => at - {before}[i])) > 0.3")
    live.page.focus("#build-open")
    press(live, A)
    live.wait("s.build")
    live.page.focus("#build .tools button")  # the box
    press(live, A)
    live.wait("s.build.tool === 'box'")
    live.page.focus("#build .board")
    press(live, A)
    live.wait("s.build.things.length === 1 && s.build.tool === 'select'")
    x, turn = (live.page.get_by_label(name, exact=True) for name in ("X (m)", "Turn (°)"))
    at = float(x.input_value())
    press(live, LEFT, X, RT)
    assert float(x.input_value()) > at
    assert float(turn.input_value()) == 15.0
    press(live, Y)
    live.wait("s.build.things.length === 2")
    press(live, BACK)
    live.wait("s.build.things.length === 1")
    press(live, RB)
    live.wait("s.build.selected !== null")
    press(live, B, B)
    live.wait("s.build === null")


@pytest.mark.long
def test_a_thing_is_pushed_by_the_pad(open_page: Open) -> None:
    live = open_page("scene=d", viewport=(640, 480), script=PAD, sparing=False)
    live.wait("s.scene === 'd'")
    press(live, START)
    live.page.wait_for_selector("#menu:not(.closed)")
    live.page.focus("#push")
    press(live, A)
    number = live.wait("s.held !== null")["held"]
    press(live, B)
    live.page.evaluate(f"window.pad.down = [{UP}]")
    live.wait(f"s.pushed.some((thing) => thing.number === {number})")
    live.page.evaluate("window.pad.down = []")
    press(live, B)
    live.wait("s.held === null")
