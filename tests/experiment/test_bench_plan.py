"""The planning benchmark makes the calls that a walk makes, and says what they cost."""

import os
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from elbowroom.body.humanoid import Humanoid
from elbowroom.cli.main import app
from elbowroom.errors import InputError
from elbowroom.experiment.bench.plan import CallCosts, PlanCallsReport, amount, lane
from elbowroom.experiment.bench.plan_calls import crossing_calls
from elbowroom.experiment.bench.plots import growth_plots
from elbowroom.experiment.bench.settings import PlanSettings
from elbowroom.world.scene import Scene


def test_calls_walk_to_the_finish() -> None:
    humanoid, scene = Humanoid.default(), Scene.load("b")
    calls = list(crossing_calls(humanoid, scene, 8))
    assert 20 < len(calls) < 400, "the walk did not get to the finish"
    assert all(call.found for call in calls)
    assert all(call.milliseconds > 0.0 and call.waited > 0.0 for call in calls)
    searched = [call for call in calls if call.searched]
    assert 0 < len(searched) < len(calls), "a walk that goes on as planned is not planned at every call"
    assert sum(call.checks for call in searched) > 0
    assert sum(call.checks for call in calls) == sum(call.checks for call in searched)


def test_equal_walks_do_equal_work() -> None:
    humanoid, scene = Humanoid.default(), Scene.load("b")
    first, second = ([call.checks for call in crossing_calls(humanoid, scene, 6, most=12)] for _ in range(2))
    assert first == second


def test_lane_has_its_posts_beside_the_way() -> None:
    scene = lane(10)
    assert len(scene.obstacles) == len(scene.obstacles.standing_names) == 10
    assert np.abs(scene.obstacles.centers[:, 0]).min() > 0.3
    assert len(lane(0).obstacles) == 0


def test_plots_are_svg_documents() -> None:
    costs = CallCosts(3, 2, 0.2, 0.4, 0.5, 0.2, 0.6, 0.3, 100.0, 300, 1.0)
    settings = PlanSettings(rounds=5, horizons=(4, 8), obstacles=(0, 8))
    for picture in growth_plots(PlanCallsReport(settings, costs, costs, (costs,) * 2, (costs,) * 2)).values():
        assert ET.fromstring(picture).tag == "{http://www.w3.org/2000/svg}svg"
    assert costs.worst_to_median_checks == 3.0
    assert amount(settings) == 29


def test_command_refuses_nonsense() -> None:
    with pytest.raises(InputError, match="key frames 1"):
        PlanSettings(key_frames=1)
    with pytest.raises(InputError, match="starts 0"):
        PlanSettings(starts=0)
    result = CliRunner().invoke(app, ["bench", "plan", "--scene", "nowhere", "--json"], standalone_mode=False)
    assert result.return_value == 2
    assert "nowhere" in result.output


def test_a_folder_that_cannot_be_is_told_before_anything_is_measured(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("elbowroom.experiment.bench.plan.run", lambda *_: pytest.fail("it was measured"))
    (tmp_path / "file").touch()
    command = ["bench", "plan", "--plots", str(tmp_path / "file" / "pictures")]
    result = CliRunner().invoke(app, command, standalone_mode=False)
    assert result.return_value == 2
    assert "file is no folder" in result.output


@pytest.mark.parametrize("command", ["plan", "motion"])
def test_a_folder_that_is_not_ours_is_told_at_once(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "access", lambda path, mode: False)  # whoever runs the tests may be allowed everything
    options = ["bench", command, "--plots", str(tmp_path / "pictures")]
    result = CliRunner().invoke(app, options, standalone_mode=False)
    assert result.return_value == 2
    assert "is not yours to write in" in result.output
    assert not (tmp_path / "pictures").exists()
