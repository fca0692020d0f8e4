"""`elbowroom film`: what is wrong is told before a browser starts."""

import json
from pathlib import Path

import pytest

from browser_recording import record_walk
from elbowroom.cli.film import film
from elbowroom.errors import InputError
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


def test_overlays_are_those_of_the_page() -> None:
    page = (Path(__file__).parents[2] / "web/src/overlays/overlay_names.ts").read_text("utf-8")
    assert f"OVERLAYS = {json.dumps(OVERLAYS)} as const" in page
    for overlays in ("none", "all", "capsules,footprints"):
        assert Look(overlays=overlays).overlays == overlays


def test_mp4_asks_for_ffmpeg(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(InputError, match=r"\.webm, \.gif and \.png need nothing"):
        check_output(tmp_path / "a.mp4")
