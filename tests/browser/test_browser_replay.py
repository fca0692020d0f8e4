"""A walk played again on the page: its timeline, a second run beside it, and the way back to the live walk."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.control.recordings.recording import Recorder
from elbowroom.formats.bvh import parse_bvh
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from live_page import READ, LivePage

Open = Callable[..., LivePage]


@pytest.fixture(scope="module")
def recorded_walk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A walk of two seconds, without assistance: nothing has to be planned for it."""
    file = tmp_path_factory.mktemp("runs") / "walk.elbow"
    controller = Controller(Humanoid.default(), Scene.load("doorway"), assist=False)
    with Recorder(file, controller) as recorder:
        for _ in range(120):
            recorder.append(controller.step(Command(forward=1.0), 1 / 60), 1 / 60)
    return file


def _walk_to(live: LivePage, z: float) -> None:
    live.page.keyboard.down("w")
    live.wait(f"s.root.z > {z}")
    live.page.keyboard.up("w")


def test_a_walk_is_replayed_compared_and_left_again(open_page: Open) -> None:
    live = open_page("scene=doorway&camera=side", viewport=(1100, 700))
    live.page.keyboard.press("k")
    live.page.wait_for_selector(".notice.info")
    _walk_to(live, 1.2)
    live.page.keyboard.press("t")
    live.page.keyboard.press("r")
    live.wait("s.settings.assist === false && s.root.z < 0.2")
    _walk_to(live, 1.6)
    live.page.keyboard.press("k")
    replay = live.wait("s.replay && s.replay.time > 0.2")["replay"]
    assert replay["runs"] == 2
    assert replay["duration"] > 1.0
    live.page.keyboard.press("Space")
    live.wait("s.replay.playing === false")
    live.page.locator("#replay .lanes").click(position={"x": 5, "y": 30})
    before = live.wait("s.replay.time < 0.1")["root"]["z"]
    live.page.keyboard.press(".")
    live.wait("s.replay.time > 0")
    live.page.locator("#replay input[type=range]").fill(str(0.9 * replay["duration"]))
    live.wait(f"s.root.z > {before} + 0.5")
    against = live.page.locator("#replay .against select")
    against.select_option(index=1)
    live.wait("s.replay.against === 'ghost'")
    live.page.locator("#replay .choices > select").select_option("beside")
    live.wait("s.replay.against === 'beside'")
    live.page.keyboard.press("Escape")
    live.wait("s.replay === null && s.settings.paused === false")
    z = live.state()["root"]["z"]
    live.page.keyboard.down("s")
    live.wait(f"s.root.z < {z} - 0.2")


@pytest.mark.long
def test_a_replay_is_filmed_to_its_end(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(400, 300))
    _walk_to(live, 1.0)
    live.page.keyboard.press("k")
    live.wait("s.replay")
    live.page.locator("#replay .transport select").select_option("2")
    with live.page.expect_download() as download:
        live.page.locator("#replay .rec").click()
    assert download.value.suggested_filename.rpartition(".")[2] in ("mp4", "webm")
    assert download.value.path().stat().st_size > 1000
    live.wait("s.replay.filming === false")


@pytest.mark.long
def test_a_walk_is_saved_for_other_programs(open_page: Open) -> None:
    live = open_page("scene=empty", viewport=(1000, 640))
    _walk_to(live, 1.0)
    live.page.keyboard.press("k")
    frames = live.wait("s.replay")["replay"]["frames"]
    with live.page.expect_download() as download:
        live.page.locator("#replay .save select").select_option("bvh")
    assert download.value.suggested_filename == "empty.bvh"
    take = parse_bvh(download.value.path().read_bytes(), "empty.bvh").take()
    assert len(take) > 0.5 * frames
    hips = take.translations[:, 0] * 0.01
    assert hips[-1, 2] - hips[0, 2] > 0.5
    assert np.ptp(hips[:, 1]) < 0.1


def test_a_recording_that_is_dropped_is_replayed(open_page: Open, recorded_walk: Path) -> None:
    live = open_page("scene=empty", viewport=(1000, 640))
    live.page.set_input_files("#file", recorded_walk)
    state = live.wait("s.replay && s.replay.time > 0.1", READ)
    assert state["replay"]["frames"] > 50
    live.page.keyboard.press("Space")
    live.page.locator("#replay input[type=range]").fill("1.0")
    live.wait("s.root.z > 0.4 && s.avatarLoaded")
    live.page.keyboard.press("k")
    live.wait("s.replay === null && s.root.z < 0.1")
