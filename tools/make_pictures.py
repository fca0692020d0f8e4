"""Takes the pictures of the documentation from the running page: `python tools/make_pictures.py [FOLDER [NAME ...]]`,
all of them or those with these names, such as `dark.png`.

Starts the server and walks the stock avatar into scenes, step by step, in a headless Chromium: some pictures stand,
one moves. The page is told to move nothing by itself, so the same pictures come out on any machine.
"""

import io
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from urllib.error import URLError
from urllib.request import urlopen

from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright
from playwright.sync_api import TimeoutError as PageTimeoutError

from elbowroom.film.page import browser_path

FLAGS = ["--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader"]
FOLDER = Path(__file__).resolve().parents[1] / "docs" / "images"
PATIENCE = 300_000  # milliseconds: the pictures are drawn without a graphics card
PREFERENCES = '{"hud": false}'  # times of a page that is drawn without a graphics card would mislead
SMALL = (160, 90)  # pixels, while the avatar walks to where the picture is taken
METRES_PER_STEP = 1.1 / 60
SETTLED = 12  # pictures until the camera rests and what hides the avatar has faded
LONGEST = 60.0  # seconds of walking: by then it is where its picture is taken, or stuck
STEPS_PER_PICTURE = 5  # of 1/60 s: twelve pictures a second


@dataclass(frozen=True)
class View:
    """What is looked at, and from where."""

    query: str  # of the page's address
    size: tuple[int, int]  # pixels
    drag: tuple[int, int] = (0, 0)  # pixels by which the camera is dragged round
    wheel: int = 0  # towards the avatar where negative
    dark: bool = False


@dataclass(frozen=True)
class Still:
    """A picture that stands."""

    name: str
    view: View
    until: float  # metres along z that the avatar has walked


@dataclass(frozen=True)
class Scene:
    """A part of the picture that moves."""

    view: View
    first: float  # metres along z where it begins
    last: float  # and ends


STILLS = (
    Still("overlays", View("scene=beam&camera=side&overlays=path,ghosts,nearest", (1280, 720), (70, 25), -250), 1.25),
    Still("dark", View("scene=d&overlays=capsules,nearest", (1280, 720), (-190, 30), -190, dark=True), 1.9),
)
MOVING_SIZE = (640, 360)
MOVING = (
    Scene(View("scene=d&ui=0", MOVING_SIZE, (330, 14), -300), 0.5, 4.3),
    Scene(View("scene=doorway&ui=0", MOVING_SIZE, (0, 30), -120), 0.9, 2.9),
    Scene(View("scene=beam&ui=0", MOVING_SIZE, (210, -4), -170), 1.0, 4.5),
)
MOVING_NAME = "walk.webp"
MOST_BYTES = 2_000_000


