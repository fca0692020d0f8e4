"""Runs that play without a server: from a file, in a notebook's frame, saved from the page."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import elbowroom as er
from browser_recording import record_walk
from live_page import LivePage

Open = Callable[..., LivePage]

PLAYS = "window.__player && window.__player.avatarLoaded && window.__player.drawn > 3 && window.__player.root"


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return record_walk(tmp_path_factory.mktemp("runs") / "run.elbow", 200)


def test_a_run_plays_from_a_file_and_asks_the_network_for_nothing(chromium: Any, run: Path, tmp_path: Path) -> None:
    file = er.show(run).save(tmp_path / "walk.html")
    page = chromium.new_page(viewport={"width": 900, "height": 600})
    asked: list[str] = []
    errors: list[str] = []
    page.on("request", lambda request: asked.append(request.url))
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(f"{file.as_uri()}?quality=low")
    page.wait_for_function(PLAYS, timeout=60_000)
    before = page.evaluate("window.__player")
    page.wait_for_function(f"window.__player.replay.time > {before['replay']['time'] + 0.3}", timeout=60_000)
    page.keyboard.press("Space")
    page.wait_for_function("!window.__player.replay.playing", timeout=60_000)
    state = page.evaluate("window.__player")
    page.close()
    assert state["replay"]["duration"] > 1.0
    assert state["said"] == ""
    assert errors == []
    assert [url for url in asked if not url.startswith(("file:", "blob:", "data:"))] == []
    assert len([url for url in asked if url.startswith("file:")]) == 1


@pytest.mark.long
def test_a_run_plays_in_the_frame_of_a_notebook(chromium: Any, run: Path, tmp_path: Path) -> None:
    notebook = tmp_path / "notebook.html"
    notebook.write_text(f"<!doctype html><body>{er.show(run, height=400)._repr_html_()}", "utf-8")
    page = chromium.new_page(viewport={"width": 900, "height": 600})
    page.goto(notebook.as_uri())
    frame = page.wait_for_selector("iframe").content_frame()
    frame.wait_for_function(PLAYS, timeout=60_000)
    page.close()


@pytest.mark.long
def test_a_walk_is_saved_from_the_page_as_a_page(open_page: Open, chromium: Any, tmp_path: Path) -> None:
    live = open_page("scene=d", viewport=(1280, 800), accept_downloads=True)
    live.wait("s.scene === 'd'")
    live.page.keyboard.down("w")
    live.wait("s.root.z > 0.8")
    live.page.keyboard.up("w")
    live.page.keyboard.press("k")
    live.wait("s.replay")
    with live.page.expect_download() as saved:
        live.page.select_option("#replay .save select", "html")
    file = tmp_path / saved.value.suggested_filename
    saved.value.save_as(file)
    assert file.suffix == ".html"
    page = chromium.new_page(viewport={"width": 390, "height": 700})
    page.goto(f"{file.as_uri()}?quality=low")
    page.wait_for_function(PLAYS, timeout=60_000)
    page.wait_for_function("window.__player.root.z > 0.3", timeout=60_000)
    assert page.inner_text(".standalone-head h1").startswith("D:")
    page.close()
