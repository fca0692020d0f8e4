"""The programs in `examples/` run to their end and tell what they should."""

import runpy
import sys
from pathlib import Path

import pytest

from elbowroom.body.stock import stock_avatar_path
from elbowroom.planning import names, planner
from sampled import sampled

EXAMPLES = Path(__file__).parents[1] / "examples"
TOLD = {
    "first_walk": ["nearest obstacle", "Through after"],
    "own_avatar": ["capsules hold its skin", "scene doorway  through"],
    "own_planner": ["c     gestures  through", "beam  gestures  stuck", "beam  exact     through"],
    "own_scene": ["something is near", "Through after"],
    "two_avatars": ["0.5 s", "Both are through"],
}
LONGEST = 60  # lines: an example is read in one go


@pytest.fixture(autouse=True)
def restored_registry(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(names, "_names", list(names.BUILT_IN))
    monkeypatch.setattr(planner, "PLANNERS", dict(planner.PLANNERS))


def run(name: str, monkeypatch: pytest.MonkeyPatch, *arguments: str) -> None:
    monkeypatch.setattr(sys, "argv", [f"{name}.py", *arguments])
    runpy.run_path(str(EXAMPLES / f"{name}.py"), run_name="__main__")


def test_every_example_is_tested_and_short() -> None:
    trained = {"train_on_walks"}  # with PyTorch, in the tests of datasets
    assert {path.stem for path in EXAMPLES.glob("*.py")} == set(TOLD) | trained
    for path in EXAMPLES.glob("*.py"):
        assert len(path.read_text("utf-8").splitlines()) <= LONGEST, path.name


@pytest.mark.parametrize("name", sampled(sorted(TOLD), {*TOLD} - {"two_avatars"}))
def test_example(name: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    run(name, monkeypatch)
    told = capsys.readouterr().out
    for words in TOLD[name]:
        assert words in told


@pytest.mark.long
def test_an_avatars_file_can_be_named(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    run("own_avatar", monkeypatch, str(stock_avatar_path()))
    assert "VRM 1.0" in capsys.readouterr().out


@pytest.mark.long
def test_the_scene_is_kept_in_a_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import elbowroom as er

    run("own_scene", monkeypatch, str(tmp_path / "attic.json"))
    assert "elbowroom play --scene" in capsys.readouterr().out
    assert er.Scene.load(tmp_path / "attic.json").obstacles.moving.names == ("trolley",)
