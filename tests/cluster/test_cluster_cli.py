"""`--cluster` as a user calls it."""

import json

import pytest
from typer.testing import CliRunner

pytest.importorskip("ray", reason="needs Ray: pip install 'elbowroom[cluster]'")

from elbowroom.cli.main import app


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["gauntlet", "--cluster", "no such"], "neither `local` nor an address"),
        (["table1", "--cluster", "127.0.0.1:1"], "--cluster 127.0.0.1:1: no cluster answers: "),
        (["bench", "cluster", "--workers", "0"], "workers (0,): each is 1 to 256"),
        (["bench", "cluster", "--workers", "x"], "workers 'x': whole numbers"),
    ],
)
def test_wrong_clusters_are_one_line(arguments: list[str], words: str) -> None:
    outcome = CliRunner().invoke(app, [*arguments, "-q"])
    assert outcome.exit_code == 2
    assert words in outcome.stderr
    assert outcome.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--cluster", "no such"], "neither `local` nor an address"),
        (["--cluster", "127.0.0.1:1"], "or give `local`"),
        (["--avatar", "missing.vrm"], "missing.vrm: cannot be read: No such file"),
        (["--scene", "nowhere"], "nowhere"),
        (["--port", "99999"], "--port 99999"),
    ],
)
def test_wrong_calls_of_serve_are_one_line(arguments: list[str], words: str) -> None:
    outcome = CliRunner().invoke(app, ["serve", *arguments])
    assert outcome.exit_code == 2
    assert words in outcome.stderr
    assert outcome.stderr.count("\n") == 1


def test_without_ray_it_is_said_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("elbowroom.cluster.connection.find_spec", lambda name: None)
    outcome = CliRunner().invoke(app, ["gauntlet", "--cluster", "local"])
    assert outcome.exit_code == 2
    assert "pip install 'elbowroom[cluster]'" in outcome.stderr


@pytest.mark.long
def test_the_benchmark_starts_a_cluster_and_ends_it() -> None:
    import ray

    options = ["--workers", "1", "--courses", "2", "--level", "1", "--json", "-q"]
    outcome = CliRunner().invoke(app, ["bench", "cluster", *options])
    report = json.loads(outcome.stdout)
    (crew,) = report["crews"]
    assert crew["workers"] == 1
    assert 0.0 < crew["busy"] <= 1.0
    assert crew["course_seconds"] * 2 <= crew["seconds"]
    assert report["record_bytes"] > 100
    assert not ray.is_initialized()