def free_port() -> int:
    """A port that nobody listens on now."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@contextmanager
def served() -> Iterator[str]:
    """The address of a server that lasts as long as the block."""
    port = free_port()
    address = f"http://127.0.0.1:{port}"
    server = subprocess.Popen([sys.executable, "-m", "elbowroom", "play", "--no-open", "--port", str(port)])
    try:
        wait_for(address)
        yield address
    finally:
        server.terminate()
        server.wait(30)


def wait_for(address: str, seconds: float = 600.0) -> None:
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


@contextmanager
def opened(browser: Browser, address: str, view: View) -> Iterator[Page]:
    """The page, paused at the start with W held down, its camera turned as the view says."""
    width, height = view.size
    page = browser.new_page(
        viewport={"width": width, "height": height},
        bypass_csp=True,
        color_scheme="dark" if view.dark else "light",
        reduced_motion="reduce",
    )
    page.set_default_timeout(PATIENCE)
    page.add_init_script(f"localStorage.setItem('elbowroom.preferences', '{PREFERENCES}')")
    page.goto(f"{address}/?quality=high&steering=tank&{view.query}")
    page.wait_for_function("window.__app?.avatarLoaded && window.__app.framesDrawn > 3 && window.__app.root")
    pause(page)
    turn(page, view)
    page.keyboard.down("KeyW")
    try:
        yield page
    finally:
        page.close()


def pause(page: Page) -> None:
    """Press P until the page says that it is paused: a session that has just begun may miss the first time."""
    for _ in range(10):
        page.keyboard.press("KeyP")
        try:
            page.wait_for_function("window.__app.paused", timeout=PATIENCE / 10)
        except PageTimeoutError:
            continue
        return
    raise TimeoutError("the page does not pause")


def turn(page: Page, view: View) -> None:
    """Drag the camera round, and nearer."""
    middle = (view.size[0] // 2, view.size[1] // 2)
    page.mouse.move(*middle)
    page.mouse.wheel(0, view.wheel)
    page.mouse.down()
    page.mouse.move(middle[0] + view.drag[0], middle[1] + view.drag[1], steps=4)
    page.mouse.up()


def step(page: Page, steps: int) -> float:
    """Let the paused simulation go on by some steps; how far along z the avatar is then."""
    then = page.evaluate("window.__app.simTime") + steps / 60.0
    for _ in range(steps):
        page.keyboard.press("Period")
    page.wait_for_function(f"window.__app.simTime > {then - 1e-3}")
    if then > LONGEST:
        raise TimeoutError(f"after {then:.0f} s of walking the avatar is still at {page.evaluate('window.__app.root')}")
    return float(page.evaluate("window.__app.root.z"))


def shot(page: Page, drawn: int) -> Image.Image:
    """The page as it is once `drawn` more pictures were drawn, so that the camera has come to rest."""
    before = page.evaluate("window.__app.framesDrawn")
    page.wait_for_function(f"window.__app.framesDrawn >= {before + drawn}")
    return Image.open(io.BytesIO(page.screenshot())).convert("RGB")


def walk_to(page: Page, view: View, z: float) -> None:
    """Go on until the avatar is at z; drawn small meanwhile, which is quicker."""
    page.set_viewport_size({"width": SMALL[0], "height": SMALL[1]})
    at = float(page.evaluate("window.__app.root.z"))
    while at < z:
        at = step(page, max(1, int(0.8 * (z - at) / METRES_PER_STEP)))
    page.set_viewport_size({"width": view.size[0], "height": view.size[1]})


def still(browser: Browser, address: str, wanted: Still) -> Image.Image:
    """One picture that stands."""
    with opened(browser, address, wanted.view) as page:
        walk_to(page, wanted.view, wanted.until)
        return shot(page, SETTLED)


def moving(browser: Browser, address: str, wanted: Scene) -> list[Image.Image]:
    """The pictures of one part, in order."""
    with opened(browser, address, wanted.view) as page:
        walk_to(page, wanted.view, wanted.first)
        pictures = [shot(page, SETTLED)]
        while step(page, STEPS_PER_PICTURE) < wanted.last:
            pictures.append(shot(page, 1))
        return pictures


def write_moving(pictures: list[Image.Image], path: Path) -> None:
    """Write them as one WebP file that shows them over and over, as well as `MOST_BYTES` allow."""
    milliseconds = round(1000 * STEPS_PER_PICTURE / 60)
    for quality in (80, 70, 60, 50, 40, 30):
        pictures[0].save(
            path, save_all=True, append_images=pictures[1:], duration=milliseconds, loop=0, quality=quality, method=4
        )
        if path.stat().st_size < MOST_BYTES:
            return


def main(folder: Path, names: list[str]) -> None:
    """Take the pictures of these names, all where there is none."""
    wanted = names or [MOVING_NAME, *(f"{one.name}.png" for one in STILLS)]
    folder.mkdir(parents=True, exist_ok=True)
    with served() as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=browser_path(), args=FLAGS)
        for one in STILLS:
            if f"{one.name}.png" in wanted:
                still(browser, address, one).save(folder / f"{one.name}.png", optimize=True)
                print(folder / f"{one.name}.png", flush=True)
        if MOVING_NAME in wanted:
            pictures = [picture for part in MOVING for picture in moving(browser, address, part)]
            write_moving(pictures, folder / MOVING_NAME)
            print(folder / MOVING_NAME, len(pictures), "pictures")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER, sys.argv[2:])
