"""The page in a headless browser, paused in the replay of a recording, a picture at a time."""

import base64
import os
import shutil
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from elbowroom.errors import InputError
from elbowroom.film.settings import Look
from elbowroom.film.webm import Packet
from elbowroom.server.app import HOW_TO_BUILD, client_is_built
from elbowroom.server.serving import listen, make_server, url_of
from elbowroom.server.stores.library import Library

# Those without windows come first: they open a page at half the cost, and draw the same.
BROWSERS = (
    *("chromium-headless-shell", "chrome-headless-shell"),
    *("chromium", "chromium-browser", "google-chrome", "google-chrome-stable"),
)
FLAGS = ("--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader")
CODECS = {"vp8": "V_VP8", "vp09.00.10.08": "V_VP9"}  # as browsers and as Matroska name them

_PATIENCE = 600.0  # seconds: the pictures may be drawn without a graphics card
_TIMES = 10  # that a key is pressed within it
_SETTLED = 2  # pictures until what was asked for is drawn
_KEY_EVERY = 60  # pictures
_SEEK = """(time) => {
  const slider = document.querySelector("#replay .timeline input");
  slider.value = String(time);
  slider.dispatchEvent(new Event("input"));
}"""
_ENCODER = """([codec, width, height, fps]) => new Promise((done, failed) => {
  const packets = [];
  const encoder = new VideoEncoder({
    output: (chunk) => {
      const data = new Uint8Array(chunk.byteLength);
      chunk.copyTo(data);
      packets.push([data, chunk.timestamp / 1e6, chunk.type === "key"]);
    },
    error: (error) => { window.__film.error = String(error); },
  });
  window.__film = { packets, encoder, error: "" };
  const config = { codec, width, height, framerate: fps, bitrate: width * height * fps * 0.12, latencyMode: "quality" };
  VideoEncoder.isConfigSupported(config).then(({ supported }) => {
    if (!supported) throw new Error("no such codec");
    encoder.configure(config);
    done(true);
  }).catch(failed);
})"""
_ENCODE = """async ([picture, time, key]) => {
  const { packets, encoder, error } = window.__film;
  if (error) throw new Error(error);
  if (picture) {
    const bitmap = await createImageBitmap(await (await fetch("data:image/png;base64," + picture)).blob());
    const frame = new VideoFrame(bitmap, { timestamp: Math.round(time * 1e6) });
    encoder.encode(frame, { keyFrame: key });
    frame.close();
  } else await encoder.flush();
  const text = (data) => { let all = ""; for (const byte of data) all += String.fromCharCode(byte); return btoa(all); };
  return packets.splice(0).map(([data, at, isKey]) => [text(data), at, isKey]);
}"""


@contextmanager
def served(library: Library) -> Iterator[str]:
    """The address of a server of our own, in a thread, as long as the block lasts."""
    if not client_is_built():
        raise InputError(HOW_TO_BUILD)
    with listen("127.0.0.1", 0) as opened:
        server = make_server(library, opened)
        thread = threading.Thread(target=server.run, kwargs={"sockets": [opened]}, daemon=True)
        thread.start()
        try:
            while not server.started and thread.is_alive():
                time.sleep(0.01)
            yield url_of(opened)
        finally:
            server.should_exit = True
            thread.join(10.0)


def browser_path() -> str:
    """The browser to draw with: `$ELBOWROOM_CHROMIUM`, or Chromium or Chrome from the path; raises `InputError`."""
    named = os.environ.get("ELBOWROOM_CHROMIUM")
    found = named or next((path for name in BROWSERS if (path := shutil.which(name))), None)
    if found is None:
        raise InputError("no Chromium or Chrome is found: install one, or name it in ELBOWROOM_CHROMIUM")
    return found


class FilmedPage:
    """The replay that a server was started with, paused."""

    def __init__(self, page: Any, look: Look) -> None:
        self._page, self._look = page, look

    @property
    def size(self) -> tuple[int, int]:
        """Pixels of a picture."""
        return self._look.size

    @property
    def duration(self) -> float:
        """Seconds of the recording."""
        return float(self._page.evaluate("window.__app.replay.duration"))

    def picture(self, seconds: float) -> bytes:
        """What is seen at a time of the recording, as PNG."""
        self._page.evaluate(_SEEK, seconds)
        drawn = self._page.evaluate("window.__app.framesDrawn") + _SETTLED
        self._page.wait_for_function(f"window.__app.framesDrawn >= {drawn}")
        return bytes(self._page.screenshot(type="png"))

    def begin_encoding(self, fps: float) -> str:
        """Make an encoder for pictures of the page's size; its codec as Matroska names it. Raises `InputError`."""
        for codec, name in CODECS.items():
            try:
                self._page.evaluate(_ENCODER, [codec, *self._look.size, fps])
            except Exception as error:  # what a browser cannot do it says in its own way
                why = error
                continue
            return name
        raise InputError(f"this browser compresses no films ({why}); write a .gif")

    def encode(self, picture: bytes | None, seconds: float = 0.0, number: int = 0) -> list[Packet]:
        """Hand a picture over, or None at the end; what has been compressed by now."""
        data = "" if picture is None else base64.b64encode(picture).decode()
        made = self._page.evaluate(_ENCODE, [data, seconds, number % _KEY_EVERY == 0])
        return [Packet(base64.b64decode(text), time, key) for text, time, key in made]


@contextmanager
def filmed_page(url: str, look: Look, scale: float = 1.0) -> Iterator[FilmedPage]:
    """The page of a server in a headless browser, laid out at the look's size and drawn at `scale` of it.

    Raises `InputError` where there is no browser, or it draws nothing.
    """
    try:
        from playwright.sync_api import Error, TimeoutError, sync_playwright
    except ImportError:
        raise InputError("films need Playwright, which drives the browser: pip install 'elbowroom[film]'") from None

    width, height = look.size
    theme = "dark" if look.dark else "light"
    query = f"replay&ui=0&quality={look.quality}&camera={look.camera}&overlays={look.overlays}&theme={theme}"
    with sync_playwright() as playwright:
        try:
            browser = playwright.chromium.launch(executable_path=browser_path(), args=list(FLAGS))
        except Error as error:
            raise InputError(f"{browser_path()} does not start: {str(error).splitlines()[0]}") from None
        page = browser.new_page(
            viewport={"width": width, "height": height},
            bypass_csp=True,
            reduced_motion="reduce",
            device_scale_factor=scale,
        )
        page.set_default_timeout(1000.0 * _PATIENCE)
        try:
            page.goto(f"{url}/?{query}")
            page.wait_for_function("window.__app?.replay && window.__app.avatarLoaded && window.__app.framesDrawn > 3")
            _pause(page, TimeoutError)
            yield FilmedPage(page, look)
        except TimeoutError:
            late = f"the page was not drawn within {_PATIENCE:g} s"
            raise InputError(f"{late}: a smaller --size or --quality low is drawn sooner") from None
        browser.close()


def _pause(page: Any, late: type[Exception]) -> None:
    """Press Space until the replay stands: a page that is busy may miss a key. Raises `late` if it never does."""
    for left in reversed(range(_TIMES)):
        if not page.evaluate("window.__app.replay.playing"):
            return
        page.keyboard.press("Space")
        try:
            page.wait_for_function("!window.__app.replay.playing", timeout=1000.0 * _PATIENCE / _TIMES)
        except late:
            if not left:
                raise
