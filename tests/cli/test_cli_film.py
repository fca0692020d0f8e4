"""`elbowroom film`: what is wrong is told before a browser starts."""

import json
import re
from contextlib import nullcontext
from pathlib import Path
from types import SimpleNamespace

import pytest

from browser_recording import record_walk
from elbowroom.cli.film import film
from elbowroom.cli.replay import library_of
from elbowroom.control.recordings.recording import Recording
from elbowroom.errors import InputError
from elbowroom.film import files, page
from elbowroom.film.settings import OVERLAYS, Look, check_output


@pytest.mark.parametrize(
    ("name", "options", "told"),
    [
        ("a.avi", {}, "films are"),
        ("a.png", {}, "--sheet"),
        ("a.webm", {"sheet": True}, "--sheet"),
        ("a.webm", {"size": "12x9"}, "--size 12x9"),
        ("a.webm", {"size": "large"}, "--size large"),
        ("a.webm", {"fps": 500.0}, "--fps 500"),
        ("a.webm", {"speed": 0.0}, "--speed 0"),
        ("a.webm", {"camera": "below"}, "--camera below"),
        ("a.webm", {"overlays": "capsules,hats"}, "--overlays hats"),
        ("missing/a.webm", {}, "does not exist"),
    ],
)
def test_a_wrong_call_is_one_line(name: str, options: dict[str, object], told: str, tmp_path: Path) -> None:
    recording = record_walk(tmp_path / "walk.elbow", 2)
    given = {
        "camera": "side",
        "size": "1280x720",
        "fps": None,
        "speed": 1.0,
        "sheet": False,
        "overlays": "none",
    } | options
    with pytest.raises(InputError, match=told) as caught:
        film(recording, output=tmp_path / name, dark=False, quality="low", avatar=None, **given)  # type: ignore[arg-type]
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(("steps", "told"), [(0, "holds no frames"), (5, "holds no frames (the file was cut off")])
def test_nobody_waits_for_frames_that_never_come(steps: int, told: str, tmp_path: Path) -> None:
    file = record_walk(tmp_path / "run.elbow", steps)
    if steps:
        file.write_bytes(file.read_bytes()[:-100])
    with pytest.raises(InputError, match=re.escape(f"run.elbow: {told}")):
        film(file, output=tmp_path / "a.webm", quiet=True)
    with pytest.raises(InputError, match=re.escape(f"run.elbow: {told}")):  # of `replay --show` too
        library_of(Recording(file), None)


@pytest.mark.parametrize("json_wanted", [False, True])
def test_a_film_of_part_of_a_walk_says_so(
    json_wanted: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(page, "served", lambda library: nullcontext("nowhere"))
    monkeypatch.setattr(page, "filmed_page", lambda *_: nullcontext(SimpleNamespace(duration=1.0)))
    monkeypatch.setattr(files, "write_film", lambda *_: 30)
    file = record_walk(tmp_path / "run.elbow", 65)
    file.write_bytes(file.read_bytes()[:-100])
    film(file, output=tmp_path / "a.webm", json=json_wanted, quiet=True)
    told = "the file was cut off or is damaged: what follows step 60 is missing"
    said = capsys.readouterr().out
    assert json.loads(said)["note"] == told if json_wanted else said.endswith(f"not whole: {told}\n")


def test_overlays_are_those_of_the_page() -> None:
    names = (Path(__file__).parents[2] / "web/src/overlays/overlay_names.ts").read_text("utf-8")
    assert f"OVERLAYS = {json.dumps(OVERLAYS)} as const" in names
    for overlays in ("none", "all", "capsules,footprints"):
        assert Look(overlays=overlays).overlays == overlays


def test_mp4_asks_for_ffmpeg(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(InputError, match=r"\.webm, \.gif and \.png need nothing"):
        check_output(tmp_path / "a.mp4")
