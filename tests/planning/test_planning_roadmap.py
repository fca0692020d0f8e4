"""The roadmap's clearances: equal to posing every vertex in the world; trunk contact judged by coal."""

import coal
import numpy as np
import pytest

from elbowroom.body.dof import DOF, LOCAL_GROUPS, DofGroup
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.pose.kinematics import BodyModel, body_model, chest_frames, pelvis_frames, posture_capsules
from elbowroom.geometry import quaternion
from elbowroom.planning.model.frames import compose
from elbowroom.planning.model.limb import limb_of, pose
from elbowroom.planning.model.self_contact import axis_distance, clear_of_trunk
from elbowroom.planning.paper.activity_graph import ActivityGraph
from elbowroom.planning.paper.roadmap import PosedGraph, Roadmap
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.rows import seen_from
from shapes import stacked


@pytest.fixture(scope="module")
def model() -> BodyModel:
    return body_model(proportional_humanoid(1.72))


def random_rotations(rng: np.random.Generator, count: int) -> np.ndarray:
    return quaternion.normalize(rng.normal(size=(count, 4)))


@pytest.mark.parametrize("group", LOCAL_GROUPS)
def test_clearances_are_those_of_the_postures_in_the_world(model: BodyModel, group: DofGroup) -> None:
    rng = np.random.default_rng(5)
    boxes = Obstacles.boxes(
        rng.normal([0, 1, 0], 0.6, (6, 3)), random_rotations(rng, 6), rng.uniform(0.02, 0.3, (6, 3))
    )
    roots = rng.normal(0.0, 0.3, (5, 7))
    waist = rng.uniform([-0.3, -0.7, 0.0], [1.0, 0.7, 0.7], (5, 3))
    graph = ActivityGraph(group, rng.normal(0.2, 0.5, (25, group.size)), 0.5)
    frames = pelvis_frames(model, roots)
    if group is not DofGroup.WAIST:
        frames = compose(*frames, *chest_frames(model, waist))
    start = rng.normal(0.2, 0.5, group.size)
    roadmap = Roadmap(PosedGraph(limb_of(model, group), graph), seen_from(boxes.standing, *frames), start)
    chosen = model.capsules_of(group).indices
    radii = model.capsules_of(group).radii
    for depth in range(5):
        postures = np.zeros((graph.size + 1, DOF))
        postures[:, DofGroup.WAIST.at] = waist[depth]
        postures[:, group.at] = [*graph.vertices, start]
        capsules = posture_capsules(model, postures, np.tile(roots[depth], (graph.size + 1, 1)))[chosen]
        expected = clearance(capsules, radii, boxes.standing)
        np.testing.assert_allclose(roadmap.clearance(depth), expected[:-1], atol=2e-6)
        assert abs(roadmap.clearance_of(roadmap.source, depth) - expected[-1]) < 2e-6


def test_without_boxes_all_is_free(model: BodyModel) -> None:
    graph = ActivityGraph(DofGroup.WAIST, np.zeros((1, 3)), 0.5)
    roadmap = Roadmap(
        PosedGraph(limb_of(model, DofGroup.WAIST), graph), stacked([Obstacles().standing] * 3), np.zeros(3)
    )
    assert roadmap.horizon == 2
    assert np.all(roadmap.clearance(2) == np.inf)


def test_posed_vertices_follow_the_graph_as_it_grows_and_forgets(model: BodyModel) -> None:
    limb = limb_of(model, DofGroup.RIGHT_ARM)
    graph = ActivityGraph(DofGroup.RIGHT_ARM, np.zeros((1, 4)), 0.5)
    posed = PosedGraph(limb, graph)
    for added in ([0.1, 0.2, 0.3, 0.4], [0.4, 0.3, 0.2, 0.1]):
        graph.insert(added)
    np.testing.assert_array_equal(posed.segments, pose(limb, graph.vertices))
    graph.reset()
    np.testing.assert_array_equal(posed.segments, pose(limb, graph.vertices))


