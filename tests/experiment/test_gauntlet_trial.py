"""Walks through courses: legs are never hindered, who follows the certificate gets through, results add up."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from elbowroom.body.root import RootState
from elbowroom.cli.main import app
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.errors import InputError
from elbowroom.experiment.gauntlet.course import Course, NoCourseError
from elbowroom.experiment.gauntlet.runner import run_gauntlet
from elbowroom.experiment.gauntlet.scenes import course_user
from elbowroom.experiment.gauntlet.settings import GauntletSettings
from elbowroom.experiment.gauntlet.summary import GauntletSummary
from elbowroom.experiment.gauntlet.sweep import STEERING
from elbowroom.experiment.gauntlet.tasks import CourseTask, result_of
from elbowroom.experiment.gauntlet.trial import JudgeFigures, TrialResult, controller_on, walk_course
from elbowroom.experiment.gauntlet.trial_settings import TrialSettings
from elbowroom.experiment.gauntlet.user import CourseUser
from elbowroom.experiment.parallel import Processes
from elbowroom.planning.command import Command
from elbowroom.planning.root.plan import RootPlanKind
from elbowroom.world.obstacles.obstacles import Obstacles
from gauntlet_courses import course, stock
from sampled import sampled

WALKED = [(1, 0), (2, 1), (3, 0), (3, 1), (4, 0), (5, 1), (5, 2)]


def canned_walk(level: int, seed: int) -> tuple[TrialResult, list[Frame]]:
    """The walk of the course's user without any planning of the upper body."""
    made, shown = course(level, seed), []

    def listen(frame: Frame, dt: float) -> None:
        shown.append(frame)

    return walk_course(Controller(stock()[0], made.scene, assist=False), made, listen), shown


@pytest.mark.parametrize(("level", "seed"), sampled(WALKED, [(2, 1), (4, 0), (5, 1)]))
def test_legs_walk_the_line_and_who_does_as_the_certificate_gets_through(level: int, seed: int) -> None:
    made = course(level, seed)
    result, shown = canned_walk(level, seed)
    assert result.crossed
    assert result.touching_frames > 0
    assert not result.stopped
    assert {frame.plan.root.kind for frame in shown if frame.plan is not None} == {RootPlanKind.STRAIGHT}
    check, proof, way = BodyCheck(stock()[0], made.scene), made.certificate, 0.0
    for frame in shown:
        way = made.line.nearest(frame.root[0], frame.root[1], way)
        assert np.hypot(*(frame.root[:2] - made.line.points(way))) < 0.015
        assert abs(frame.root[2] - made.line.heading(way)) <= STEERING
        upper = np.array([np.interp(way, proof.way, column) for column in proof.uppers.T])
        assert check.clearance(frame.root, upper, 0.0) > proof.margin - 0.012


def test_an_empty_course_is_crossed_straight() -> None:
    made = course(3, 0)
    empty = replace(made, scene=replace(made.scene, obstacles=Obstacles()))
    result = walk_course(controller_on(stock()[0], empty, TrialSettings()), empty)
    assert result.crossed
    assert result.straight
    assert result.stuck_times == result.touching_frames == 0
    assert result.seconds < made.line.length / 0.9
    assert len(result.plan_ms) >= 10


def test_a_walk_repeats() -> None:
    made = replace(course(1, 0), limit=9.0)
    first, second = (walk_course(controller_on(stock()[0], made, TrialSettings()), made) for _ in range(2))
    assert replace(first, plan_ms=()) == replace(second, plan_ms=())
    assert first.touching_frames == 0
    assert first.crossed or first.stopped


def result(**changes: object) -> TrialResult:
    fields: dict[str, object] = {
        "level": 1, "seed": 0, "fingerprint": "", "crossed": True, "straight": True, "stuck_times": 0,
        "stopped": False, "touching_frames": 0, "least_clearance": 0.01, "seconds": 9.0, "limit": 40.0, "frames": 540,
        "collision_checks": 10, "plan_ms": (1.0, 2.0, 3.0),
    }  # fmt: skip
    return TrialResult(**{**fields, **changes})  # type: ignore[arg-type]


def test_results_add_up() -> None:
    stuck = result(straight=False, stuck_times=3, least_clearance=0.002, plan_ms=(9.0,))
    failed = result(crossed=False, straight=False, stuck_times=7, stopped=True)
    touched = result(crossed=False, straight=False, touching_frames=5, least_clearance=-0.01)
    total = GauntletSummary.of([result(), stuck, failed, touched])
    assert (total.courses, total.crossed, total.straight, total.stuck, total.stopped) == (4, 2, 1, 2, 1)
    assert (total.touching, total.touching_frames, total.stuck_times, total.frames) == (1, 5, 10, 2160)
    assert total.least_clearance == -0.01
    assert (total.plan_ms_p50, total.plan_ms_max) == (2.0, 9.0)
    assert total.judged_poses is None
    judged = result(judge=JudgeFigures(100, 2, 0.001, -0.001))
    assert GauntletSummary.of([judged, judged]).judged_touching == 4
    assert GauntletSummary.of([judged, result()]).judged_touching is None


