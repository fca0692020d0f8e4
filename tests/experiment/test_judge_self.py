"""The judge on a body's own parts: a contact worked out by hand, the natural walk, and the planner's own opinion."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, DofGroup
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.experiment.judge.case import Case
from elbowroom.experiment.judge.ledger import Ledger
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.poses import Poser
from elbowroom.experiment.judge.self_judge import SelfJudge
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import BodyVerdict, judge
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.self_pairs import OVERLAP, self_clearances, self_pairs
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.obstacles import Obstacles
from judged_bodies import random_postures, scene_with

Floats = NDArray[np.float64]
BODY = proportional_humanoid(1.72)
JUDGE = SelfJudge(BODY)


def walking(seconds: float) -> tuple[Floats, Floats]:
    count = round(60 * seconds)
    roots = np.zeros((count, 7))
    roots[:, 1], roots[:, 3], roots[:, 6] = np.arange(count) * 1.1 / 60, 1.1, np.arange(count) * 0.9 / 60
    uppers = natural_walk()(RootPath(0.0, 1 / 60, roots))
    return np.concatenate([roots[:, :3], uppers], axis=1), roots


def judged(q: Floats, roots: Floats) -> BodyVerdict:
    motion = ShownMotion.at_rate(q, roots)
    return judge(motion, BODY, scene_with(Obstacles()), JudgeSettings(mesh=False)).itself


def test_the_natural_walk_does_not_touch_itself() -> None:
    verdict = judged(*walking(2.0))
    assert verdict.touching == 0
    assert verdict.least is not None
    assert verdict.least.clearance > -0.01


def test_a_forearm_laid_across_the_chest_is_found_and_named() -> None:
    q, roots = walking(1.0)
    q[20:40, DofGroup.LEFT_ARM.at] = np.deg2rad([20.0, -30.0, 70.0, 120.0])
    verdict = judged(q, roots)
    assert verdict.touching >= 20 * 4 - 4
    assert {contact.part for contact in verdict.contacts} <= {"leftForearm", "leftHand", "leftUpperArm"}
    assert verdict.deepest > 0.02


@pytest.mark.parametrize("height", [1.3, 1.72, 1.95])
def test_the_planner_looks_at_each_pair_that_the_judge_looks_at_and_allows_no_more(height: float) -> None:
    body = proportional_humanoid(height)
    judged, planned = SelfJudge(body).allowed(), self_pairs(body_model(body))
    radii = body.capsules.radii
    for one, other, limit in zip(planned.first, planned.second, planned.limits, strict=True):
        deepest = judged.pop((min(one, other), max(one, other))) - JudgeSettings().self_tolerance
        spare = limit - radii[one] - radii[other] - deepest
        assert -1e-6 < spare < 4.1e-3  # metres; those of belly and thigh are 4 mm
    assert not judged


def test_judge_and_planner_agree_pose_by_pose() -> None:
    """What the planner's tables call free, coal finds no deeper than the natural walk, and the other way round."""
    rng, count = np.random.default_rng(4), 150
    q, roots = random_postures(rng, count)
    roots[:, 4] = 0.0
    poser, model = Poser(BODY), body_model(BODY)
    posed = poser.world(*poser.local(q, roots), roots[:, :3])
    first = DofGroup.WAIST.at.start
    opinions = self_clearances(model, self_pairs(model), roots, q[:, first:DOF]).min(axis=0)
    agreed = 0
    for n in range(count):
        ledger = Ledger(0.0)
        JUDGE.judge(Case(posed.part(slice(n, n + 1)), np.zeros(1), n, ledger))
        assert ledger.least is not None
        beyond = ledger.least.clearance + OVERLAP
        if min(beyond, float(opinions[n])) < OVERLAP:  # farther apart, the planner measures from its own rim
            assert np.isclose(beyond, opinions[n], atol=8e-3)
            agreed += 1
    assert agreed > 20
