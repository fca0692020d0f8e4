"""`elbowroom walk` and `replay` as a user calls them."""

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numba
import pytest
from typer.testing import CliRunner

from elbowroom.cli import walk
from elbowroom.cli.main import app
from elbowroom.control.recordings import recording
from elbowroom.control.recordings import replay as replays
from elbowroom.experiment.crossing import CrossingResult
from elbowroom.experiment.gauntlet.names import parse_name
from elbowroom.formats.models.kinds import ModelKind, kind_by_name
from elbowroom.world.scene import Scene
from sampled import sampled

RUNNER = CliRunner()
SCENE = {
    "format": "elbowroom-scene",
    "version": 1,
    "name": "short",
    "title": "Two steps",
    "description": "A short way past a box.",
    "ground": {"size": [6, 6], "center": [0, 0]},
    "start": {"position": [0, 0], "heading": 0},
    "finish": {"position": [0, 0.8], "heading": 0},
    "obstacles": [{"type": "box", "name": "box", "center": [0.9, 0.5, 0.5], "size": [0.5, 1.0, 0.5]}],
}


def elbowroom(*arguments: object) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "elbowroom", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path, dict[str, object]]:
    folder = tmp_path_factory.mktemp("walk")
    scene, recording = folder / "short.json", folder / "run.elbow"
    scene.write_text(json.dumps(SCENE))
    result = RUNNER.invoke(app, ["walk", "--scene", str(scene), "--queue", "4", "--record", str(recording), "--json"])
    assert result.exit_code == 0, result.output
    return scene, recording, json.loads(result.stdout)


def test_walk_tells_its_row_as_json(run: tuple[Path, Path, dict[str, object]]) -> None:
    row = run[2]
    assert row["passed"] is True
    assert row["scene"] == "short"
    assert row["queue_size"] == 4
    columns = {"straight", "stuck_times", "passed_time_s", "plans_total", "plan_success_rate", "plan_failed_rate"}
    assert columns | {"collision_checks", "realtime", "frames", "planner", "seed"} <= row.keys()


def test_walk_prints_a_table_and_no_progress_on_stdout(run: tuple[Path, Path, dict[str, object]]) -> None:
    result = RUNNER.invoke(app, ["walk", "--scene", str(run[0])])
    assert result.exit_code == 0
    assert "passed" in result.stdout
    assert "collision checks" in result.stdout
    assert "Walking" not in result.stdout


def test_real_time_is_told_by_both_criteria(
    run: tuple[Path, Path, dict[str, object]], capsys: pytest.CaptureFixture[str]
) -> None:
    columns: dict[str, Any] = run[2] | {"frames": 300, "frame_ms_worst": 498.0, "late_frames": 30, "realtime": True}
    del columns["recording"]
    walk._report(CrossingResult(**columns), None, False)
    words = " ".join(capsys.readouterr().out.split())
    assert "real time, the paper's yes: more than one frame in every second" in words
    assert "real time, ours no: 30 of 300 frames over 1/60 s late" in words


def test_a_walk_that_falls_short_ends_with_1(run: tuple[Path, Path, dict[str, object]]) -> None:
    result = RUNNER.invoke(app, ["walk", "--scene", str(run[0]), "--limit", "0.2", "--quiet"])
    assert result.exit_code == 1
    assert result.stderr == ""


def test_replay_is_identical(run: tuple[Path, Path, dict[str, object]]) -> None:
    result = RUNNER.invoke(app, ["replay", str(run[1])])
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith(f"identical: {run[2]['frames']} frames")


def test_replay_tells_it_as_json(run: tuple[Path, Path, dict[str, object]]) -> None:
    result = RUNNER.invoke(app, ["replay", str(run[1]), "--json", "-q"])
    told = json.loads(result.stdout)
    assert told["identical"] is True
    assert told["frames"] == run[2]["frames"]
    assert told["first_difference"] is None


@pytest.mark.parametrize(
    ("cut", "told"), sampled([(400, "cut off"), (3, "in its last bytes"), (16, "without its end mark")])
)
def test_replay_of_a_cut_recording_says_what_is_missing_and_ends_with_1(
    run: tuple[Path, Path, dict[str, object]], tmp_path: Path, cut: int, told: str
) -> None:
    torn = tmp_path / "torn.elbow"
    torn.write_bytes(run[1].read_bytes()[:-cut])
    result = RUNNER.invoke(app, ["replay", str(torn)])
    assert result.exit_code == 1
    assert result.stdout.startswith("identical as far as it goes: ")
    assert told in result.stdout
    assert "step " in result.stdout
    assert json.loads(RUNNER.invoke(app, ["replay", str(torn), "--json"]).stdout)["identical"] is False


