"""The motion benchmark: scripted walks in the real controller, measured."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from elbowroom.body.gait.stride import feet_standing
from elbowroom.body.humanoid import Humanoid
from elbowroom.cli.main import app
from elbowroom.errors import InputError
from elbowroom.experiment.motion.bands import KNEE_ACCELERATION, KNEE_SPEED
from elbowroom.experiment.motion.gaps import shoulder_width, walls
from elbowroom.experiment.motion.plots import motion_plots
from elbowroom.experiment.motion.report import MotionReport, amount, run
from elbowroom.experiment.motion.scripts import at_speed, scripts, steady
from elbowroom.experiment.motion.settings import SCRIPTED, SPEEDS, MotionSettings
from elbowroom.experiment.motion.walked import walk
from sampled import sampled
from shared_data import SHARED, needs_shared


def test_every_case_of_the_issue_is_walked() -> None:
    cases = {script.case for script in scripts()}
    assert cases == set(SCRIPTED) == {
        "steady", "start", "stop", "turn", "change of direction", "turn in place", "strafe", "back", "circle",
        "there and back", "crouch", "doorway", "slalom", "stair", "ramp", "sill",
    }  # fmt: skip
    assert [script.speed for script in scripts(["steady"])] == list(SPEEDS)


def test_a_steady_walk_is_as_fast_as_it_says() -> None:
    walked = walk(Humanoid.default(), steady(0.8))
    roots = walked.roots[walked.settled()]
    assert roots[:, 3] == pytest.approx(np.full(len(roots), 0.8), abs=1e-6)
    assert np.diff(roots[:, 1]) == pytest.approx(np.full(len(roots) - 1, 0.8 / 60.0), abs=1e-6)


def test_feet_stand_for_as_much_of_a_stride_as_the_walk_says() -> None:
    roots = np.zeros((1000, 7))
    roots[:, 3], roots[:, 6] = 0.8, np.linspace(0.0, 1.0, 1000, endpoint=False)
    standing = feet_standing(1.0, roots)
    assert standing.mean(axis=0) == pytest.approx([0.61, 0.61], abs=0.02)
    assert np.array_equal(standing[:, 1], np.roll(standing[:, 0], 500))
    assert feet_standing(1.0, np.zeros((1, 7))).all()


@pytest.fixture(scope="module")
def report() -> MotionReport:
    """Of natural speeds, a stop and a gap."""
    settings, done = MotionSettings(("steady", "stop", "gaps"), (1.1, 1.4), (1.5,)), list[int]()
    report = run(Humanoid.default(), settings, done.append)
    assert done == list(range(1, amount(settings) + 1))
    return report


def test_hip_knee_and_ankle_go_through_a_stride_as_peoples_do(report: MotionReport) -> None:
    for gait in report.gaits:
        assert gait.curves.inside >= 0.95
        assert max(gait.curves.outside.values()) < 1e-9
        assert min(gait.curves.ankle) > -32.0  # no ballet dancer's
        assert gait.curves.humps == 1


def test_knees_do_not_snap(report: MotionReport) -> None:
    """It was 39,000 degrees/s² at a stop."""
    for found in report.knees.values():
        assert found.speed < KNEE_SPEED
        assert found.acceleration < KNEE_ACCELERATION
        assert found.fastest < 700.0


@needs_shared
@pytest.mark.parametrize("avatar", sampled(["hanim_vrml97/sample1.wrl", "hanim_x3d/KoreanCharacter02Chul.x3d"]))
def test_feet_of_strangers_stand_on_their_soles(avatar: str) -> None:
    """They slid by 34 and 43 mm, and were 56 and 25 mm in the ground."""
    assert SHARED is not None
    feet = run(Humanoid.load(SHARED / "avatars" / avatar), MotionSettings(("steady",), (1.1,), ())).feet["steady"]
    assert feet.as_planned.stances > 10
    assert feet.as_planned.worst < 2.0
    assert feet.by_looks.worst < 2.0
    assert feet.in_ground < 1.0


def test_a_report_has_figures_bands_and_pictures(report: MotionReport) -> None:
    assert set(report.feet) == set(report.knees) == {"steady", "stop"}
    assert [gait.speed for gait in report.gaits] == [1.1, 1.4]
    assert report.feet["steady"].as_planned.stances > 10
    assert report.narrow is not None
    assert report.narrow.passages[0].passed
    assert report.cost.each_of_many > 0.0
    names = [band.name for band in report.bands()]
    assert len(names) == len(set(names))
    for joint, picture in motion_plots(report).items():
        assert joint in picture
        assert picture.count("<polyline") == 2


def test_a_gap_is_as_wide_as_it_says() -> None:
    boxes = list(walls(0.6).obstacles)
    inner = [abs(center[0]) - 0.5 * shape.size[0] for _, shape, center, _ in boxes]  # type: ignore[union-attr]
    assert inner == pytest.approx([0.3, 0.3])
    assert shoulder_width(Humanoid.default()) == pytest.approx(0.45, abs=0.01)


@pytest.mark.long
def test_the_command_prints_one_object_and_draws(tmp_path: Path) -> None:
    arguments = ["bench", "motion", "--case", "steady", "--speeds", "1.1", "--json", "--plots", str(tmp_path), "-q"]
    result = CliRunner().invoke(app, arguments)
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    assert found["gaits"][0]["speed"] == 1.1
    assert {path.name for path in tmp_path.iterdir()} == {"motion_hip.svg", "motion_knee.svg", "motion_ankle.svg"}


def test_nonsense_is_refused() -> None:
    for settings in ({"cases": ("hop",)}, {"speeds": (9.0,)}, {"ratios": (0.0,)}):
        with pytest.raises(InputError):
            MotionSettings(**settings)
    with pytest.raises(InputError):
        at_speed(0.0)
    result = CliRunner().invoke(app, ["bench", "motion", "--speeds", "fast"], standalone_mode=False)
    assert result.return_value == 2
