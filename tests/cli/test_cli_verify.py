"""`elbowroom verify` as a user calls it."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from elbowroom.body.humanoid import Humanoid
from elbowroom.cli.main import app
from elbowroom.control.controller import Controller
from elbowroom.control.recordings.recording import RecordingHeader
from judged_bodies import T_POSE, gliding, scene_with, upright, write_recording

RUNNER = CliRunner()
WALL = scene_with(upright(((0.0, 1.0, 1.0), (2.0, 2.0, 0.2))))


@pytest.fixture(scope="module")
def header() -> dict[str, object]:
    return dict(json.loads(RecordingHeader.of(Controller(Humanoid.default(), WALL)).to_json()))


@pytest.fixture(scope="module")
def touching(tmp_path_factory: pytest.TempPathFactory, header: dict[str, object]) -> Path:
    path = tmp_path_factory.mktemp("runs") / "touching.elbow"
    write_recording(path, header, *gliding(T_POSE, 60, speed=0.9))
    return path


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory, header: dict[str, object]) -> Path:
    path = tmp_path_factory.mktemp("runs") / "clean.elbow"
    write_recording(path, header, *gliding(T_POSE, 20, speed=0.3))
    return path


def test_a_clean_run_ends_with_0(clean: Path) -> None:
    result = RUNNER.invoke(app, ["verify", str(clean)])
    assert result.exit_code == 0, result.output
    assert "nothing touches" in result.stdout
    assert "Skinned mesh" in result.stdout
    assert "Judging" not in result.stdout


def test_a_run_that_touches_ends_with_1_and_says_what(touching: Path) -> None:
    result = RUNNER.invoke(app, ["verify", str(touching), "--quiet"])
    assert result.exit_code == 1
    assert "TOUCHES" in result.stdout
    assert "box 0" in result.stdout
    assert result.stderr == ""


@pytest.mark.long
def test_json_tells_all(touching: Path) -> None:
    result = RUNNER.invoke(app, ["verify", str(touching), "--rate", "120", "--json"])
    assert result.exit_code == 1
    report = json.loads(result.stdout)
    assert report["clean"] is False
    assert (report["frames_recorded"], report["frames_checked"], report["rate_hz"]) == (60, 119, 120.0)
    for body in (report["capsules"], report["mesh"]):
        assert body["touching_frames"] > 0
        assert (
            body["deepest_mm"]
            == pytest.approx(-body["least_clearance_mm"])
            == pytest.approx(body["contacts"][0]["depth_mm"])
        )
        assert {"part", "obstacle", "time_s", "first_s", "last_s", "frames"} <= body["contacts"][0].keys()
        assert body["tolerance_mm"] > 0.0
    assert {"waist", "head", "leftArm", "rightArm", "heading", "root"} == report["smoothness"].keys()
    assert report["smoothness"]["root"]["speed"]["max"] == pytest.approx(0.9)
    assert report["note"] is None


def test_the_mesh_can_be_left_out(clean: Path) -> None:
    shown = RUNNER.invoke(app, ["verify", str(clean), "--no-mesh"])
    assert "not asked for" in shown.stdout
    result = RUNNER.invoke(app, ["verify", str(clean), "--no-mesh", "--json"])
    assert result.exit_code == 0
    assert json.loads(result.stdout)["mesh"] is None


def test_a_torn_file_is_judged_with_a_note(touching: Path, tmp_path: Path) -> None:
    torn = tmp_path / "torn.elbow"
    torn.write_bytes(touching.read_bytes()[:-4])
    result = RUNNER.invoke(app, ["verify", str(torn), "--no-mesh"])
    assert result.exit_code == 1
    assert "cut off" in result.stdout


def test_wrong_calls_and_files_end_with_2(touching: Path, tmp_path: Path) -> None:
    damaged = tmp_path / "damaged.elbow"
    damaged.write_bytes(touching.read_bytes()[:200])
    other = tmp_path / "other.vrm"
    other.write_bytes(b"not an avatar")
    for arguments, word in (
        ([tmp_path / "missing.elbow"], "missing.elbow"),
        ([damaged], "header"),
        ([touching, "--rate", "0"], "rate"),
        ([touching, "--avatar", other], "other.vrm"),
        ([], "recording"),
    ):
        result = RUNNER.invoke(app, ["verify", *map(str, arguments)])
        assert result.exit_code == 2, arguments
        assert word in result.stderr
        assert "Traceback" not in result.output


def test_without_the_collision_library_one_line_says_what_to_install(
    clean: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "coal", None)
    result = RUNNER.invoke(app, ["verify", str(clean), "--quiet"])
    assert result.exit_code == 2
    assert "pip install 'elbowroom[judge]'" in result.stderr
    assert result.stderr.count("\n") == 1


def test_what_walk_records_verify_finds_clean(tmp_path: Path) -> None:
    run = tmp_path / "run.elbow"
    walked = RUNNER.invoke(app, ["walk", "--scene", "a", "--limit", "2.5", "--record", str(run), "--json", "--quiet"])
    told = json.loads(walked.stdout)["least_clearance"]
    result = RUNNER.invoke(app, ["verify", str(run), "--json", "--quiet"])
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)["capsules"]["least_clearance_mm"]
    assert found <= 1e3 * told + 1e-2
    assert np.isclose(found, 1e3 * told, atol=2.0)
