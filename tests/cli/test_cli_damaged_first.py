"""A damaged file is told before kernels are compiled: nobody waits minutes for a call that cannot be carried out."""

from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from elbowroom.cli.main import app
from elbowroom.server.kernels import compiling, kernel_cache
from elbowroom.server.kernels.warmup import Report

DAMAGED = ("bad.vrm", "bad.glb", "bad.bvh", "bad.json", "bad.elbow")
CALLS = [
    "walk --avatar bad.vrm",
    "walk --bones bad.json",
    "walk --scene bad.json",
    "walk --scene bad.glb",
    "walk --swing bad.bvh",
    "walk --dodge bad.bvh",
    "tour a --avatar bad.vrm",
    "tour bad.glb",
    "tour a --swing bad.bvh",
    "gauntlet --avatar bad.vrm",
    "gauntlet --place bad.glb",
    "table1 --avatar bad.vrm",
    "film bad.elbow -o sheet.png --sheet",
    "film good.elbow -o sheet.png --sheet --avatar bad.vrm",
    "replay good.elbow --avatar bad.vrm",
    "verify good.elbow --avatar bad.vrm",
    "export good.elbow -o run.bvh --avatar bad.vrm",
    "export good.elbow -o run.html --avatar bad.vrm",
    "serve --avatar bad.vrm",
    "bench motion --avatar bad.vrm",
    "bench plan --scene bad.json",
    "bench planners --scene bad.json",
]


def _invoke(call: str) -> Result:
    return CliRunner().invoke(app, call.split())


@pytest.fixture(scope="module")
def walked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recording of a short walk."""
    path = tmp_path_factory.mktemp("walked") / "good.elbow"
    _invoke(f"walk --scene empty --limit 1 --quiet --record {path}")
    return path


@pytest.fixture
def _never_compiled(tmp_path: Path, walked: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A folder with damaged files, on a machine where nothing is compiled yet."""

    def compile_apart(report: Report) -> None:
        pytest.fail("compiles first")

    for name in DAMAGED:
        (tmp_path / name).write_bytes(b"nothing that can be read " * 9)
    (tmp_path / walked.name).write_bytes(walked.read_bytes())
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(kernel_cache, "is_warm", lambda: False)
    monkeypatch.setattr(compiling, "compile_apart", compile_apart)


@pytest.mark.usefixtures("_never_compiled")
@pytest.mark.parametrize("call", CALLS)
def test_damaged_files_are_told_before_anything_is_compiled(call: str) -> None:
    result = _invoke(call)
    assert (result.exit_code, len(result.output.splitlines())) == (2, 1), result.output
    assert "bad." in result.output


@pytest.mark.usefixtures("_never_compiled")
def test_what_is_whole_is_compiled_for() -> None:
    with pytest.raises(pytest.fail.Exception, match="compiles first"):
        CliRunner().invoke(app, ["verify", "good.elbow"], catch_exceptions=False)
