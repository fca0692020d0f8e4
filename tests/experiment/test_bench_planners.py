"""The general planner's problem is the crossing, and the comparison judges what it shows."""

from dataclasses import replace

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.errors import InputError
from elbowroom.experiment.bench.general import GeneralPlan, plan_generally
from elbowroom.experiment.bench.general_problem import CrossingProblem, crossing_problem
from elbowroom.experiment.bench.planners import amount, run
from elbowroom.experiment.bench.settings import PlannersSettings
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.experiment.parallel import Processes
from elbowroom.planning.planner import PLANNERS
from elbowroom.world.scene import Scene


@pytest.fixture(scope="module")
def problem() -> CrossingProblem:
    return crossing_problem(Humanoid.default(), Scene.load("d"))


def test_walk_leads_straight_past_the_finish(problem: CrossingProblem) -> None:
    scene, states = problem.scene, problem.path.states
    assert scene.finish.passed(*states[-1, :2])
    assert not scene.finish.passed(*states[-2, :2])
    steps = np.linalg.norm(np.diff(states[8:, :2], axis=0), axis=1)
    np.testing.assert_allclose(steps, steps[0], rtol=1e-9)
    assert np.ptp(states[:, 2]) < 1e-9


def test_ends_are_free_and_the_natural_walk_between_them_is_not(problem: CrossingProblem) -> None:
    assert problem.is_free(problem.start[None])
    assert problem.is_free(problem.goal[None])
    assert problem.is_slow_enough(problem.start, problem.goal)
    assert not problem.is_free(problem.sampled(problem.start, problem.goal))


def test_motion_goes_forward_in_time_and_no_faster_than_people(problem: CrossingProblem) -> None:
    a = problem.start.copy()
    b = a.copy()
    assert not problem.is_slow_enough(a, b)
    b[-1] += 0.5
    assert problem.is_slow_enough(a, b)
    assert not problem.is_slow_enough(b, a)
    at, speed = problem.speeds[1]
    b[at.start] += 0.99 * speed * 0.5
    assert problem.is_slow_enough(a, b)
    b[at.start] += 0.02 * speed * 0.5
    assert not problem.is_slow_enough(a, b)


@pytest.mark.long
def test_general_planner_finds_a_motion_that_the_judge_finds_free() -> None:
    pytest.importorskip("ompl", reason="OMPL is not installed")
    humanoid, scene = Humanoid.default(), Scene.load("b")
    plan = plan_generally(humanoid, scene, 20.0, 1)
    assert plan.found
    assert plan.motions > 0
    problem = crossing_problem(humanoid, scene)
    np.testing.assert_allclose(plan.states[[0, -1]], [problem.start, problem.goal], atol=1e-9)
    assert all(problem.is_slow_enough(a, b) for a, b in zip(plan.states, plan.states[1:], strict=False))
    verdict = judge(plan.shown(problem), humanoid, scene, JudgeSettings(rate=60.0, mesh=False))
    assert verdict.capsules.touching == 0


def test_nothing_found_is_no_plan() -> None:
    assert not GeneralPlan(np.empty((0, 11)), 1.0, 5).found


def test_a_finish_that_nobody_passes_straight_ahead_is_refused() -> None:
    scene = Scene.load("a")
    aside = replace(scene, finish=replace(scene.finish, position=(50.0, 5.0)))
    with pytest.raises(InputError, match="does not pass the finish"):
        crossing_problem(Humanoid.default(), aside)


def test_settings_say_how_many_runs_there_are_and_refuse_nonsense() -> None:
    assert amount(PlannersSettings(scenes=("a", "b"), levels=(1,), trials=2)) == 18
    with pytest.raises(InputError, match="trials"):
        PlannersSettings(trials=0)


@pytest.mark.long
def test_runs_are_tasks_in_the_order_of_the_crossings() -> None:
    pytest.importorskip("ompl", reason="OMPL is not installed")
    told: list[int] = []
    report = run(PlannersSettings(("b",), (1,), trials=1, limit=3.0), told.append, Processes(2))
    assert [(where, planner) for where, planner, _ in report.cells()] == [
        (where, planner) for where in ("scene b", "level 1") for planner in (*PLANNERS, "rrt-connect")
    ]
    assert told == [1, 2, 3, 4, 5, 6]
    assert [run.touching for run in report.runs if run.planner == "exact"] == [0, 0]