def test_a_task_gives_a_record_that_is_its_result() -> None:
    assert CourseTask(2, 5, TrialSettings()).key != CourseTask(2, 6, TrialSettings()).key
    judged = result(judge=JudgeFigures(100, 0, 0.0, None))
    for each in (judged, result()):
        record = {**vars(each), "plan_ms": list(each.plan_ms)}
        record["judge"] = None if each.judge is None else vars(each.judge)
        assert result_of(record) == each


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"level": 7}, "level"),
        ({"level": 1, "courses": 0}, "courses"),
        ({"level": 1, "seed": 2**32 - 5}, "seed"),
        ({"level": 1, "trial": TrialSettings("guess")}, "planner"),
        ({"level": 1, "trial": TrialSettings(queue_size=1)}, "queue size"),
    ],
)
def test_wrong_settings_are_refused(settings: dict[str, int], words: str) -> None:
    with pytest.raises(InputError, match=words):
        GauntletSettings(**settings)  # type: ignore[arg-type]


def test_an_interrupted_run_goes_on(tmp_path: Path) -> None:
    walked: list[int] = []

    class Here(Processes):
        def run(self, tasks: Sequence[Any]) -> Iterator[tuple[int, Any]]:
            for place, task in enumerate(tasks):
                walked.append(task.seed)
                if len(walked) == 3:
                    raise KeyboardInterrupt
                yield place, {**vars(result(seed=task.seed)), "judge": None}

    settings, told = GauntletSettings(level=1, courses=4, seed=10), []
    with pytest.raises(KeyboardInterrupt):
        run_gauntlet(settings, Here(), tmp_path)
    results, _ = run_gauntlet(settings, Here(), tmp_path, progress=lambda done, total: told.append((done, total)))
    assert walked == [10, 11, 12, 12, 13]
    assert told == [(2, 4), (3, 4), (4, 4)]
    assert [each.seed for each in results] == [10, 11, 12, 13]
    assert len(run_gauntlet(replace(settings, judge=True), Here(), tmp_path).results) == 4
    assert walked[5:] == [10, 11, 12, 13]  # other settings, other results


def test_a_seed_without_a_course_is_passed_over(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Maker:
        def course(self, level: int, seed: int) -> Course:
            if seed == 11:
                raise NoCourseError("none")
            return replace(course(level, 0), seed=seed, limit=0.2)

    def run_here(self: Processes, tasks: Sequence[Any]) -> Iterator[tuple[int, Any]]:
        yield from ((place, json.loads(json.dumps(task.run()))) for place, task in enumerate(tasks))

    monkeypatch.setattr("elbowroom.experiment.gauntlet.tasks._maker", lambda avatar: Maker())
    monkeypatch.setattr(Processes, "run", run_here)
    settings = GauntletSettings(level=1, courses=3, seed=10)
    for _ in range(2):  # the second time from the log
        results, without = run_gauntlet(settings, folder=tmp_path)
        assert [each.seed for each in results] == [10, 12]
        assert without == (11,)
    outcome = CliRunner().invoke(
        app, ["gauntlet", "--level", "1", "--courses", "3", "--seed", "10", "--out", str(tmp_path), "--json", "-q"]
    )
    assert outcome.exit_code == 1  # 0.2 s are too short
    report = json.loads(outcome.stdout)
    assert (report["courses"], report["without_course"]) == (2, [11])
    assert "seed 11" in outcome.stderr


@pytest.mark.long
def test_arms_pass_thin_boards_that_hide_between_two_key_times() -> None:
    """Behind them at one key time and before them at the next: whoever steers has no time to search on for long."""
    made = replace(course(5, 7712), limit=3.0)
    result = walk_course(controller_on(stock()[0], made, TrialSettings()), made)
    assert result.stuck_times == 0
    assert result.touching_frames == 0


def test_a_user_steers_by_the_line_s_own_points_and_headings() -> None:
    line, rng = course(3, 5).line, np.random.default_rng(6)
    user, around = CourseUser(line, rng), 0.0
    for way in np.arange(0.0, line.length, 0.02):
        x, z = (line.points(way) + rng.normal(0.0, 0.1, 2)).tolist()
        around = line.nearest(x, z, around)
        beside = line.points(around) - (x, z)
        heading, ahead = line.heading([around, around + 0.3])
        pull = np.clip(-2.0 * (beside[0] * np.cos(heading) - beside[1] * np.sin(heading)), -0.5, 0.5)
        assert user.command(RootState(x, z), False, 1 / 60) == Command(forward=1.0, direction=ahead - pull)


def test_who_walks_a_course_by_its_name_follows_its_line() -> None:
    line, user = course(3, 5).line, course_user("gauntlet:3:5", 0)
    assert user is not None
    for way in np.arange(0.0, line.length - 1.0, 0.2):
        (x, z), heading = line.points(way), float(line.heading(way))
        asked = user(RootState(float(x), float(z), heading=heading), False, 1 / 60)
    assert abs(heading) > 0.2, "this course has no bend"
    assert asked.direction == pytest.approx(heading, abs=0.05)
    assert course_user("a", 0) is None
