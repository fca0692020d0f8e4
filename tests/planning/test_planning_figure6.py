"""The search of Figure 6: equal to its naive twin, and the laws that any of its answers must obey."""

from collections.abc import Iterator

import numpy as np
import pytest
from numpy.typing import NDArray

import naive_figure6 as naive
from elbowroom.body.dof import MAX_ELEVATION, DofGroup, limits
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.pose.kinematics import BodyModel, body_model, group_capsules
from elbowroom.planning.model.limb import limb_of
from elbowroom.planning.model.self_contact import clear_of_trunk
from elbowroom.planning.paper import figure6
from elbowroom.planning.paper.activity_graph import ActivityGraph
from elbowroom.planning.paper.roadmap import PosedGraph, Roadmap
from elbowroom.planning.result import PlanStatus, SearchResult
from elbowroom.world.obstacles.clearance import clearance_of
from elbowroom.world.obstacles.obstacles import Obstacles
from shapes import stacked

GROUPS = (DofGroup.WAIST, DofGroup.LEFT_ARM, DofGroup.RIGHT_ARM)


@pytest.fixture(scope="module")
def model() -> BodyModel:
    return body_model(proportional_humanoid(1.72))


class Trial:
    """A random roadmap: vertices that are free or not by lot, real boxes for those that are found on the way."""

    def __init__(self, model: BodyModel, seed: int) -> None:
        rng = np.random.default_rng(seed)
        self.model, self.seed = model, seed
        self.group = GROUPS[seed % 3]
        size, horizon = int(rng.integers(2, 40)), int(rng.integers(1, 7))
        spread = rng.uniform(0.3, 1.0)
        radius = float(rng.uniform(0.15, 0.7))
        capacity = size + int(rng.choice([0, 3, 30]))
        points = rng.normal(0.2, spread, (size, self.group.size))
        self.bounds = limits(self.group)
        if seed % 2 == 0:
            held = int(rng.integers(self.group.size))
            points[:, held] = self.bounds[held] = 0.1
        self.graph = ActivityGraph(self.group, points, radius, capacity, self.bounds)
        self.before = self.graph.size
        self.goals = rng.normal(0.2, spread, (horizon + 1, self.group.size))
        self.margins = rng.uniform(0.0, 0.1, horizon + 1)
        self.obstacles = [self._boxes(rng).standing for _ in range(horizon + 1)]
        start = points[0] if rng.random() < 0.5 else rng.normal(0.2, spread, self.group.size)
        start = np.clip(start, *limits(self.group).T)
        self.limb = limb_of(model, self.group)
        self.roadmap = Roadmap(PosedGraph(self.limb, self.graph), stacked(self.obstacles), start)
        self._draw_validity(rng)
        self.budget = int(rng.choice([10, 100, 1_000, 20_000]))

    def _boxes(self, rng: np.random.Generator) -> Obstacles:
        turns = rng.normal(size=(4, 4))
        turns /= np.linalg.norm(turns, axis=1, keepdims=True)
        return Obstacles.boxes(rng.normal(0.0, 0.4, (4, 3)), turns, rng.uniform(0.02, 0.2, (4, 3)))

    def _draw_validity(self, rng: np.random.Generator) -> None:
        share = rng.uniform(0.1, 1.0)
        shape = self.roadmap.arrays.clearances.shape
        self.roadmap.arrays.clearances[:] = np.where(rng.random(shape) < share, 0.2, rng.choice([-0.1, 0.05], shape))
        self.roadmap.arrays.ready[:] = True
        self.free: NDArray[np.bool_] = self.roadmap.arrays.clearances >= self.margins[:, None]

    def run(self) -> SearchResult:
        return figure6.search(self.roadmap, self.goals, np.random.default_rng(self.seed), self.margins, self.budget)

    def run_naive(self) -> tuple[naive.NaiveResult, naive.NaiveGraph]:
        arrays = self.graph.arrays
        rows = [*range(self.before), *range(arrays.capacity, arrays.capacity + int(arrays.visitors[0]))]
        vertices = {v: tuple(arrays.vertices[v].tolist()) for v in rows}
        chain = {v: v + 1 for v in rows if v >= arrays.capacity and v + 1 in vertices}
        twin = naive.NaiveGraph(vertices, arrays.radius, arrays.capacity, chain)
        chance = naive.Xorshift(int(np.random.default_rng(self.seed).integers(1, 2**63, dtype=np.uint64)))
        elevation = np.inf if self.group is DofGroup.WAIST else MAX_ELEVATION
        bounds = self.bounds.tolist()
        added = set(range(self.before, arrays.capacity))

        def collides(q: naive.Configuration, vertex: int, depth: int) -> bool:
            if vertex < 0 or vertex in added:
                return self.collides(np.array(q), vertex, depth)
            return not self.free[depth, vertex]

        def new_neighbor(q: naive.Configuration) -> naive.Configuration:
            return naive.sample_neighbor(q, arrays.radius, bounds, elevation, chance)

        goals = [tuple(goal) for goal in self.goals.tolist()]
        return naive.search(twin, self.roadmap.source, goals, collides, new_neighbor, self.budget), twin

    def collides(self, q: NDArray[np.float64], vertex: int, depth: int) -> bool:
        segments = group_capsules(self.model, self.group, q[None])
        limb = self.limb
        clearance = clearance_of(segments[:, :, 0], limb.radii, self.obstacles[depth])
        into_trunk = vertex < 0 and not clear_of_trunk(segments, limb.trunk, limb.allowed)[0]
        return clearance < self.margins[depth] or bool(into_trunk)


