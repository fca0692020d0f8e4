"""The certificate motion: within human limits, and clear of everything in the eyes of another library."""

import numpy as np
import pytest

from elbowroom.body.dof import DofGroup, within_limits
from elbowroom.body.gait.stride import phase_rate
from elbowroom.body.pose.kinematics import body_model, leg_capsules, posture_capsules
from elbowroom.experiment.gauntlet.certificate import RATE
from elbowroom.experiment.gauntlet.course import Course
from elbowroom.experiment.gauntlet.line import walk_along
from elbowroom.experiment.gauntlet.motion import LEFT, RIGHT, WAIST
from elbowroom.experiment.gauntlet.speeds import WALK_SPEED, HumanSpeeds
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.clearance import clearance, pairwise_clearance
from gauntlet_courses import SAMPLE, course, stock
from sampled import sampled

JUDGED = [pytest.param(level, seed, marks=() if level == 3 else pytest.mark.long) for level, seed in SAMPLE if seed < 1]


@pytest.mark.parametrize(("level", "seed"), JUDGED)
def test_the_judge_finds_the_margin(level: int, seed: int) -> None:
    made = course(level, seed)
    proof = made.certificate
    assert 1.0 / RATE <= 1.0 / 240.0
    verdict = judge(
        ShownMotion.at_rate(proof.configurations, proof.roots, RATE), stock()[0], made.scene, JudgeSettings(mesh=False)
    )
    assert verdict.capsules.touching == 0
    least = verdict.capsules.least
    assert least is not None
    assert proof.margin <= least.clearance <= proof.margin + 0.02


@pytest.mark.parametrize(("level", "seed"), sampled(SAMPLE, 3))
def test_the_natural_walk_touches_every_obstacle_in_eight_phases(level: int, seed: int) -> None:
    for phase in np.arange(8) / 8.0:
        assert natural_gaps(course(level, seed), phase).max() < 0.0


@pytest.mark.parametrize(("level", "seed"), SAMPLE)
def test_the_natural_walk_touches_something_in_every_passage_in_any_phase(level: int, seed: int) -> None:
    made = course(level, seed)
    for phase in np.random.default_rng(seed).random(5):
        gaps = natural_gaps(made, phase)
        assert max(gaps[list(group)].min() for group in made.groups) < 0.0


def natural_gaps(made: Course, phase: float) -> np.ndarray:
    """The least gap to each obstacle of the walk that begins in this phase."""
    way = np.arange(0.5, made.line.length, 0.02)
    states = walk_along(made.line, way, WALK_SPEED, phase + phase_rate(WALK_SPEED, 0.0, 0.0) / WALK_SPEED * way)
    uppers = natural_walk()(RootPath(0.0, 1.0, states))
    return np.asarray(gaps_of(made, states, uppers).min(axis=(0, 2)))


def gaps_of(made: Course, states: np.ndarray, uppers: np.ndarray) -> np.ndarray:
    humanoid = stock()[0]
    q = np.concatenate([states[:, :3], uppers], axis=1)
    segments = posture_capsules(body_model(humanoid), q, states)
    return np.asarray(pairwise_clearance(segments, humanoid.capsules.radii, made.scene.obstacles.standing))


@pytest.mark.parametrize(("level", "seed"), SAMPLE)
def test_legs_have_room_in_any_phase(level: int, seed: int) -> None:
    made, model = course(level, seed), body_model(stock()[0])
    way = np.arange(0.0, made.line.length, 0.02)
    for phase in np.linspace(0.0, 1.0, 5, endpoint=False):
        states = walk_along(made.line, way, WALK_SPEED, phase + 0.7 * way)
        gaps = clearance(leg_capsules(model, states), model.roots.radii, made.scene.obstacles.standing)
        assert gaps.min() >= 0.02


@pytest.mark.parametrize(("level", "seed"), SAMPLE)
def test_the_motion_is_human(level: int, seed: int) -> None:
    proof, speeds = course(level, seed).certificate, HumanSpeeds()
    assert within_limits(np.concatenate([proof.roots[:, :3], proof.uppers], axis=1))
    assert 0.8 <= proof.speed <= 1.1
    pace = WALK_SPEED / proof.speed  # the limits hold at full walking speed too
    for columns, fastest, hardest in (
        (WAIST, speeds.waist, speeds.waist_acceleration),
        (LEFT, speeds.arm, speeds.arm_acceleration),
        (RIGHT, speeds.arm, speeds.arm_acceleration),
    ):
        velocity = pace * np.diff(proof.uppers[:, columns], axis=0) * RATE
        assert np.linalg.norm(velocity, axis=1).max() <= fastest
        bends = np.linalg.norm(pace * np.diff(velocity, axis=0) * RATE, axis=1)
        assert np.percentile(bends, 99.5) <= 1.05 * hardest
        assert np.linalg.norm(np.diff(velocity, axis=0), axis=1).max() <= 2.1 * pace * hardest / RATE  # C1


@pytest.mark.parametrize(("level", "seed"), SAMPLE)
def test_the_motion_never_runs_into_itself(level: int, seed: int) -> None:
    proof, check = course(level, seed).certificate, stock()[1].check
    part = slice(None, None, 8)
    assert check.clear(proof.roots[part], proof.uppers[part]).all()


def test_the_motion_begins_as_a_standing_body() -> None:
    for level, seed in SAMPLE:
        proof = course(level, seed).certificate
        assert np.abs(proof.uppers[0]).max() < 0.3
        assert np.array_equal(proof.roots[0], np.zeros(7))
        assert proof.uppers.shape[1] == sum(group.size for group in DofGroup) - 3


def test_a_trunk_that_bends_and_twists_is_found_where_it_is_promised() -> None:
    for level, seed in SAMPLE:
        made = course(level, seed)
        for passage in made.passages:
            k = int(np.argmin(np.abs(made.certificate.way - passage.begin)))
            bend, twist, lowering = made.certificate.uppers[k, WAIST]
            assert lowering == 0.0
            if "bend" in passage.asks and passage.begin - made.passages[0].begin > 0.0:
                assert bend > 0.3
            if passage.asks == "bend, twist, arms":
                assert abs(twist) > 0.1
