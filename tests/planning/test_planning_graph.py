"""Activity graphs: edges, growth, and the way in from a posture that is no vertex."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from elbowroom.body.clips.clip import MotionClip
from elbowroom.body.clips.stock_clips import stock_clips
from elbowroom.body.dof import LOCAL_GROUPS, DofGroup, clamp
from elbowroom.errors import InputError
from elbowroom.planning.paper.activity_graph import ActivityGraph

ARM = DofGroup.LEFT_ARM


def random_graph(seed: int, size: int = 30, radius: float = 0.5, capacity: int = 60) -> ActivityGraph:
    points = np.random.default_rng(seed).normal(0.3, 0.4, (size, ARM.size))
    return ActivityGraph(ARM, points, radius, capacity)


def assert_edges_are_the_near_pairs(graph: ActivityGraph) -> None:
    gaps = np.linalg.norm(graph.vertices[:, None] - graph.vertices, axis=2)
    for v in range(graph.size):
        near = np.flatnonzero(gaps[v] < graph.arrays.radius)
        assert graph.neighbors(v).tolist() == [w for w in near.tolist() if w != v]


@given(st.integers(0, 10_000), st.floats(0.05, 1.5))
@settings(max_examples=40, deadline=None)
def test_edges_join_exactly_the_vertices_within_r(seed: int, radius: float) -> None:
    graph = random_graph(seed, radius=radius)
    assert_edges_are_the_near_pairs(graph)
    for point in np.random.default_rng(seed + 1).normal(0.3, 0.4, (10, ARM.size)):
        graph.insert(clamp(ARM, point))
    assert graph.size == 40
    assert_edges_are_the_near_pairs(graph)


def test_duplicates_are_one_vertex_and_limits_hold() -> None:
    graph = ActivityGraph(
        DofGroup.WAIST, [[0.0] * 3, [0.1, 0.0, 0.0], [0.0] * 3, [9.0, 0.0, 0.0], [8.0, 0.0, 0.0]], 0.3
    )
    assert graph.size == 3
    np.testing.assert_allclose(graph.vertices[2], [np.deg2rad(80.0), 0.0, 0.0])
    assert graph.insert(graph.vertices[1]) == 1
    assert graph.size == 3


def test_a_full_graph_refuses_and_reset_forgets() -> None:
    graph = random_graph(1, size=10, capacity=12)
    first = graph.vertices.copy()
    numbers = [graph.insert(np.full(ARM.size, 0.01 * i)) for i in range(4)]
    assert numbers == [10, 11, -1, -1]
    assert graph.full
    graph.reset()
    np.testing.assert_array_equal(graph.vertices, first)
    assert_edges_are_the_near_pairs(graph)


def test_a_copy_is_independent_and_has_the_first_vertices() -> None:
    graph = random_graph(2)
    graph.insert(np.zeros(ARM.size))
    twin = graph.copy()
    assert twin.size == graph.size - 1
    twin.insert(np.ones(ARM.size))
    np.testing.assert_array_equal(graph.vertices[-1], np.zeros(ARM.size))


def test_a_vertex_is_entered_as_itself() -> None:
    graph = random_graph(3)
    assert graph.enter(graph.vertices[7]) == 7


@given(st.integers(0, 10_000))
@settings(max_examples=60, deadline=None)
def test_from_anywhere_a_way_leads_into_the_graph(seed: int) -> None:
    rng = np.random.default_rng(seed)
    graph = random_graph(seed, radius=float(rng.uniform(0.25, 0.8)))
    start = clamp(ARM, rng.uniform(-1.0, 3.0, ARM.size))
    before = [graph.neighbors(v).tolist() for v in range(graph.size)]
    vertex, steps = graph.enter(start), 0
    np.testing.assert_array_equal(graph.configuration(vertex), start)
    while vertex >= graph.arrays.capacity:
        nearer = graph.neighbors(vertex)
        assert len(nearer) > 0
        moves = np.linalg.norm(graph.arrays.vertices[nearer] - graph.configuration(vertex), axis=1)
        assert np.all(moves < graph.arrays.radius)
        vertex, steps = int(nearer[-1]), steps + 1
    assert steps <= np.ceil(np.linalg.norm(graph.vertices - start, axis=1).min() / (0.9 * graph.arrays.radius)) + 1
    assert [graph.neighbors(v).tolist() for v in range(graph.size)] == before


def test_a_vertex_near_a_visitor_is_linked_to_it_one_way() -> None:
    graph = ActivityGraph(DofGroup.WAIST, [[0.0, 0.0, 0.0]], 0.3)
    visitor = graph.enter([0.2, 0.0, 0.0])
    new = graph.insert([0.3, 0.1, 0.0])
    assert graph.neighbors(visitor).tolist() == [0, new]
    assert graph.neighbors(new).tolist() == []
    assert graph.enter([0.21, 0.0, 0.0]) == visitor


@pytest.mark.parametrize("group", LOCAL_GROUPS)
def test_clips_become_vertices_at_k_equal_times(group: DofGroup) -> None:
    clips = stock_clips(group)
    graph = ActivityGraph.from_clips(clips, 8, 0.5)
    expected = clamp(group, np.concatenate([clip.resample(8) for clip in clips]))
    gaps = np.linalg.norm(expected[:, None] - graph.vertices, axis=2)
    assert gaps.min(axis=1).max() < 1e-6
    assert gaps.min(axis=0).max() < 1e-6
    assert_edges_are_the_near_pairs(graph)


def test_only_accepted_postures_become_vertices() -> None:
    graph = ActivityGraph.from_clips(stock_clips(ARM), 8, 0.5, accept=lambda q: q[:, 0] < 0.5)
    assert graph.vertices[:, 0].max() < 0.5


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        ({"samples_per_clip": 0, "radius": 0.5}, "samples_per_clip"),
        ({"samples_per_clip": 4, "radius": 0.0}, "radius"),
        ({"samples_per_clip": 4, "radius": 0.5, "capacity": 3}, "capacity"),
        ({"samples_per_clip": 4, "radius": 0.5, "capacity": 10**6}, "capacity"),
    ],
)
def test_wrong_settings_are_named(arguments: dict[str, float], word: str) -> None:
    with pytest.raises(InputError, match=word):
        ActivityGraph.from_clips(stock_clips(ARM), **arguments)  # type: ignore[arg-type]


def test_clips_of_two_groups_make_no_graph() -> None:
    mixed: list[MotionClip] = [stock_clips(ARM)[0], stock_clips(DofGroup.RIGHT_ARM)[0]]
    with pytest.raises(InputError, match="one group"):
        ActivityGraph.from_clips(mixed, 4, 0.5)
