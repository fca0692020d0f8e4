"""A real server, a real headless Chromium, and pages on it."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from elbowroom.errors import InputError
from elbowroom.film.page import browser_path
from elbowroom.server.app import HOW_TO_BUILD, client_is_built
from live_page import LivePage, open_live_page
from live_server import LiveServer

# SwiftShader draws WebGL without a graphics card. The frame limit stays: without it frame pacing is erratic.
FLAGS = ("--no-sandbox", "--enable-unsafe-swiftshader", "--use-angle=swiftshader", "--disable-gpu-compositing")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Everything in this folder needs a browser."""
    here = Path(__file__).parent
    for item in items:
        if here in item.path.parents:
            item.add_marker(pytest.mark.browser)


@pytest.fixture(scope="session")
def chromium() -> Iterator[Any]:
    """A running browser; skips where there is none."""
    try:
        path = browser_path()
    except InputError as error:
        pytest.skip(str(error), allow_module_level=True)
    if not client_is_built():
        pytest.skip(HOW_TO_BUILD)
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=list(FLAGS))
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def live_server() -> Iterator[LiveServer]:
    """A server that all tests share; each page has a session of its own in it."""
    with LiveServer() as server:
        yield server


@pytest.fixture
def open_page(chromium: Any, live_server: LiveServer) -> Iterator[Any]:
    """Opens pages: `open_page("scene=a", viewport=(390, 844), has_touch=True)`; no page may log an error."""
    pages: list[LivePage] = []

    def opened(query: str = "", **options: Any) -> LivePage:
        server = options.pop("server", live_server)
        page = open_live_page(chromium, server.url, query, **options)
        pages.append(page)
        return page

    yield opened
    for page in pages:
        page.close()
    assert [error for page in pages for error in page.errors] == []
