"""What the judge does not ask the other library: on real walks, clean and touching, it changes nothing that is told."""

from dataclasses import replace
from functools import cache
from typing import Any

import coal
import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.experiment.judge import capsule_judge, mesh_judge, self_judge, stretches
from elbowroom.experiment.judge.capsule_shapes import CapsuleShapes
from elbowroom.experiment.judge.ledger import Ledger, Nearness
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.obstacles import surroundings_of
from elbowroom.experiment.judge.poses import Poser
from elbowroom.experiment.judge.self_judge import SelfJudge
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.stretches import stretches_of
from elbowroom.experiment.judge.verdict import BodyVerdict, Verdict, judge
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from judged_bodies import random_postures
from sampled import sampled

BODY = Humanoid.default()
WALKS = [("c", True), ("c", False), ("traffic", False), ("shapes", True)]  # scene, and whether the planner is at work


@cache
def walked(name: str, assist: bool) -> tuple[ShownMotion, Scene]:
    """The second of a walk in which it comes nearest, and its scene; without a planner it touches."""
    scene = Scene.load(name)
    controller = Controller(BODY, scene, seed=0, assist=assist)
    frames = [controller.step(Command(forward=1.0), 1 / 60) for _ in range(360)]
    nearest = int(np.argmin([frame.clearance for frame in frames]))
    frames = frames[max(nearest - 30, 0) :][:61]
    q, roots = np.stack([frame.q for frame in frames]), np.stack([frame.root for frame in frames])
    return replace(ShownMotion.at_rate(q, roots), clock=np.array([frame.time for frame in frames])), scene


def distance(shapes: CapsuleShapes, capsule: int, place: Any, other: Any, there: Any) -> float:
    return float(
        coal.distance(shapes.shapes[capsule], place, other, there, coal.DistanceRequest(), coal.DistanceResult())
    )


def every_capsule(motion: ShownMotion, scene: Scene) -> Ledger:
    """Each capsule against each obstacle in each pose."""
    ledger, shapes, moments = Ledger(JudgeSettings().capsule_tolerance), CapsuleShapes(BODY), motion.moments(240.0)
    posed = Poser(BODY).at(motion, moments)
    for around in surroundings_of(scene):
        placed = shapes.placed(around.seen(posed, motion.scene_times(moments)))
        for pose, time in enumerate(moments.times.tolist()):
            for capsule, name in enumerate(shapes.names):
                place = shapes.place(placed, pose, capsule)
                for obstacle in around.obstacles:
                    found = distance(shapes, capsule, place, obstacle.shape, obstacle.place)
                    ledger.enter(pose, Nearness(name, obstacle.name, time, found))
    return ledger


def every_pair(motion: ShownMotion) -> Ledger:
    """Each pair of capsules of the body that is looked at in each pose."""
    ledger, shapes, moments = Ledger(JudgeSettings().self_tolerance), CapsuleShapes(BODY), motion.moments(240.0)
    placed, allowed = shapes.placed(Poser(BODY).at(motion, moments)), SelfJudge(BODY).allowed()
    for pose, time in enumerate(moments.times.tolist()):
        places = [shapes.place(placed, pose, capsule) for capsule in range(len(shapes.names))]
        for (one, other), near in allowed.items():
            found = distance(shapes, one, places[one], shapes.shapes[other], places[other]) - near
            ledger.enter(pose, Nearness(shapes.names[one], shapes.names[other], time, found))
    return ledger


def assert_told_the_same(told: BodyVerdict, touching: int, least: Nearness | None, contacts: tuple[Any, ...]) -> None:
    assert told.touching == touching
    assert (told.least is None) == (least is None)
    if told.least is not None and least is not None:
        assert told.least.clearance == pytest.approx(least.clearance, abs=1e-9)
    mine, others = ({(one.part, one.obstacle): one for one in some} for some in (told.contacts, contacts))
    assert {frozenset(key) for key in mine} == {frozenset(key) for key in others}
    if mine.keys() == others.keys():
        for key, one in mine.items():
            assert (one.poses, one.first, one.last) == (others[key].poses, others[key].first, others[key].last)
            assert one.deepest.clearance == pytest.approx(others[key].deepest.clearance, abs=1e-9)


@pytest.mark.parametrize(("name", "assist"), sampled(WALKS))
def test_every_capsule_in_every_pose_is_told_the_same(name: str, assist: bool) -> None:
    motion, scene = walked(name, assist)
    verdict = judge(motion, BODY, scene, JudgeSettings(mesh=False))
    for told, naive in ((verdict.capsules, every_capsule(motion, scene)), (verdict.itself, every_pair(motion))):
        assert_told_the_same(told, len(naive.touching), naive.least, naive.contacts)


@pytest.mark.parametrize(("name", "assist"), sampled(WALKS))
def test_looked_at_pose_by_pose_it_is_told_the_same(name: str, assist: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without stretches, the mesh too."""
    motion, scene = walked(name, assist)
    told = judge(motion, BODY, scene)
    monkeypatch.setattr(stretches, "_LONG", 1)
    for module in (capsule_judge, mesh_judge, self_judge):
        monkeypatch.setattr(module, "_AT_ONCE", 1)
    again = judge(motion, BODY, scene)
    for mine, other in zip(bodies(told), bodies(again), strict=True):
        assert_told_the_same(mine, other.touching, other.least, other.contacts)
    assert assist == (told.capsules.touching == 0)


def bodies(verdict: Verdict) -> tuple[BodyVerdict, ...]:
    assert verdict.mesh is not None
    return verdict.capsules, verdict.itself, verdict.mesh


@pytest.mark.parametrize("seed", range(3))
def test_nothing_moves_farther_in_a_stretch_than_is_told(seed: int) -> None:
    """Points that joints carry, at random postures between two that are as unlike each other as the seed makes them."""
    rng = np.random.default_rng(seed)
    q, roots = random_postures(rng, 21)
    share = np.linspace(0.0, (0.02, 0.2, 1.0)[seed], 21)[:, None]
    motion = ShownMotion.at_rate(*(each[0] + share * (each[1] - each[0]) for each in (q, roots)))
    posed = Poser(BODY).at(motion, motion.moments(60.0))
    some = stretches_of(posed)
    joints = rng.integers(0, posed.positions.shape[1], 40)
    offsets = rng.normal(0.0, 0.3, (40, 3))
    points = posed.positions[:, joints] + np.einsum("njik,jk->nji", posed.rotations[:, joints], offsets)
    away = some.away(joints, np.linalg.norm(offsets, axis=1))
    for k, middle in enumerate(some.middles):
        rows = np.unique(some.rows(np.array([k])))
        assert (np.linalg.norm(points[rows] - points[middle], axis=2) <= away[k]).all()
