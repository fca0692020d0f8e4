"""The page is kept by the browser: it opens while its server is away, and a new one is never hidden by an old one."""

import shutil
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest

from elbowroom.server.app import client_folder

KEPT = "async () => (await (await caches.open('elbowroom')).keys()).map(({ url }) => url)"
SECONDS = 60.0


class _Quiet(SimpleHTTPRequestHandler):
    def log_message(self, *_: Any) -> None:
        """Nothing."""


@pytest.fixture
def served(tmp_path: Path, chromium: Any) -> Iterator[tuple[Path, ThreadingHTTPServer]]:
    """A copy of the built page, and what serves it, without any session."""
    folder = Path(shutil.copytree(client_folder(), tmp_path / "client"))
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(_Quiet, directory=folder)) as server:
        thread = threading.Thread(target=server.serve_forever, daemon=True)
        thread.start()
        yield folder, server
        server.shutdown()
        thread.join(SECONDS)


def wait_kept(page: Any, home: str, *parts: str, gone: str | None = None) -> None:
    """Wait until `home` and addresses with all these parts are kept, and none with the part that is to be `gone`."""
    for _ in range(int(20 * SECONDS)):
        kept: list[str] = page.evaluate(KEPT)
        away = gone is None or not any(gone in address for address in kept)
        if away and home in kept and all(any(part in address for address in kept) for part in parts):
            return
        page.wait_for_timeout(50)
    raise AssertionError(f"only {kept} are kept")


def test_it_opens_without_a_server_and_is_the_newest_with_one(
    chromium: Any, served: tuple[Path, ThreadingHTTPServer]
) -> None:
    folder, server = served
    home = f"http://127.0.0.1:{server.server_port}/"
    context = chromium.new_context(viewport={"width": 500, "height": 400})
    page = context.new_page()
    page.goto(f"{home}?quality=low")
    wait_kept(page, home, "/assets/index-", "/assets/three-")
    (folder / "assets" / "old.js").write_text("")
    page.evaluate("fetch('assets/old.js')")
    wait_kept(page, home, "old.js")
    whole = (folder / "index.html").read_text("utf-8")
    (folder / "index.html").write_text(whole.replace("</head>", '<meta name="edition" content="2"></head>'), "utf-8")
    page.goto(f"{home}?quality=low&scene=a")
    assert page.locator("meta[name=edition]").count() == 1
    wait_kept(page, home, "/assets/index-", "/assets/three-", gone="old.js")
    server.shutdown()
    server.server_close()
    page.goto(f"{home}?quality=low&scene=b")
    assert page.locator("meta[name=edition]").count() == 1
    page.wait_for_selector("#views button", state="attached")  # which the script has made
    context.close()
