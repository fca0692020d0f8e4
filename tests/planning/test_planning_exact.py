"""The exact planner: what it finds is free as playback shows it, it keeps to its plans, and it stops in time."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, LOCAL_GROUPS, DofGroup, columns_of
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.body.root import ROOT_STATE
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.key_frame_queue import KeyFrameQueue
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.planning.command import Command
from elbowroom.planning.exact.memory.previous_plan import PreviousPlan, StartState
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.planner import ExactPlanner
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.result import PlanStatus
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
FORWARD = Command(forward=1.0)
DT = 1 / 60


@pytest.fixture(scope="module")
def humanoid() -> Humanoid:
    return proportional_humanoid(1.72)


def walk(speed: float = 1.1, horizon: int = 12, phase: float = 0.0) -> RootPath:
    states = np.zeros((horizon + 1, ROOT_STATE))
    time = 0.15 * np.arange(horizon + 1)
    states[:, 1], states[:, 3], states[:, 6] = speed * time, speed, phase + 0.9 * time
    return RootPath(0.0, 0.15, states)


def scene_of(centers: Floats, half_sizes: Floats) -> Scene:
    boxes = Obstacles.boxes(
        np.asarray(centers, float), np.tile([0.0, 0, 0, 1], (len(centers), 1)), np.asarray(half_sizes, float)
    )
    names = tuple(f"box {i}" for i in range(len(centers)))
    return replace(Scene.load("empty"), obstacles=replace(boxes, standing_names=names))


def course(seed: int, count: int = 5) -> Scene:
    """Boxes left and right of a walk along +Z, in the way of the arms, some of the head."""
    rng = np.random.default_rng(seed)
    side = rng.choice([-1.0, 1.0], count)
    centers = np.stack([side * rng.uniform(0.4, 0.7, count), rng.uniform(0.7, 1.7, count), rng.uniform(0.5, 2, count)])
    return scene_of(centers.T, rng.uniform(0.03, 0.15, (count, 3)))


def hanging() -> Floats:
    start: Floats = natural_walk()(walk(speed=0.0))[0]
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
    return float(clearance(capsules[chosen], humanoid.capsules.radii[chosen], scene.obstacles.standing).min())


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
        for group, speed in zip(LOCAL_GROUPS, (settings.speed_of(group) for group in LOCAL_GROUPS), strict=True):
            steps = np.linalg.norm(np.diff(plan.configurations[:, columns_of(group)], axis=0), axis=1)
            assert np.all(steps <= speed * path.interval + 1e-6)
    assert found >= 8


def test_in_the_open_the_walk_is_natural(humanoid: Humanoid) -> None:
    path = walk()
    start = natural_walk()(path)[0]
    plan = ExactPlanner(humanoid, Scene.load("empty")).plan(path, start, np.random.default_rng(0))
    assert np.allclose(plan.configurations, plan.goals)
    assert plan.checks < 3 * 200


def test_a_plan_that_is_still_good_is_kept(humanoid: Humanoid) -> None:
    body = UpperBodyPlanner(humanoid, course(1), ExactSettings())
    first = body.plan(walk(), StartState(hanging(), np.zeros(LOCAL))).plan.configurations
    again = body.plan(
        walk(), StartState(hanging(), np.zeros(LOCAL)), previous=PreviousPlan.freely(first)
    ).plan.configurations
    assert len(first)
    assert np.allclose(first, again)


def low_beam() -> Scene:
    """A board from wall to wall at the height of the chest: legs pass, nobody else does, however they bend."""
    return scene_of(np.array([[0.0, 1.35, 2.0]]), np.array([[4.0, 0.5, 0.1]]))


def test_it_stops_before_what_it_cannot_pass_and_walks_on_elsewhere(humanoid: Humanoid) -> None:
    controller = Controller(humanoid, low_beam(), planner="exact", ahead=Lookahead(5))
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
    controller = Controller(humanoid, scene, planner="exact", ahead=Lookahead(queue_size))
    frames: list[Frame] = []
    while not scene.finished(controller.root) and len(frames) < 900:
        frames.append(controller.step(FORWARD, DT))
    assert scene.finished(controller.root)
    assert not any(frame.stuck for frame in frames)
    assert min(frame.clearance for frame in frames) > 0.0
    assert max(len(frame.key_frames.times) for frame in frames) <= queue_size + 1


@pytest.mark.parametrize("aside", [-0.1, 0.0, 0.1])
def test_who_stands_bent_where_the_head_has_no_room_to_rise_or_turn_can_stay(aside: float) -> None:
    """The waist does not see what is about the head, and a head that follows it would touch: both stay as they are."""
    stock, root = Humanoid.default(), np.zeros(ROOT_STATE)
    start = hanging()
    start[columns_of(DofGroup.WAIST)], start[columns_of(DofGroup.HEAD)] = (-0.06, 0.0, 0.13), (-0.04, 1.0)

    def scene(above: float, ahead: float) -> Scene:
        centers = np.array([[0.0, above + 0.1, 0.0], [aside, 1.6, ahead + 0.1]])
        return scene_of(centers, np.array([[0.15, 0.1, 0.15], [0.05, 0.1, 0.1]]))

    above, ahead, gaps = 1.7, 0.2, (0.0018, 0.003)
    for _ in range(4):  # to as many metres over the crown and before the face
        above += gaps[0] - BodyCheck(stock, scene(above, 1.0)).clearance(root, start, 0.0)
        ahead += gaps[1] - BodyCheck(stock, scene(2.2, ahead)).clearance(root, start, 0.0)
    path = RootPath(0.0, 0.15, np.tile(root, (17, 1)))
    plan = ExactPlanner(stock, scene(above, ahead)).plan(path, start, np.random.default_rng(0))
    assert plan.status is PlanStatus.FOUND
