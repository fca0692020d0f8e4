"""The local planner: what it finds is free at the key times, judged in the world, group by group."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import ARMS, LOCAL, LOCAL_GROUPS, DofGroup, followed
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.errors import InputError
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.names import planner_names
from elbowroom.planning.paper.local_planner import GroupSettings, LocalPlanner, LocalPlannerSettings
from elbowroom.planning.planner import PLANNERS, make_planner
from elbowroom.planning.result import LocalPlan, PlanStatus
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
PLANNED = (DofGroup.WAIST, *ARMS)  # the head follows the waist


@pytest.fixture(scope="module")
def humanoid() -> Humanoid:
    return proportional_humanoid(1.72)


def walk(z: float = 0.0, speed: float = 1.1, horizon: int = 5, phase: float = 0.0) -> RootPath:
    states = np.zeros((horizon + 1, 7))
    time = 0.2 * np.arange(horizon + 1)
    states[:, 1], states[:, 3], states[:, 6] = z + speed * time, speed, phase + 0.9 * time
    return RootPath(0.0, 0.2, states)


def course(seed: int, count: int = 8) -> Scene:
    """Boxes left and right of a walk along +Z, some of them in the way of arms and head."""
    rng = np.random.default_rng(seed)
    side = rng.choice([-1.0, 1.0], count)
    centers = np.stack([side * rng.uniform(0.35, 0.7, count), rng.uniform(0.7, 1.7, count), rng.uniform(0.5, 4, count)])
    boxes = Obstacles.boxes(centers.T, np.tile([0.0, 0, 0, 1], (count, 1)), rng.uniform(0.03, 0.15, (count, 3)))
    return replace(Scene.load("empty"), obstacles=boxes)


def hanging() -> Floats:
    start: Floats = natural_walk()(walk(speed=0.0))[0]
    return start


def world_clearances(humanoid: Humanoid, scene: Scene, path: RootPath, upper: Floats, groups: list[DofGroup]) -> Floats:
    """The clearance (n+1,) of the capsules of some groups, everything posed in the world."""
    model = body_model(humanoid)
    postures = np.concatenate([np.zeros((len(upper), 3)), upper], axis=1)
    capsules = posture_capsules(model, postures, path.states)
    chosen = np.concatenate([model.capsules_of(group).indices for group in groups])
    return clearance(capsules[chosen], humanoid.capsules.radii[chosen], scene.obstacles.standing).astype(np.float64)


def plans(humanoid: Humanoid, settings: LocalPlannerSettings) -> list[tuple[Scene, RootPath, LocalPlan]]:
    found = []
    for seed in range(20):
        scene = course(seed)
        planner = LocalPlanner(humanoid, scene, settings)
        rng = np.random.default_rng(seed)
        for k in range(6):
            path = walk(z=0.4 * k, phase=0.3 * k, horizon=3 + k % 4)
            found.append((scene, path, planner.plan(path, hanging(), rng)))
    return found


def test_what_is_found_is_free_at_every_key_time_and_bounded_in_speed(humanoid: Humanoid) -> None:
    settings = LocalPlannerSettings()
    statuses = set()
    for scene, path, plan in plans(humanoid, settings):
        statuses.add(plan.status)
        if plan.status is not PlanStatus.FOUND:
            assert plan.configurations.shape == (0, LOCAL)
            assert plan.evidence[-1].status is plan.status
            assert all(group.status is PlanStatus.FOUND for group in plan.evidence[:-1])
            continue
        assert [group.group for group in plan.evidence] == list(PLANNED)
        np.testing.assert_array_equal(followed(plan.configurations), plan.configurations)
        np.testing.assert_array_equal(plan.configurations[0], hanging())
        free = world_clearances(humanoid, scene, path, plan.configurations, list(LOCAL_GROUPS))
        margins = LocalPlanner(humanoid, scene, settings).margins(path)
        assert np.all(free[1:] >= margins[1:] - 1e-5)
        for group in PLANNED:
            part = plan.configurations[:, group.at.start - 3 : group.at.stop - 3]
            assert np.all(np.linalg.norm(np.diff(part, axis=0), axis=1) < settings.of(group).radius)
    assert PlanStatus.FOUND in statuses
    assert len(statuses) > 1


def test_an_arm_evades_a_box_that_the_walk_would_touch(humanoid: Humanoid) -> None:
    box = Obstacles.boxes(np.array([[0.37, 0.85, 1.0]]), np.array([[0.0, 0, 0, 1]]), np.array([[0.1, 0.15, 0.3]]))
    scene = replace(Scene.load("empty"), obstacles=box)
    path = walk(z=0.1)
    plan = LocalPlanner(humanoid, scene).plan(path, hanging(), np.random.default_rng(0))
    touching = world_clearances(humanoid, scene, path, plan.goals, [DofGroup.LEFT_ARM])
    assert touching.min() < 0.0
    assert plan.status is PlanStatus.FOUND
    assert not plan.configurations[:, :3].any()
    assert np.abs(plan.configurations[:, 3:7] - plan.goals[:, 3:7]).max() > 0.3
    assert np.abs(plan.configurations[1:, 7:11] - plan.goals[1:, 7:11]).max() < 0.2


def test_in_free_space_the_natural_walk_is_tracked(humanoid: Humanoid) -> None:
    planner = LocalPlanner(humanoid, Scene.load("empty"))
    for speed in (0.0, 0.4, 0.8, 1.1, 1.4):
        path = walk(speed=speed, horizon=20, phase=0.13)
        start = natural_walk()(path)[0]
        plan = planner.plan(path, start, np.random.default_rng(0))
        assert plan.status is PlanStatus.FOUND
        assert np.linalg.norm(plan.configurations[:, 3:7] - plan.goals[:, 3:7], axis=1).max() < 0.15
        assert plan.nodes == 3 * 21
        assert plan.enhanced == 0
        assert plan.checks < 3 * 20 * 80


def test_a_posture_far_from_the_graph_finds_back(humanoid: Humanoid) -> None:
    planner = LocalPlanner(humanoid, Scene.load("empty"))
    start = hanging()
    start[3:7] = [2.5, 1.0, -1.0, 0.3]
    plan = planner.plan(walk(horizon=25), start, np.random.default_rng(0))
    assert plan.status is PlanStatus.FOUND
    np.testing.assert_array_equal(plan.configurations[0], start)
    assert np.linalg.norm(plan.configurations[-1, 3:7] - plan.goals[-1, 3:7]) < 0.15


def test_a_wall_is_a_failure_of_the_waist(humanoid: Humanoid) -> None:
    wall = Obstacles.boxes(np.array([[0.0, 1.5, 0.5]]), np.array([[0.0, 0, 0, 1]]), np.array([[3.0, 1.0, 0.3]]))
    scene = replace(Scene.load("empty"), obstacles=wall)
    plan = LocalPlanner(humanoid, scene).plan(walk(z=0.4), hanging(), np.random.default_rng(0))
    assert plan.status is PlanStatus.EXHAUSTED
    assert [group.group for group in plan.evidence] == [DofGroup.WAIST]
    assert plan.goals.shape == (6, LOCAL)


def test_the_budget_is_kept_by_every_group(humanoid: Humanoid) -> None:
    settings = LocalPlannerSettings(budget=60)
    outcomes = [plan for _, _, plan in plans(humanoid, settings)]
    assert all(group.checks <= 60 for plan in outcomes for group in plan.evidence)
    assert any(plan.status is PlanStatus.OUT_OF_BUDGET for plan in outcomes)


def test_equal_seeds_repeat_bit_for_bit_after_reset(humanoid: Humanoid) -> None:
    planner = LocalPlanner(humanoid, course(5), LocalPlannerSettings(arm=GroupSettings(3, 0.35)))

    def run() -> list[LocalPlan]:
        rng = np.random.default_rng(7)
        return [planner.plan(walk(z=0.1 * k, horizon=4), hanging(), rng) for k in range(40)]

    first = run()
    planner.reset()
    second = run()
    assert any(plan.enhanced for plan in first)
    for a, b in zip(first, second, strict=True):
        assert (a.status, a.checks, a.nodes, a.enhanced) == (b.status, b.checks, b.nodes, b.enhanced)
        np.testing.assert_array_equal(a.configurations, b.configurations)


def test_graphs_begin_anew_when_they_are_full(humanoid: Humanoid) -> None:
    planner = LocalPlanner(humanoid, course(3))
    graph = planner.graph(DofGroup.LEFT_ARM)
    rng = np.random.default_rng(0)
    while not graph.full:
        graph.insert(rng.uniform(0.0, 1.0, 4))
    planner.plan(walk(), hanging(), rng)
    assert graph.size < graph.arrays.capacity


def test_boxes_out_of_reach_change_nothing(humanoid: Humanoid) -> None:
    near = course(3)
    far = Obstacles.boxes(
        np.concatenate([near.obstacles.centers, [[0.0, 1.0, 40.0], [-30.0, 1.0, 0.0]]]),
        np.concatenate([near.obstacles.rotations, np.tile([0.0, 0, 0, 1], (2, 1))]),
        np.concatenate([near.obstacles.half_sizes, np.ones((2, 3))]),
    )
    results = [
        LocalPlanner(humanoid, scene).plan(walk(z=0.5), hanging(), np.random.default_rng(1))
        for scene in (near, replace(near, obstacles=far))
    ]
    np.testing.assert_array_equal(results[0].configurations, results[1].configurations)
    assert results[0].checks == results[1].checks


def test_margins_grow_with_the_way_between_key_frames(humanoid: Humanoid) -> None:
    settings = LocalPlannerSettings(margin=0.02, margin_of_way=0.5)
    planner = LocalPlanner(humanoid, Scene.load("empty"), settings)
    np.testing.assert_allclose(planner.margins(walk(speed=0.0)), 0.02)
    np.testing.assert_allclose(planner.margins(walk(speed=1.0)), 0.12)
    states = walk(speed=0.0, horizon=3).states.copy()
    states[2:, 0] = 0.1
    np.testing.assert_allclose(planner.margins(RootPath(0.0, 0.2, states)), [0.02, 0.07, 0.07, 0.02])


def test_planners_are_made_by_name(humanoid: Humanoid) -> None:
    assert tuple(PLANNERS) == planner_names()
    plan = make_planner("figure6", humanoid, Scene.load("empty")).plan(walk(), hanging(), np.random.default_rng(0))
    assert plan.status is PlanStatus.FOUND
    with pytest.raises(InputError, match="figure6"):
        make_planner("figure7", humanoid, Scene.load("empty"))
