"""Walks that are kept: as a recording, and in the browser over a reload."""

from collections.abc import Callable
from pathlib import Path

import pytest

from elbowroom.control.recordings.recording import Recording
from live_page import LivePage

Open = Callable[..., LivePage]


def test_the_walk_so_far_is_saved_as_a_recording(open_page: Open, tmp_path: Path) -> None:
    live = open_page("scene=d", viewport=(1280, 800), accept_downloads=True)
    live.wait("s.scene === 'd'")
    live.page.keyboard.down("w")
    live.wait("s.root.z > 0.6")
    live.page.keyboard.up("w")
    with live.page.expect_download() as saved:
        live.page.click("#record")
    file = tmp_path / saved.value.suggested_filename
    saved.value.save_as(file)
    assert file.name == "d.elbow"
    recording = Recording(file)
    assert recording.steps()["root"][-1][1] > 0.5
    assert recording.note is None
    assert recording.header.scene["name"] == "d"


@pytest.mark.long
def test_walks_can_be_replayed_after_the_page_is_loaded_again(open_page: Open) -> None:
    live = open_page("scene=d")
    live.wait("s.scene === 'd'")
    live.page.keyboard.down("w")
    live.wait("s.root.z > 0.8")
    live.page.keyboard.up("w")
    kept = """
    (async () => {
      const known = await indexedDB.databases();
      if (!known.some(({ name }) => name === "elbowroom.walks")) return 0;
      return new Promise((resolve) => {
        const request = indexedDB.open("elbowroom.walks");
        request.onsuccess = () => {
          const all = request.result.transaction("walks").objectStore("walks").getAll();
          all.onsuccess = () => { request.result.close(); resolve(all.result.length); };
        };
      });
    })()
    """
    for _ in range(100):
        if live.page.evaluate(kept):
            break
        live.page.wait_for_timeout(200)
    live.page.reload()
    live.wait("s.scene === 'd' && s.root && s.root.z < 0.1 && s.avatarLoaded")
    live.page.keyboard.press("k")
    live.wait("s.replay && s.replay.frames > 30 && s.replay.duration > 0.5")
    live.wait("s.root.z > 0.3")