def test_replay_names_what_it_was_recorded_with(
    run: tuple[Path, Path, dict[str, object]], monkeypatch: pytest.MonkeyPatch
) -> None:
    """As if here were another processor, on which the last bits come out otherwise."""
    there = recording.this_machine()
    monkeypatch.setattr(recording, "this_machine", lambda: there | {"processor": "generic"})
    monkeypatch.setattr(replays, "_same", lambda *_: False)
    result = RUNNER.invoke(app, ["replay", str(run[1])])
    assert result.exit_code == 1
    assert f"processor {there['processor']} (here generic)" in result.stdout
    assert "bit for bit holds for the same ones alone" in result.stdout


def test_the_processor_of_a_recording_is_the_one_that_kernels_are_compiled_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(numba.config, "CPU_NAME", "generic")
    assert recording.this_machine()["processor"] == "generic"


def test_replay_with_another_avatar_is_refused(run: tuple[Path, Path, dict[str, object]], tmp_path: Path) -> None:
    other = tmp_path / "other.vrm"
    other.write_bytes(b"not an avatar")
    result = RUNNER.invoke(app, ["replay", str(run[1]), "--avatar", str(other)])
    assert result.exit_code == 2
    assert "other.vrm" in result.stderr


@pytest.mark.parametrize(
    ("arguments", "word"),
    sampled(
        [
            (["nonsense"], "nonsense"),
            (["walk", "--nonsense"], "--nonsense"),
            (["walk", "--scene", "zz"], "nor a random course (gauntlet:LEVEL:SEED, for example gauntlet:5:1013)"),
            (["walk", "--scene", "Gauntlet:9:1"], "level: 9"),
            (["walk", "--planner", "psychic"], "psychic"),
            (["walk", "--queue", "1"], "queue size"),
            (["walk", "--queue", "many"], "--queue"),
            (["walk", "--seed", "-1"], "seed"),
            (["walk", "--limit", "0"], "limit"),
            (["walk", "--avatar", "nobody.vrm"], "nobody.vrm"),
            (["replay", "nothing.elbow"], "nothing.elbow"),
            (["replay"], "recording"),
        ],
        6,
    ),
)
def test_a_wrong_call_is_one_line_and_2(arguments: list[str], word: str) -> None:
    result = elbowroom(*arguments)
    assert result.returncode == 2
    assert result.stdout == ""
    assert result.stderr.count("\n") == 1, result.stderr
    assert word in result.stderr


def test_an_unknown_scene_is_told_all_that_may_be_named() -> None:
    result = RUNNER.invoke(app, ["walk", "--scene", "nowhere"])
    assert result.exit_code == 2
    assert result.stderr.startswith("elbowroom: scene 'nowhere' is neither a stock scene (")
    listed = re.findall(r"\(([^()]*)\)", result.stderr)
    assert listed[0].split(", ") == list(Scene.stock_names())
    assert listed[1] == ".json"
    endings = listed[2].split(", ")
    assert {kind_by_name(f"house{ending}") for ending in endings} == set(ModelKind)
    assert listed[3].startswith("gauntlet:LEVEL:SEED, ")
    assert parse_name(listed[3].rpartition(" ")[2]) == (5, 1013)


def test_help_is_quick_to_import_and_names_the_commands() -> None:
    code = "import sys; from elbowroom.cli.main import app; sys.exit('numba' in sys.modules or 'numpy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
    result = RUNNER.invoke(app, ["--help"])
    assert result.exit_code == 0
    assert "walk" in result.stdout
    assert "replay" in result.stdout


@pytest.mark.parametrize("command", ["walk", "replay"])
def test_every_command_shows_examples(command: str) -> None:
    result = RUNNER.invoke(app, [command, "--help"])
    assert result.exit_code == 0
    assert f"elbowroom {command}" in result.stdout


def test_the_version_is_told() -> None:
    assert elbowroom("--version").stdout.startswith("elbowroom 0.")
