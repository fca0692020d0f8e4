"""Takes the pictures of the documentation from the running page: `python tools/make_pictures.py [FOLDER]`.

Starts the server, walks the stock avatar into a scene step by step in a headless Chromium, and takes screenshots.
"""

import socket
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from urllib.error import URLError
from urllib.request import urlopen

from playwright.sync_api import Page, sync_playwright

FLAGS = ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"]
FOLDER = Path(__file__).resolve().parents[1] / "docs" / "images"


@dataclass(frozen=True)
class Picture:
    """Where the avatar stands and how it is looked at."""

    name: str
    query: str
    until: float  # metres along z that the avatar has walked
    drag: tuple[int, int] = (0, 0)  # pixels by which the camera is dragged round
    wheel: int = 0
    size: tuple[int, int] = (1280, 720)
    scheme: str = "light"


PICTURES = (
    Picture("hero", "scene=c&ui=0", 1.3, (470, 10), -330),
    Picture("overlays", "scene=c&overlays=path,ghosts,nearest", 1.35, (120, 30), -200),
    Picture("scene-d-dark", "scene=d&overlays=capsules", 1.8, (-160, 20), -200, scheme="dark"),
)


def free_port() -> int:
    """A port that nobody listens on now."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def wait_for(address: str, seconds: float = 120.0) -> None:
    """Return when the server answers; raises TimeoutError."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        try:
            urlopen(f"{address}/api/health").close()
        except URLError:
            time.sleep(0.3)
        else:
            return
    raise TimeoutError(f"no answer from {address}")


def walk_to(page: Page, z: float) -> None:
    """Hold W and let the paused simulation step until the avatar is at z."""
    page.wait_for_function("window.__app?.avatarLoaded && window.__app.framesDrawn > 0", timeout=120_000)
    page.keyboard.press("KeyP")
    page.wait_for_function("window.__app.paused")
    page.keyboard.down("KeyW")
    while (page.evaluate("window.__app.root.z")) < z:
        for _ in range(5):
            page.keyboard.press("Period")
        page.wait_for_timeout(60)
    page.keyboard.up("KeyW")


def take(page: Page, picture: Picture, folder: Path) -> None:
    """One picture; the camera is given time to come to rest."""
    walk_to(page, picture.until)
    middle = (picture.size[0] // 2, picture.size[1] // 2)
    page.mouse.move(*middle)
    page.mouse.wheel(0, picture.wheel)
    if picture.drag != (0, 0):
        page.mouse.down()
        page.mouse.move(middle[0] + picture.drag[0], middle[1] + picture.drag[1], steps=4)
        page.mouse.up()
    drawn = page.evaluate("window.__app.framesDrawn")
    page.wait_for_function(f"window.__app.framesDrawn > {drawn + 12}", timeout=120_000)
    page.screenshot(path=folder / f"{picture.name}.png")


def main() -> None:
    """Take all pictures."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    port = free_port()
    address = f"http://127.0.0.1:{port}"
    server = subprocess.Popen([sys.executable, "-m", "elbowroom", "play", "--no-open", "--port", str(port)])
    try:
        wait_for(address)
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=FLAGS)
            for picture in PICTURES:
                width, height = picture.size
                page = browser.new_page(
                    viewport={"width": width, "height": height},
                    bypass_csp=True,
                    color_scheme="dark" if picture.scheme == "dark" else "light",
                )
                page.goto(f"{address}/?quality=high&{picture.query}")
                take(page, picture, folder)
                page.close()
                print(folder / f"{picture.name}.png")
    finally:
        server.terminate()


if __name__ == "__main__":
    main()
