"""What a command writes is called as what it holds, and is no file that the same call reads or writes besides."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from browser_recording import record_walk
from elbowroom import InputError, show
from elbowroom.cli.main import app

RUNNER = CliRunner()
KEPT = b"what somebody has worked on for a week"


@pytest.mark.parametrize(
    ("call", "ending"),
    [
        ("inspect other.glb --plan FILE", ".png"),
        ("inspect other.vrm --pose-sheet FILE", ".png"),
        ("tour empty --targets 1 --no-judge --plan FILE", ".png"),
        ("gauntlet --save 0 FILE", ".json"),
        ("dataset report . -o FILE", ".html"),
    ],
)
def test_no_slip_replaces_a_file_of_another_kind(
    call: str, ending: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "alice.vrm"
    file.write_bytes(KEPT)
    outcome = RUNNER.invoke(app, call.replace("FILE", file.name).split())
    assert outcome.exit_code == 2
    assert outcome.output.startswith("elbowroom: alice.vrm: ")
    assert outcome.output.strip().endswith(f"its name must end with {ending}")
    assert file.read_bytes() == KEPT


@pytest.mark.parametrize(
    "call",
    [
        "tour empty --targets 1 --no-judge --record one.png --plan one.png",
        "tour empty --targets 1 --no-judge --record one.png --plan ./linked.png",
        "gauntlet --bones one.png --save 0 one.png",
        "export --scene one.png -o one.png --overwrite",
        "inspect other.vrm --plan one.png --pose-sheet one.png",
    ],
)
def test_no_file_is_named_twice(call: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "one.png").write_bytes(KEPT)
    (tmp_path / "linked.png").symlink_to("one.png")
    outcome = RUNNER.invoke(app, call.split())
    assert outcome.exit_code == 2
    assert "is named twice in this call" in outcome.output
    assert (tmp_path / "one.png").read_bytes() == KEPT


def test_a_page_does_not_replace_its_recording(tmp_path: Path) -> None:
    file = record_walk(tmp_path / "run.elbow", 2)
    before = file.read_bytes()
    with pytest.raises(InputError, match=r"must end with \.html"):
        show(file).save(file)
    assert file.read_bytes() == before
