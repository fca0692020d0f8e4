"""A page under test: its state is `window.__app`, never its pixels or a wall-clock frame rate."""

import base64
import time
from typing import Any

from playwright.sync_api import TimeoutError as StillNotError

LOAD_SECONDS = 60.0
PATIENCE = 60.0  # seconds: much more than it takes, as other programs may keep both processors busy
READ = 150.0  # seconds, likewise: files are read by processes that give way to all others, and end after 120 s
REST = 3  # frames over which what is shown may not change, to be at rest
# A few frames later: the panels that slide (what turns for ever is not waited for), the camera and the avatar.
_SHOWN = """
async (frames) => {
  window.__hurry = true;
  for (let k = 0; k < frames; k += 1) await new Promise(requestAnimationFrame);
  window.__hurry = false;
  const ends = (animation) => animation.effect?.getComputedTiming().endTime !== Infinity;
  const sliding = document.getAnimations().filter((a) => a.playState === "running" && ends(a)).length;
  const { camera, root } = window.__app;
  return { sliding, at: [...Object.values(camera ?? {}), ...Object.values(root ?? {})].map(Number) };
}
"""
_DROP = """
(files) => {
  const transfer = new DataTransfer();
  for (const [name, text] of files) {
    transfer.items.add(new File([Uint8Array.from(atob(text), (c) => c.charCodeAt(0))], name));
  }
  for (const type of ["dragenter", "dragover", "drop"]) {
    document.body.dispatchEvent(new DragEvent(type, { bubbles: true, cancelable: true, dataTransfer: transfer }));
  }
}
"""
# Without a graphics card pictures cost more than all the rest of a test: two or three a second will do, unless it
# is pictures that are waited for (`__hurry`); between them nothing is asked of the browser.
_SPARING = """
(() => {
  const ask = window.requestAnimationFrame.bind(window);
  const waiting = new Map();
  let count = 0, last = -Infinity, next = null;
  const turn = (time) => {
    last = performance.now();
    next = null;
    for (const [id, draw] of [...waiting]) if (waiting.delete(id)) draw(time);
  };
  window.requestAnimationFrame = (draw) => {
    waiting.set((count += 1), draw);
    next ??= setTimeout(() => ask(turn), (window.__hurry ? 100 : 400) - (performance.now() - last));
    return count;
  };
  window.cancelAnimationFrame = (id) => waiting.delete(id);
})();
"""
_NO_SERVER = ("WebSocket", "net::ERR_CONNECTION")


class LivePage:
    """A page with a session in it."""

    def __init__(self, page: Any, context: Any) -> None:
        self.page = page
        self.errors: list[str] = []
        self._context = context
        page.on("console", self._note)
        page.on("pageerror", lambda error: self.errors.append(str(error)))

    def state(self) -> dict[str, Any]:
        """A snapshot of `window.__app`."""
        snapshot: dict[str, Any] = self.page.evaluate("window.__app")
        return snapshot

    def wait(self, condition: str, seconds: float = PATIENCE) -> dict[str, Any]:
        """Wait until a JavaScript condition on `s`, the page's state, holds in a picture; the state then."""
        try:
            seen = self.page.wait_for_function(f"() => {_then(condition)}", timeout=1000.0 * seconds)
        except StillNotError as error:
            text = f"after {seconds:g} s still not: {condition}; the page says {self.state()}"
            raise AssertionError(text) from error
        state: dict[str, Any] = seen.json_value()
        return state

    def wait_for_pictures(self, count: int) -> dict[str, Any]:
        """Wait until so many more pictures are drawn; the state then."""
        return self.wait(f"s.framesDrawn >= {self.state()['framesDrawn'] + count}")

    def settle(self, seconds: float = PATIENCE) -> None:
        """Wait until panels, camera and avatar have come to rest, however slow the machine."""
        deadline = time.monotonic() + seconds
        before: list[float] = []
        while time.monotonic() < deadline:
            shown = self.page.evaluate(_SHOWN, REST)
            if not shown["sliding"] and len(before) == len(shown["at"]) and _near(before, shown["at"]):
                return
            before = shown["at"]
        raise AssertionError(f"after {seconds:g} s something on the page still moves: {self.state()}")

    def settle_panels(self, seconds: float = PATIENCE) -> None:
        """Wait until panels have come to rest; for tests that look at nothing else: the camera takes longer."""
        deadline = time.monotonic() + seconds
        while self.page.evaluate(_SHOWN, 2)["sliding"]:
            assert time.monotonic() < deadline, f"after {seconds:g} s some panel still slides: {self.state()}"

    def excuse_lost_server(self) -> None:
        """A test that ended its server: what the browser logs while none answers is no error of the page."""
        self.errors[:] = [error for error in self.errors if not any(part in error for part in _NO_SERVER)]

    def excuse_refusals(self) -> None:
        """A test that sent something wrong: the browser itself logs a refused request; that is no error of the page."""
        self.errors[:] = [error for error in self.errors if "Failed to load resource" not in error]

    def drop(self, *files: tuple[str, bytes]) -> None:
        """Drop files on the page, all at once: their names and what is in them."""
        self.page.evaluate(_DROP, [[name, base64.b64encode(data).decode()] for name, data in files])

    def said(self, part: str, seconds: float = PATIENCE) -> str:
        """Wait until a notice says this, among other things; what it says."""
        notice = self.page.locator("#notices .notice p", has_text=part).first
        notice.wait_for(timeout=1000.0 * seconds)
        text: str = notice.inner_text()
        return text

    def close(self) -> None:
        """Close the page and its context."""
        self._context.close()

    def _note(self, message: Any) -> None:
        if message.type == "error":
            self.errors.append(message.text)


def _then(condition: str) -> str:
    """A copy of the page's state if the condition holds: what is true in one picture may be over in the next."""
    return f"{{ const s = window.__app; return !!s && !!({condition}) && structuredClone({{ ...s }}); }}"


def _near(a: list[float], b: list[float]) -> bool:
    return all(abs(one - other) < 1e-4 for one, other in zip(a, b, strict=True))


def open_live_page(
    browser: Any, url: str, query: str = "", viewport: tuple[int, int] = (1000, 600), **options: Any
) -> LivePage:
    """A page in a context of its own, ready: the avatar stands in the picture and poses arrive.

    `sparing`: it draws few pictures; not where every one of them is a step of what is tested.
    """
    script, sparing = options.pop("script", None), options.pop("sparing", True)
    options.setdefault("service_workers", "block")  # each page is new here: nothing need be kept
    context = browser.new_context(viewport={"width": viewport[0], "height": viewport[1]}, **options)
    page = context.new_page()
    page.set_default_timeout(1000.0 * PATIENCE)
    if sparing:
        page.add_init_script(_SPARING)
    if script:
        page.add_init_script(script)
    live = LivePage(page, context)
    page.goto(f"{url}/?quality=low&{query}")
    live.wait("s.avatarLoaded && s.framesReceived > 5 && s.framesDrawn > 1 && s.root && s.settings", LOAD_SECONDS)
    return live
