"""The exact planner: what it finds is free as playback shows it, it keeps to its plans, and it stops in time."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, LOCAL_GROUPS, DofGroup, columns_of
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.kinematics import body_model, posture_capsules
from elbowroom.body.proportions import proportional_humanoid
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.key_frame_queue import KeyFrameQueue
from elbowroom.planning.command import Command
from elbowroom.planning.exact.planner import ExactPlanner
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.exact.slices import closed_steps, motion_clearances, swept_clearances
from elbowroom.planning.exact.upper_body import UpperBody
from elbowroom.planning.goal import goal_configurations, natural_walk
from elbowroom.planning.limb import pose
from elbowroom.planning.result import PlanStatus
from elbowroom.planning.root_path import RootPath
from elbowroom.world.boxes import Boxes
from elbowroom.world.clearance import clearance
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
FORWARD = Command(forward=1.0)
DT = 1 / 60


@pytest.fixture(scope="module")
def humanoid() -> Humanoid:
    return proportional_humanoid(1.72)


def walk(speed: float = 1.1, horizon: int = 12, phase: float = 0.0) -> RootPath:
    states = np.zeros((horizon + 1, 7))
    time = 0.15 * np.arange(horizon + 1)
    states[:, 1], states[:, 3], states[:, 6] = speed * time, speed, phase + 0.9 * time
    return RootPath(0.0, 0.15, states)


def scene_of(centers: Floats, half_sizes: Floats) -> Scene:
    boxes = Boxes(np.asarray(centers, float), np.tile([0.0, 0, 0, 1], (len(centers), 1)), np.asarray(half_sizes, float))
    names = tuple(f"box {i}" for i in range(len(centers)))
    return replace(Scene.load("empty"), boxes=boxes, box_names=names)


def course(seed: int, count: int = 5) -> Scene:
    """Boxes left and right of a walk along +Z, in the way of the arms, some of the head."""
    rng = np.random.default_rng(seed)
    side = rng.choice([-1.0, 1.0], count)
    centers = np.stack([side * rng.uniform(0.4, 0.7, count), rng.uniform(0.7, 1.7, count), rng.uniform(0.5, 2, count)])
    return scene_of(centers.T, rng.uniform(0.03, 0.15, (count, 3)))


def hanging() -> Floats:
    start: Floats = goal_configurations(natural_walk(), walk(speed=0.0))[0]
    return start


def shown_clearance(humanoid: Humanoid, scene: Scene, path: RootPath, uppers: Floats) -> float:
    """The least clearance of the upper body over all that the queue plays, 240 poses a second, posed in the world."""
    model, queue = body_model(humanoid), KeyFrameQueue(path.horizon, path.interval)
    queue.splice(path, uppers, np.zeros(LOCAL))
    roots, postures = [], []
    while not queue.empty:
        playback = queue.sample()
        roots.append(playback.root)
        postures.append(np.concatenate([playback.root[:3], playback.upper]))
        queue.advance(1 / 240)
    capsules = posture_capsules(model, np.array(postures), np.array(roots))
    chosen = np.concatenate([model.capsules_of(group).indices for group in LOCAL_GROUPS])
    return float(clearance(capsules[chosen], humanoid.capsules.radii[chosen], scene.boxes.table).min())


def test_what_is_found_is_free_as_shown_and_within_the_speed_limits(humanoid: Humanoid) -> None:
    settings = ExactSettings()
    found = 0
    for seed in range(12):
        scene, path = course(seed), walk(phase=0.3 * seed)
        plan = ExactPlanner(humanoid, scene).plan(path, hanging(), np.random.default_rng(0))
        if plan.status is not PlanStatus.FOUND:
            continue
        found += 1
        assert np.array_equal(plan.configurations[0], hanging())
        assert shown_clearance(humanoid, scene, path, plan.configurations) > 0.0
        for group, speed in zip(
            LOCAL_GROUPS, (settings.waist_speed, settings.arm_speed, settings.arm_speed), strict=True
        ):
            steps = np.linalg.norm(np.diff(plan.configurations[:, columns_of(group)], axis=0), axis=1)
            assert np.all(steps <= speed * path.interval + 1e-6)
    assert found >= 8


def test_in_the_open_the_walk_is_natural(humanoid: Humanoid) -> None:
    path = walk()
    start = goal_configurations(natural_walk(), path)[0]
    plan = ExactPlanner(humanoid, Scene.load("empty")).plan(path, start, np.random.default_rng(0))
    assert np.allclose(plan.configurations, plan.goals)
    assert plan.checks < 3 * 200


def test_a_plan_that_is_still_good_is_kept(humanoid: Humanoid) -> None:
    body = UpperBody(humanoid, course(1), ExactSettings())
    first = body.plan(walk(), hanging(), np.zeros(LOCAL)).plan.configurations
    again = body.plan(walk(), hanging(), np.zeros(LOCAL), kept=first).plan.configurations
    assert len(first)
    assert np.allclose(first, again)


def test_batch_tables_equal_one_check_after_the_other(humanoid: Humanoid) -> None:
    body, rng = UpperBody(humanoid, course(2), ExactSettings()), np.random.default_rng(5)
    arm = body.postures(DofGroup.LEFT_ARM, 0.15)
    limb, samples, depths = arm.limb, 8, 2
    centers = rng.uniform(-0.6, 0.6, (depths * samples + 1, 3, 3))
    tables = np.zeros((*centers.shape[:2], 15), np.float32)
    tables[..., :3], tables[..., 3:12], tables[..., 12:] = centers, np.eye(3).ravel(), 0.08
    own = np.ascontiguousarray(rng.permutation(arm.segments.transpose(2, 0, 1))[: 3 * (depths + 1)])
    own = np.ascontiguousarray(own.reshape(depths + 1, 3, *own.shape[1:]).transpose(0, 2, 3, 1))
    swept, _ = swept_clearances(arm.segments, own, limb.radii, tables, samples, 2, arm.reach)
    for depth in range(depths + 1):
        near = [at for at in range(0, len(tables), 2) if abs(at - depth * samples) <= samples // 2]
        each = [clearance(np.concatenate([arm.segments, own[depth]], axis=2), limb.radii, tables[at]) for at in near]
        expected = np.min(each, axis=0)
        close = expected < 0.05  # boxes out of reach are not looked at
        assert np.allclose(swept[depth][close], expected[close], atol=1e-6)
        assert np.all(swept[depth] >= expected - 1e-6)
    everyone, closed = np.ones(len(arm.configurations), np.bool_), np.zeros(len(arm.targets), np.bool_)
    closed_steps(arm, tables[: samples + 1], 0.004, everyone, everyone, closed)
    sources = np.repeat(np.arange(len(arm.configurations)), np.diff(arm.first))
    for k in rng.choice(len(arm.targets), 200):
        a, b = arm.configurations[sources[k]], arm.configurations[arm.targets[k]]
        parts = [(part, at) for part in (2, 4, 6) for at in (part - 1, part, part + 1)]
        row = np.array([a + part / samples * (b - a) for part, _ in parts])
        found = motion_clearances(pose(limb, row), limb.radii, tables[[at for _, at in parts]], arm.reach)
        assert (
            closed[k] == (sources[k] != arm.targets[k] and bool(found.min() < 0.004)) or abs(found.min() - 0.004) < 1e-5
        )


def low_beam() -> Scene:
    """A board from wall to wall at the height of the chest: legs pass, nobody else does, however they bend."""
    return scene_of(np.array([[0.0, 1.35, 2.0]]), np.array([[4.0, 0.5, 0.1]]))


def test_it_stops_before_what_it_cannot_pass_and_walks_on_elsewhere(humanoid: Humanoid) -> None:
    controller = Controller(humanoid, low_beam(), planner="exact", queue_size=5)
    frames = [controller.step(FORWARD, DT) for _ in range(360)]
    assert min(frame.clearance for frame in frames) > 0.0
    assert frames[-1].stuck
    assert np.array_equal(frames[-1].root[3:6], np.zeros(3))
    assert frames[-1].root[1] > 1.0
    speeds = np.array([frame.root[3] for frame in frames])
    assert np.abs(np.diff(speeds)).max() < 3.5 * DT  # it brakes as it always does
    back = [controller.step(Command(forward=-1.0), DT) for _ in range(90)]
    assert back[-1].root[1] < frames[-1].root[1] - 0.4


@pytest.mark.parametrize("queue_size", [3, 7])
def test_scene_d_is_crossed_straight_with_any_queue(humanoid: Humanoid, queue_size: int) -> None:
    scene = Scene.load("d")
    controller = Controller(humanoid, scene, planner="exact", queue_size=queue_size)
    frames: list[Frame] = []
    while not scene.finished(controller.root) and len(frames) < 900:
        frames.append(controller.step(FORWARD, DT))
    assert scene.finished(controller.root)
    assert not any(frame.stuck for frame in frames)
    assert min(frame.clearance for frame in frames) > 0.0
    assert max(len(frame.key_frames.times) for frame in frames) <= queue_size + 1
