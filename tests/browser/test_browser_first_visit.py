"""A first visit on a phone, in Chinese, by touch alone: a crossing, its replay, a film, and the film is shared."""

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from live_page import LivePage

Open = Callable[..., LivePage]

# A phone's dialog for sharing, which a browser without a screen does not have.
DIALOG = """
window.shared = [];
navigator.canShare = ({ files }) => files.length > 0;
navigator.share = async ({ files }) => {
  if (!navigator.userActivation.isActive) throw new DOMException("no gesture", "NotAllowedError");
  window.shared.push(...files.map(({ name, type, size }) => ({ name, type, size })));
};
"""
PICTURES = os.environ.get("ELBOWROOM_SHOTS")  # a folder for pictures of each step, for who wants to look


class Finger:
    """Touches the page."""

    def __init__(self, live: LivePage) -> None:
        self._live, self._wire = live, live.page.context.new_cdp_session(live.page)

    def tap(self, words: str) -> None:
        """Tap the button of this name."""
        self._live.page.get_by_role("button", name=words, exact=True).first.tap()

    def stick(self, x: float, y: float, up: float) -> None:
        """Put a finger down and drag it upwards; it stays there."""
        self._touch("touchStart", x, y)
        for k in range(1, 5):
            self._touch("touchMove", x, y - 0.25 * k * up)

    def lift(self) -> None:
        self._wire.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})

    def _touch(self, kind: str, x: float, y: float) -> None:
        self._wire.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [{"x": x, "y": y}]})


def picture(live: LivePage, name: str) -> None:
    if PICTURES:
        live.page.screenshot(path=Path(PICTURES) / f"phone-{name}.png")


@pytest.mark.long
def test_a_first_visit_ends_with_a_shared_film_of_a_crossing(open_page: Open) -> None:
    options: dict[str, Any] = {"has_touch": True, "is_mobile": True, "locale": "zh-TW", "device_scale_factor": 1}
    live = open_page("scene=beam&speed=1.6", viewport=(390, 844), script=DIALOG, **options)
    live.settle()
    assert live.page.evaluate("document.documentElement.lang") == "zh-Hant"
    picture(live, "1-arrived")
    finger = Finger(live)
    finger.stick(100, 620, 70)
    live.wait("s.root.z > 1.5")
    picture(live, "2-walking")
    live.wait("s.crossed === 1")
    finger.lift()
    live.page.wait_for_selector("#finish:not([hidden])")
    assert "秒通過" in live.page.locator("#finish-title").inner_text()
    picture(live, "3-finish")
    finger.tap("重播")
    live.wait("s.replay && s.replay.duration > 1")
    live.page.locator("#replay .transport select").select_option("4")
    live.page.locator("#replay-play").focus()
    picture(live, "4-replay")
    with live.page.expect_download() as download:
        finger.tap("錄製影片")
    assert download.value.path().stat().st_size > 1000
    live.page.wait_for_selector("#replay .share:not([hidden])")
    picture(live, "5-filmed")
    finger.tap("分享影片")
    live.page.wait_for_function("window.shared.length")
    (film,) = live.page.evaluate("window.shared")
    assert film["type"] in ("video/mp4", "video/webm")
    assert film["size"] > 1000
