"""`elbowroom table1` as a user calls it, interrupts it, and calls it again."""

import csv
import json
import subprocess
import sys
import time
from pathlib import Path

import pytest
from typer.testing import CliRunner

from elbowroom.cli.main import app
from table1_records import SHORT_SCENE, results

RUNNER = CliRunner()
FILES = ["report.html", "table1.csv", "table1.json"]


def command(scene: Path, out: Path, *more: object) -> list[str]:
    given = ["--scenes", scene, "--queues", "3,4", "--seeds", "2", "--limit", "5", "--jobs", "1", "--out", out, *more]
    return ["table1", *map(str, given)]


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("scene") / "short.json"
    path.write_text(json.dumps(SHORT_SCENE))
    return path


@pytest.fixture(scope="module")
def done(scene: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, object]]:
    out = tmp_path_factory.mktemp("table1")
    result = RUNNER.invoke(app, command(scene, out, "--json"))
    assert result.exit_code == 0, result.output
    assert "6 of 6" in result.stderr
    return out, json.loads(result.stdout)


@pytest.mark.long
def test_it_writes_one_report_a_csv_and_a_json(done: tuple[Path, dict[str, object]]) -> None:
    out, told = done
    assert results(out) == FILES
    assert told["files"] == [str(out / name) for name in FILES]
    rows = list(csv.DictReader((out / "table1.csv").read_text().splitlines()))
    assert [(row["scene"], row["queue_size"], row["trials"]) for row in rows] == [
        ("short", "3", "2"),
        ("short", "4", "2"),
    ]
    assert all(float(row["pass_rate"]) == 1.0 for row in rows)


def test_its_json_says_all_it_shows_and_the_file_has_every_trial(done: tuple[Path, dict[str, object]]) -> None:
    out, told = done
    kept = json.loads((out / "table1.json").read_text())
    assert {(trial["queue_size"], trial["seed"]) for trial in kept["trials"]} == {(3, 1), (3, 2), (4, 1), (4, 2)}
    assert len(kept["canned_trials"]) == 2
    assert told["cells"] == kept["cells"]
    assert told["settings"] == kept["settings"]
    assert kept["settings"]["seeds"] == [1, 2]
    assert kept["touching_trials"] == 0
    assert {"date", "machine", "command", "identity", "planner_settings", "canned_walk"} <= kept.keys()


@pytest.mark.long
def test_the_same_call_again_runs_nothing_and_more_seeds_run_the_rest(
    done: tuple[Path, dict[str, object]], scene: Path
) -> None:
    out, told = done
    again = RUNNER.invoke(app, command(scene, out, "--json"))
    assert again.stderr.splitlines() == ["Trials: 6 of 6"]
    assert json.loads(again.stdout)["cells"] == told["cells"]
    more = RUNNER.invoke(app, command(scene, out, "--seeds", 3, "--quiet"))
    assert more.exit_code == 0
    assert more.stderr == ""
    assert "short" in more.stdout
    assert "checks/plan" in more.stdout


@pytest.mark.long
def test_a_killed_run_goes_on_where_it_was(scene: Path, tmp_path: Path) -> None:
    call = [sys.executable, "-m", "elbowroom", *command(scene, tmp_path, "--seeds", 40, "--queues", "3")]
    with subprocess.Popen(call, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL) as killed:
        try:
            kept = wait_for_trials(tmp_path, 3)
        finally:
            killed.kill()
    (log,) = tmp_path.glob("trials-*.jsonl")
    with log.open("ab") as file:
        file.write(b'{"key":"cut o')
    before = log.read_text().splitlines()
    seeds = 1 + len(before) // 2
    again = RUNNER.invoke(app, command(scene, tmp_path, "--seeds", seeds, "--queues", "3", "--json"))
    assert again.exit_code == 0, again.output
    first = int(again.stderr.split()[1])
    done = [json.loads(line)["key"] for line in before[1:-1]]
    assert kept <= len(done)
    assert first == sum(int(key.split()[-1]) <= seeds for key in done)
    assert log.read_text().splitlines()[: len(before) - 1] == before[:-1]
    keys = [json.loads(line)["key"] for line in log.read_text().splitlines()[1:] if line.endswith("}")]
    assert len(keys) == len(set(keys))
    assert json.loads(again.stdout)["cells"][0]["trials"] == seeds


def wait_for_trials(folder: Path, number: int) -> int:
    """Until that many trials are in the log."""
    for _ in range(1200):
        for log in folder.glob("trials-*.jsonl"):
            trials = log.read_text().count("\n") - 1
            if trials >= number:
                return trials
        time.sleep(0.05)
    raise AssertionError("no trial was finished")


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (["--scenes", "zz"], "zz"),
        (["--planner", "psychic"], "psychic"),
        (["--queues", "3,many"], "many"),
        (["--queues", "1"], "queue size"),
        (["--queues", "4,4"], "queues"),
        (["--seeds", "0"], "seeds"),
        (["--jobs", "0"], "jobs"),
        (["--limit", "-2"], "limit"),
        (["--avatar", "nobody.vrm"], "nobody.vrm"),
    ],
)
def test_a_wrong_call_is_one_line_and_2(arguments: list[str], word: str, tmp_path: Path) -> None:
    result = RUNNER.invoke(app, ["table1", "--out", str(tmp_path / "out"), *arguments])
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.count("\n") == 1, result.stderr
    assert word in result.stderr
    assert not (tmp_path / "out").exists()


def test_help_shows_examples() -> None:
    result = RUNNER.invoke(app, ["table1", "--help"])
    assert result.exit_code == 0
    assert "elbowroom table1" in result.stdout
