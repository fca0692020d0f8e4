"""`elbowroom gauntlet` as a user calls it."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from elbowroom.body.stock import stock_avatar_path
from elbowroom.cli.main import app
from elbowroom.world.scene import Scene
from gauntlet_courses import course

RUNNER = CliRunner()
COUNTS = ("crossed", "straight", "stuck", "stopped", "touching_frames", "courses")


def test_json_tells_all_and_the_exit_code_the_outcome(tmp_path: Path) -> None:
    arguments = ["gauntlet", "--level", "1", "--courses", "1", "--jobs", "1", "--out", str(tmp_path), "--judge", "-q"]
    outcome = RUNNER.invoke(app, [*arguments, "--json"])
    report = json.loads(outcome.stdout)
    assert all(isinstance(report[name], int) for name in COUNTS)
    assert report["courses"] == 1
    assert report["crossed"] + report["stopped"] == 1
    assert report["touching_frames"] == report["judged_touching"] == 0
    assert set(report["plan_ms"]) == {"p50", "p99", "max"}
    assert report["settings"]["level"]["margin"] == 0.06
    assert report["settings"]["planner"] == "exact"
    assert report["trials"][0]["fingerprint"] == course(1, 0).fingerprint
    assert outcome.exit_code == (0 if report["crossed"] else 1)
    assert outcome.stderr == ""
    assert json.loads((tmp_path / "gauntlet-1.json").read_text()) == report
    again = RUNNER.invoke(app, arguments)  # nothing is walked again
    assert again.exit_code == outcome.exit_code
    assert f"{report['crossed']} of 1" in again.stdout
    assert "touching poses, by the judge" in again.stdout


def test_save_writes_the_course_as_a_scene(tmp_path: Path) -> None:
    path = tmp_path / "course.json"
    outcome = RUNNER.invoke(app, ["gauntlet", "--level", "2", "--seed", "1", "--save", "1", str(path), "-q"])
    assert outcome.exit_code == 0, outcome.output
    assert Scene.load(path).to_dict() == course(2, 2).scene.to_dict()


def test_show_opens_the_page_with_the_course(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: dict[str, object] = {}

    def play(**arguments: object) -> None:
        seen.update(arguments, found=Scene.load(str(arguments["scene"])))

    monkeypatch.setattr("elbowroom.cli.play.play", play)
    outcome = RUNNER.invoke(app, ["gauntlet", "--level", "1", "--show", "2", "--queue", "4", "-q"])
    assert outcome.exit_code == 0, outcome.output
    assert seen["found"].to_dict() == course(1, 2).scene.to_dict()  # type: ignore[attr-defined]
    assert seen["queue"] == 4
    assert not Path(str(seen["scene"])).exists()


@pytest.mark.parametrize(
    "arguments",
    [
        ["--level", "0"],
        ["--level", "six"],
        ["--courses", "0"],
        ["--seed", "-1"],
        ["--planner", "guess"],
        ["--queue", "1"],
        ["--jobs", "0"],
        ["--show", "-1"],
        ["--save", "3"],
        ["--save", "0", "no/such/folder/course.json"],
    ],
)
def test_a_wrong_call_ends_with_2_and_one_line(arguments: list[str]) -> None:
    outcome = RUNNER.invoke(app, ["gauntlet", "--courses", "2", "-q", *arguments])
    assert outcome.exit_code == 2
    assert not outcome.stdout


@pytest.mark.long
def test_another_avatar_gets_courses_of_its_own_and_its_mesh_is_judged(tmp_path: Path) -> None:
    avatar = ["--avatar", str(stock_avatar_path()), "--height", "1.9"]
    arguments = ["gauntlet", "--level", "1", "--courses", "1", "--jobs", "1", "--judge", "-q", *avatar]
    report = json.loads(RUNNER.invoke(app, [*arguments, "--json"]).stdout)
    assert report["settings"]["avatar"]["height"] == 1.9
    assert report["trials"][0]["fingerprint"] != course(1, 0).fingerprint
    assert report["mesh_touching"] == report["judged_touching"] == 0
    assert report["mesh_clearance"] > 0.0
    path = tmp_path / "tall.json"
    RUNNER.invoke(app, ["gauntlet", "--level", "1", "--save", "0", str(path), "-q", *avatar])
    assert Scene.load(path).name == "gauntlet-1-0"
    assert Scene.load(path).to_dict() != course(1, 0).scene.to_dict()
