"""Files that are dropped: several at once, and those with which something is wrong."""

from collections.abc import Callable
from pathlib import Path

import pytest

import elbowroom
from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.control.recordings.recording import MAGIC, Recorder
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from live_page import LivePage

Open = Callable[..., LivePage]

STOCK = Path(elbowroom.__file__).parent / "body" / "data" / "stock.vrm"
SMALL = (480, 320)
READING = 300.0  # seconds: each file is read in a process of its own, which starts slowly where others work
# A file that is larger than any that is sent, without its bytes.
LARGE = """
() => {
  const file = new File(["x"], "large.vrm");
  Object.defineProperty(file, "size", { value: 200 * 2 ** 20 });
  const event = new DragEvent("drop", { bubbles: true, cancelable: true });
  Object.defineProperty(event, "dataTransfer", { value: { types: ["Files"], files: [file] } });
  document.body.dispatchEvent(event);
}
"""


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """A recording of two seconds, without assistance: nothing has to be planned for it."""
    file = tmp_path_factory.mktemp("runs") / "walk.elbow"
    controller = Controller(Humanoid.default(), Scene.load("empty"), assist=False)
    with Recorder(file, controller) as recorder:
        for _ in range(120):
            recorder.append(controller.step(Command(forward=1.0), 1 / 60), 1 / 60)
    return file.read_bytes()


@pytest.mark.long
def test_several_files_are_taken_one_after_the_other(open_page: Open, walk: bytes) -> None:
    live = open_page("scene=empty", viewport=SMALL)
    live.drop(("cat.vrm", b"no avatar"), ("mine.vrm", STOCK.read_bytes()), ("one.elbow", walk), ("two.elbow", walk))
    live.said("cat.vrm", READING)
    state = live.wait("s.replay && s.replay.runs === 2", READING)
    assert state["settings"]["avatar"] != "stock"
    titles = live.page.locator("#replay select").first.inner_text()
    assert "one.elbow" in titles
    assert "two.elbow" in titles
    live.page.wait_for_selector("#veil", state="hidden")
    live.excuse_refusals()


@pytest.mark.long
def test_what_is_wrong_with_a_recording_is_said_and_the_walk_goes_on(open_page: Open, walk: bytes) -> None:
    live = open_page("scene=empty&lang=zh-TW", viewport=SMALL)
    newer = walk.replace(MAGIC, MAGIC[:-2] + b"9\n", 1)
    live.drop(("head.elbow", walk[:40]), ("newer.elbow", newer), ("cat.elbow", b"no recording"))
    assert "已損壞或被截斷" in live.said("head.elbow", READING)
    assert "由其他版本的 Elbowroom 記錄，其格式為 9" in live.said("newer.elbow", READING)
    assert "不是此格式的紀錄" in live.said("cat.elbow", READING)
    assert live.state()["replay"] is None
    live.drop(("cut.elbow", walk[:-600]))
    assert "之後的內容遺失" in live.said("檔案被截斷", READING)
    live.wait("s.replay && s.replay.frames > 20", READING)
    live.page.keyboard.press("Escape")
    live.wait("s.replay === null")
    before = live.state()["root"]["z"]
    live.page.keyboard.down("w")
    live.wait(f"s.root.z > {before + 0.3}")
    live.page.keyboard.up("w")
    live.excuse_refusals()


def test_a_file_that_is_too_large_is_not_sent(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=SMALL)
    live.page.evaluate(LARGE)
    assert live.said("large.vrm") == "large.vrm has 200 MB; files of 64 MB at most are taken"
    assert live.state()["connected"]
