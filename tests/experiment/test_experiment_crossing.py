"""The crossing trial: its user, its measures, its repeatability."""

import numpy as np
import pytest

from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.errors import InputError
from elbowroom.experiment.crossing import CrossingResult, controller_for, run_crossing, start_for, warm_up
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.experiment.pacing import is_realtime, late_frames, shown_times
from elbowroom.experiment.scripted_user import BACK, FORWARD, ScriptedUser
from elbowroom.world.scene import Scene

HUMANOID = proportional_humanoid(1.72)
TIMES = {"late_frames", "frame_ms_p99", "frame_ms_worst", "plan_ms_worst", "realtime"}


def cross(scene: str, settings: CrossingSettings) -> CrossingResult:
    return run_crossing(controller_for(HUMANOID, Scene.load(scene), settings), settings)


def without_times(result: CrossingResult) -> dict[str, object]:
    return {key: value for key, value in vars(result).items() if key not in TIMES}


def test_an_empty_floor_is_crossed_straight() -> None:
    result = cross("empty", CrossingSettings(seed=1))
    assert result.passed
    assert result.straight
    assert result.stuck_times == 0
    assert result.plan_success_rate == 1.0
    assert result.least_clearance == np.inf
    assert result.passed_time_s == pytest.approx(result.frames / 60, abs=1e-3)


def test_a_trial_repeats_itself() -> None:
    settings = CrossingSettings(queue_size=4, seed=2, limit=4.0)
    assert without_times(cross("d", settings)) == without_times(cross("d", settings))


def test_a_warm_up_leaves_no_trace() -> None:
    settings = CrossingSettings(queue_size=4, seed=2, limit=3.0)
    controller = controller_for(HUMANOID, Scene.load("c"), settings)
    warm_up(controller)
    assert without_times(run_crossing(controller, settings)) == without_times(cross("c", settings))


def test_the_time_limit_ends_a_trial() -> None:
    result = cross("a", CrossingSettings(limit=0.5))
    assert not result.passed
    assert not result.straight
    assert result.passed_time_s is None
    assert result.frames == 30


def test_the_seed_moves_the_start_a_little() -> None:
    scene = Scene.load("a")
    assert start_for(scene, 0) == scene.start
    starts = [start_for(scene, seed) for seed in range(1, 20)]
    assert len(set(starts)) == len(starts)
    for start in starts:
        assert np.hypot(start.x - scene.start.x, start.z - scene.start.z) <= 0.02
        assert start.heading == scene.start.heading


@pytest.mark.parametrize("limit", [0.0, -1.0, float("nan"), 1e9])
def test_impossible_limits_are_plain_errors(limit: float) -> None:
    with pytest.raises(InputError, match="limit"):
        CrossingSettings(limit=limit)


def test_the_user_backs_up_when_stuck_and_tries_again() -> None:
    user = ScriptedUser(np.random.default_rng(0))
    dt = 1 / 60
    assert all(user.command(False, dt) is FORWARD for _ in range(100))
    patient = [user.command(True, dt) for _ in range(20)]
    assert patient[0] is FORWARD
    backing = [user.command(False, dt) for _ in range(60)]
    assert 0.4 / dt - 2 <= backing.count(BACK) <= 0.9 / dt + 2
    assert backing[-1] is FORWARD


def test_real_time_by_the_papers_criterion() -> None:
    dt = 1 / 60
    smooth = np.full(300, 0.002)
    assert is_realtime(smooth, dt)
    hitch = smooth.copy()
    hitch[100] = 0.8
    assert is_realtime(hitch, dt)
    frozen = smooth.copy()
    frozen[100] = 2.5
    assert not is_realtime(frozen, dt)
    assert not is_realtime(np.full(20, 0.9), dt)
    assert is_realtime(np.zeros(0), dt)


def test_no_frame_later_than_a_frame_time() -> None:
    dt = 1 / 60
    smooth = np.full(300, 0.002)
    assert late_frames(smooth, dt) == 0
    assert late_frames(np.zeros(0), dt) == 0
    hitch = smooth.copy()
    hitch[100] = 0.1
    shown = shown_times(hitch, dt)
    lateness = shown - np.arange(300) * dt
    assert late_frames(hitch, dt) == np.count_nonzero(lateness > dt) > 1
    assert lateness[99] == pytest.approx(0.002)
    assert lateness[-1] == pytest.approx(0.002)
    assert (np.diff(shown) > 0.0).all()
