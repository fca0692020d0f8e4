"""Films of a recording, judged by the browser that plays them and by Pillow."""

import base64
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

from browser_recording import record_walk


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return record_walk(tmp_path_factory.mktemp("film") / "walk.elbow", 60)


def film(recording: Path, output: Path, *options: str) -> None:
    """The command in a process of its own: two browsers' loops do not run in one thread."""
    call = [sys.executable, "-m", "elbowroom", "film", str(recording), "-o", str(output), "--size", "128x96"]
    result = subprocess.run(
        [*call, "--quality", "low", "--quiet", *options], check=False, capture_output=True, text=True
    )
    assert result.returncode == 0, result.stderr


@pytest.mark.long
def test_a_webm_is_played_by_a_browser(chromium: object, recording: Path, tmp_path: Path) -> None:
    film(recording, tmp_path / "walk.webm", "--fps", "5", "--camera", "front")
    page = chromium.new_page()  # type: ignore[attr-defined]
    data = base64.b64encode((tmp_path / "walk.webm").read_bytes()).decode()
    seen = page.evaluate(
        """(data) => new Promise((done, failed) => {
          const video = document.createElement("video");
          video.muted = true;
          video.onerror = () => failed(new Error(video.error.message));
          video.onended = () => done([video.videoWidth, video.videoHeight, video.currentTime]);
          video.src = "data:video/webm;base64," + data;
          video.play();
        })""",
        data,
    )
    page.close()
    assert seen[:2] == [128, 96]
    assert 0.6 < seen[2] < 1.4


@pytest.mark.usefixtures("chromium")
@pytest.mark.long
def test_a_sheet_has_sixteen_moments_and_none_like_another(recording: Path, tmp_path: Path) -> None:
    film(recording, tmp_path / "sheet.png", "--sheet")
    sheet = Image.open(tmp_path / "sheet.png")
    assert sheet.size == (128, 96)
    tiles = [sheet.crop((32 * (i % 4), 24 * (i // 4), 32 * (i % 4) + 32, 24 * (i // 4) + 24)) for i in range(16)]
    assert len({tile.tobytes() for tile in tiles}) > 8


DEAF = """data:text/html,<script>
let heard = 0;
window.__app = { replay: { playing: true, duration: 2 }, avatarLoaded: true, framesDrawn: 9 };
addEventListener("keydown", () => { heard += 1; if (heard === 3) window.__app.replay.playing = false; });
</script>"""
FILMED = """
import sys
from elbowroom.errors import InputError
from elbowroom.film import page
page._PATIENCE = 5.0
try:
    with page.filmed_page(sys.argv[1], page.Look((64, 64))) as filmed:
        print(filmed.duration)
except InputError as error:
    print(error)
"""


@pytest.mark.long
@pytest.mark.usefixtures("chromium")
@pytest.mark.parametrize(
    ("page", "said"),
    [
        ("data:text/html,<title>nothing</title>", "the page was not drawn within 5 s: a smaller --size or"),
        (DEAF, "2"),
    ],
    ids=["nothing comes up", "keys are missed"],
)
def test_a_page_that_does_not_come_up_is_told_and_one_that_misses_keys_is_asked_again(page: str, said: str) -> None:
    ran = subprocess.run([sys.executable, "-c", FILMED, page], check=True, capture_output=True, text=True)
    assert ran.stdout.startswith(said)
    assert len(ran.stdout.splitlines()) == 1
