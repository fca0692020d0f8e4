"""What the paper's global path goes round: what no posture of the waist gets past, and nothing else."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, DofGroup, followed
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.body.root import RootState
from elbowroom.experiment.crossing import controller_for, run_crossing
from elbowroom.experiment.crossing_settings import CrossingSettings
from elbowroom.planning.command import Command
from elbowroom.planning.paper.local_planner import LocalPlanner
from elbowroom.planning.paper.trunk_places import FARTHEST
from elbowroom.planning.root.plan import RootPlan, RootPlanKind
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.query import Asked
from elbowroom.world.obstacles.clearance import clearance_of
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
HUMANOID = Humanoid.default()


def scene_of(*boxes: tuple[tuple[float, float, float], tuple[float, float, float]]) -> Scene:
    """Upright boxes: centre and half lengths."""
    told = [
        {"type": "box", "center": list(center), "size": [2.0 * half for half in halves]} for center, halves in boxes
    ]
    return Scene.of("made", told, finish=(0.0, 5.0))


CUPBOARD = scene_of(((0.0, 1.6, 2.5), (0.25, 0.5, 0.2)))


def naive_clearance(planner: LocalPlanner, obstacles: Obstacles, place: Floats, facing: float) -> float:
    """The best clearance that any posture of the waist's graph has at a place, of all capsules but legs and arms."""
    model, capsules = body_model(HUMANOID), HUMANOID.capsules
    trunk = [i for i in range(len(capsules.names)) if capsules.groups[i] in (DofGroup.WAIST, DofGroup.HEAD)]
    found = []
    for waist in planner.graph(DofGroup.WAIST).vertices:
        q, root = np.zeros((1, DOF)), np.zeros((1, 7))
        q[0, :3] = root[0, :3] = *place, facing
        q[0, DofGroup.WAIST.at] = waist
        q[:, 3:] = followed(q[:, 3:])
        axes = posture_capsules(model, q, root)[trunk]
        found.append(clearance_of(axes[:, :, 0], capsules.radii[trunk], obstacles.standing))
    return float(min(max(found), FARTHEST))


def test_a_place_is_as_clear_as_its_best_posture() -> None:
    rng, told = np.random.default_rng(4), []
    for _ in range(6):
        centers, halves = rng.uniform([-0.8, 0.9, 2.2], [0.8, 1.8, 3.8], (3, 3)), rng.uniform(0.05, 0.4, (3, 3))
        scene = scene_of(*zip(map(tuple, centers.tolist()), map(tuple, halves.tolist()), strict=True))
        planner = LocalPlanner(HUMANOID, scene)
        places, facing = rng.uniform([-1.0, 2.0], [1.0, 4.0], (8, 2)), float(rng.uniform(-np.pi, np.pi))
        fast = planner.trunk.clearance(places, facing)
        slow = [naive_clearance(planner, scene.obstacles, place, facing) for place in places]
        # a head that follows turns back by the vector of bend and twist, one that is planned by each of them
        np.testing.assert_allclose(fast, slow, atol=1e-2)
        told += slow
    assert min(told) < -0.02 < 0.0 < max(told)
    assert any(0.0 < clear < FARTHEST for clear in told)


def planned(scene: Scene, z: float = 0.0) -> RootPlan:
    """The first root path of the paper's planner, straight on from a place on the way."""
    planner = RootPlanner(HUMANOID, scene, above=LocalPlanner(HUMANOID, scene).trunk)
    start = RootState(0.0, z, 0.0, 1.1, 0.0, 0.0, 0.0)
    return planner.plan(Asked(start, Command(forward=1.0), 5, 0.15))


def test_the_root_goes_round_a_cupboard_that_no_posture_gets_past() -> None:
    heedless = RootPlanner(HUMANOID, CUPBOARD).plan(Asked(RootState(), Command(forward=1.0), 5, 0.15))
    assert heedless.kind is RootPlanKind.STRAIGHT
    assert planned(CUPBOARD).kind is RootPlanKind.DETOUR


def test_before_a_wall_that_hangs_from_side_to_side_it_stops() -> None:
    plan = planned(scene_of(((0.0, 1.6, 2.5), (4.0, 0.5, 0.2))), 1.6)
    assert plan.goal[1] < 2.2
    assert plan.path.states[-1, 1] < 2.2


@pytest.mark.parametrize(
    "box",
    [
        ((0.55, 1.4, 2.0), (0.25, 0.3, 0.1)),  # beside the head, in the way of a shoulder: a twist saves it
        ((0.0, 1.75, 2.0), (2.0, 0.1, 0.1)),  # before the forehead: a bend does
        ((0.45, 0.9, 2.0), (0.2, 0.2, 0.2)),  # in the way of a hand
    ],
)
def test_what_a_twist_or_a_bend_gets_past_diverts_nobody(
    box: tuple[tuple[float, float, float], tuple[float, float, float]],
) -> None:
    assert planned(scene_of(box)).kind is RootPlanKind.STRAIGHT


@pytest.mark.parametrize("name", ["a", "b", "c", "d"])
def test_the_papers_scenes_are_walked_straight_on(name: str) -> None:
    scene = Scene.load(name)
    planner = RootPlanner(HUMANOID, scene, above=LocalPlanner(HUMANOID, scene).trunk)
    start = scene.start
    for step in range(12):
        state = start._replace(
            x=start.x + 0.3 * step * np.sin(start.heading), z=start.z + 0.3 * step * np.cos(start.heading), forward=1.1
        )
        planner.reset()
        plan = planner.plan(Asked(state, Command(forward=1.0), 5, 0.15))
        assert plan.kind is not RootPlanKind.DETOUR


def test_figure6_walks_round_the_cupboard_without_being_stuck() -> None:
    settings = CrossingSettings(planner="figure6", seed=1, limit=15.0)
    result = run_crossing(controller_for(HUMANOID, CUPBOARD, settings), settings)
    assert result.straight
    assert result.collision_checks > result.local_checks + result.frames
