"""Nodes are looked at where a path leads through them: the paths are those that are found where all are looked at."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.planning.exact.group.problem import GroupPath
from elbowroom.planning.exact.memory.previous_plan import StartState
from elbowroom.planning.exact.plan.upper_body import UpperBodyPlanner
from elbowroom.planning.exact.plan.upper_body_search import Effort, UpperBodySearch
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.root.path import RootPath
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

SETTINGS = ExactSettings()
SEEDS = range(10)
_HORIZON, _BOXES = 8, 24


def cluttered(seed: int) -> Scene:
    """Boxes beside a straight way and over it, some of them in it."""
    rng = np.random.default_rng(seed)
    places = rng.uniform((-0.3, 1.0, 0.2), (0.3, 1.8, 1.8), (_BOXES, 3))
    places[:, 0] += rng.uniform(0.1, 0.45) * np.sign(places[:, 0])
    boxes = Obstacles.boxes(places, np.tile([0.0, 0.0, 0.0, 1.0], (_BOXES, 1)), rng.uniform(0.02, 0.12, (_BOXES, 3)))
    return replace(Scene.load("empty"), obstacles=boxes)


def walk() -> RootPath:
    states, times = np.zeros((_HORIZON + 1, 7)), 0.15 * np.arange(_HORIZON + 1.0)
    states[:, 1], states[:, 3], states[:, 6] = 1.1 * times, 1.1, 0.9 * times
    return RootPath(0.0, 0.15, states)


@pytest.fixture(scope="module")
def searches() -> list[UpperBodySearch]:
    """One of each scene, which has remembered nothing but how its waist is carried."""
    humanoid, path, found = proportional_humanoid(1.72), walk(), []
    start = natural_walk()(path)[0]
    for seed in SEEDS:
        body = UpperBodyPlanner(humanoid, cluttered(seed), SETTINGS)
        found.append(body.plan(path, StartState(start, np.zeros_like(start)), effort=Effort.GLANCE).search)
    return found


def both(search: UpperBodySearch) -> tuple[GroupPath, GroupPath]:
    """The waist's path where all nodes are looked at, and where only those are that need it; by who knows nothing."""
    task = search.problem.task(DofGroup.WAIST, search.problem.roots, np.zeros_like(search._crouching))
    tables = search.caches.group(DofGroup.WAIST).tables
    ways = []
    for whole in (True, False):
        tables.entries.ids[:] = -1
        ways.append(search.evidence_log.search(DofGroup.WAIST, task._replace(whole=whole)))
    return ways[0], ways[1]


def free(cost: NDArray[np.float32]) -> NDArray[np.bool_]:
    return np.isfinite(cost[1:])


def test_the_same_paths_are_found_with_fewer_looks(searches: list[UpperBodySearch]) -> None:
    spared, untouched = 0, 0
    for search in searches:
        whole, some = both(search)
        assert some.reached == whole.reached
        assert (some.cost[1:] <= whole.cost[1:]).all()
        assert some.checks <= whole.checks
        if whole.reached == _HORIZON and whole.rounds == 1:
            np.testing.assert_array_equal(some.keys, whole.keys)
            np.testing.assert_array_equal(some.velocities, whole.velocities)
            untouched += 1
            spared += some.checks < whole.checks
    assert untouched >= 4
    assert spared >= 4


def test_what_was_looked_at_before_changes_nothing(searches: list[UpperBodySearch]) -> None:
    for search in searches:
        task = search.problem.task(DofGroup.WAIST, search.problem.roots, np.zeros_like(search._crouching))
        search.caches.group(DofGroup.WAIST).tables.entries.ids[:] = -1
        first = search.evidence_log.search(DofGroup.WAIST, task)
        search.evidence_log.search(DofGroup.WAIST, task._replace(whole=True))
        again = search.evidence_log.search(DofGroup.WAIST, task)
        np.testing.assert_array_equal(again.keys, first.keys)
        np.testing.assert_array_equal(again.cost, first.cost)
        assert (again.reached, again.nodes, again.rounds) == (first.reached, first.nodes, first.rounds)
        assert again.checks <= first.checks


def test_where_there_is_no_path_all_nodes_have_been_looked_at(searches: list[UpperBodySearch]) -> None:
    blocked = 0
    for search in searches:
        whole, some = both(search)
        if whole.reached < _HORIZON:
            np.testing.assert_array_equal(free(some.cost), free(whole.cost))
            blocked += 1
    assert blocked >= 1


def test_who_knows_which_edges_were_closed_finds_the_same_way_at_once(searches: list[UpperBodySearch]) -> None:
    spared = 0
    for search in searches:
        task = search.problem.task(DofGroup.WAIST, search.problem.roots, np.zeros_like(search._crouching))
        first, closed = search.evidence_log.search_again(DofGroup.WAIST, task, None)
        again, same = search.evidence_log.search_again(DofGroup.WAIST, task, closed)
        if first.reached == _HORIZON:
            np.testing.assert_array_equal(again.keys, first.keys)
            np.testing.assert_array_equal(same.closed, closed.closed)
            assert again.rounds == 1
            spared += first.rounds > 1
    assert spared > 0