def trials(model: BodyModel, count: int) -> Iterator[Trial]:
    for seed in range(count):
        yield Trial(model, seed)


def test_equals_the_figure_line_by_line(model: BodyModel) -> None:
    endings = dict.fromkeys(PlanStatus, 0)
    enhanced = 0
    for trial in trials(model, 300):
        expected, twin = trial.run_naive()
        result = trial.run()
        seen = (result.status.name, result.vertices.tolist(), result.checks, result.nodes)
        assert seen == (expected.status, expected.path, expected.checks, expected.nodes), trial.seed
        np.testing.assert_array_equal(trial.graph.vertices, [twin.vertices[v] for v in twin.own()])
        assert result.enhanced == len(twin.own()) - trial.before
        for v in twin.own():
            assert trial.graph.neighbors(v).tolist() == twin.ctn(v)[1:]
        endings[result.status] += 1
        enhanced += result.enhanced
    assert min(endings.values()) > 20, endings
    assert enhanced > 20


def test_a_path_keeps_to_edges_free_nodes_and_time(model: BodyModel) -> None:
    for trial in trials(model, 150):
        result = trial.run()
        assert result.checks <= trial.budget
        if result.status is not PlanStatus.FOUND:
            assert result.path.shape == (0, trial.group.size)
            continue
        assert len(result.vertices) == len(trial.goals)
        assert result.vertices[0] == trial.roadmap.source
        np.testing.assert_array_equal(result.path, trial.graph.arrays.vertices[result.vertices])
        for depth, (a, b) in enumerate(zip(result.vertices[:-1], result.vertices[1:], strict=True), start=1):
            assert a == b or b in trial.graph.neighbors(a)
            assert np.linalg.norm(result.path[depth] - result.path[depth - 1]) < trial.graph.arrays.radius
            assert trial.roadmap.clearance_of(b, depth) >= trial.margins[depth]


def test_exhausted_means_that_there_is_no_path(model: BodyModel) -> None:
    proved = 0
    for trial in trials(model, 300):
        result = trial.run()
        if result.status is PlanStatus.EXHAUSTED and result.enhanced == 0:
            assert not reachable(trial)
            proved += 1
    assert proved > 20


def reachable(trial: Trial) -> bool:
    """Whether any path of full depth exists, by dynamic programming over the depths."""
    level = {trial.roadmap.source}
    for depth in range(1, len(trial.goals)):
        level = {w for v in level for w in [v, *trial.graph.neighbors(v)] if trial.free[depth, w]}
    return bool(level)


@pytest.mark.parametrize("group", GROUPS)
def test_in_free_space_the_path_follows_goals_that_lie_on_the_graph(model: BodyModel, group: DofGroup) -> None:
    rng = np.random.default_rng(3)
    graph = ActivityGraph(group, rng.uniform(0.0, 0.5, (30, group.size)), 0.6)
    walk = [0]
    for _ in range(6):
        walk.append(int(rng.choice([walk[-1], *graph.neighbors(walk[-1])])))
    goals = graph.vertices[walk]
    roadmap = Roadmap(PosedGraph(limb_of(model, group), graph), stacked([Obstacles().standing] * 7), goals[0])
    result = figure6.search(roadmap, goals, rng, np.zeros(7))
    assert result.vertices.tolist() == walk
    assert result.nodes == 7
    assert result.enhanced == 0


def test_equal_seeds_give_equal_searches_and_reset_forgets(model: BodyModel) -> None:
    for trial in trials(model, 40):
        first = trial.run()
        trial.graph.reset()
        assert trial.graph.size == trial.before
        again = Trial(model, trial.seed)
        second = again.run()
        assert (first.status, first.checks, first.nodes) == (second.status, second.checks, second.nodes)
        np.testing.assert_array_equal(first.path, second.path)


def test_a_search_of_no_depth_is_its_source(model: BodyModel) -> None:
    graph = ActivityGraph(DofGroup.WAIST, np.zeros((1, 3)), 0.3)
    roadmap = Roadmap(PosedGraph(limb_of(model, DofGroup.WAIST), graph), stacked([Obstacles().standing]), np.zeros(3))
    result = figure6.search(roadmap, np.zeros((1, 3)), np.random.default_rng(0), np.zeros(1))
    assert (result.status, result.checks, result.nodes) == (PlanStatus.FOUND, 0, 1)