def test_other_vertices_after_a_reset_are_posed_anew(model: BodyModel) -> None:
    limb = limb_of(model, DofGroup.WAIST)
    graph = ActivityGraph(DofGroup.WAIST, np.zeros((1, 3)), 0.5)
    posed = PosedGraph(limb, graph)
    graph.insert([0.1, 0.2, 0.3])
    assert posed.segments.shape[2] == 2
    graph.reset()
    graph.insert([0.4, -0.2, 0.1])
    np.testing.assert_array_equal(posed.segments, pose(limb, graph.vertices))


def test_composed_frames_equal_quaternion_algebra() -> None:
    rng = np.random.default_rng(1)
    a, b = random_rotations(rng, 8), random_rotations(rng, 8)
    p, q = rng.normal(size=(8, 3)), rng.normal(size=(8, 3))
    places, turns = compose(p, a, q, b)
    np.testing.assert_allclose(places, p + quaternion.rotate(a, q), atol=1e-12)
    np.testing.assert_allclose(turns, quaternion.multiply(a, b), atol=1e-12)


def coal_distance(first: np.ndarray, second: np.ndarray) -> float:
    request, result = coal.DistanceRequest(), coal.DistanceResult()
    shapes, places = [], []
    for row in (first, second):
        along = row[3:] - row[:3]
        length = float(np.linalg.norm(along))
        shapes.append(coal.Capsule(0.0, length))
        turn = quaternion.to_matrix(quaternion.between([0.0, 0.0, 1.0], along))
        places.append(coal.Transform3s(turn, 0.5 * (row[:3] + row[3:])))
    return float(coal.distance(shapes[0], places[0], shapes[1], places[1], request, result))


def test_axis_distance_agrees_with_coal() -> None:
    rng = np.random.default_rng(2)
    for first, second in rng.normal(size=(200, 2, 6)):
        assert abs(axis_distance(first, second) - max(coal_distance(first, second), 0.0)) < 1e-6


@pytest.mark.parametrize(
    ("first", "second", "distance"),
    [
        ([0, 0, 0, 1, 0, 0], [0, 2, 0, 1, 2, 0], 2.0),  # parallel
        ([0, 0, 0, 1, 0, 0], [3, 0, 0, 5, 0, 0], 2.0),  # on one line
        ([0, 0, 0, 0, 0, 0], [1, 1, 0, 1, 1, 0], np.sqrt(2.0)),  # two points
        ([0, 0, 0, 2, 0, 0], [1, 1, 0, 1, 1, 0], 1.0),  # a point beside an axis
        ([1, 1, 0, 1, 1, 0], [0, 0, 0, 2, 0, 0], 1.0),
        ([0, 0, 0, 2, 0, 0], [1, -1, 0, 1, 1, 0], 0.0),  # crossing
    ],
)
def test_axis_distance_of_special_places(first: list[float], second: list[float], distance: float) -> None:
    assert abs(axis_distance(np.array(first, float), np.array(second, float)) - distance) < 1e-9


@pytest.mark.parametrize("group", [DofGroup.LEFT_ARM, DofGroup.RIGHT_ARM])
def test_an_arm_through_the_chest_is_found(model: BodyModel, group: DofGroup) -> None:
    limb = limb_of(model, group)
    hanging, folded_into_chest = np.zeros(4), np.array([-0.2, 0.0, 1.2, 1.8])
    clear = clear_of_trunk(pose(limb, np.stack([hanging, folded_into_chest])), limb.trunk, limb.allowed)
    assert clear.tolist() == [True, False]


def test_the_waist_has_no_trunk_to_touch(model: BodyModel) -> None:
    limb = limb_of(model, DofGroup.WAIST)
    assert clear_of_trunk(pose(limb, np.zeros((3, 3))), limb.trunk, limb.allowed).all()
