"""The joint step: the same feasibility and the same optimum as trying every way through the product of postures."""

from itertools import pairwise, product

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from elbowroom.planning.exact.joint.bounds import Problem, bounds_of
from elbowroom.planning.exact.joint.product import joint_path
from elbowroom.planning.exact.joint.reachability import reach
from elbowroom.planning.result import PlanStatus

INF = np.float32(np.inf)


def random_problem(seed: int, sizes: tuple[int, int, int] = (2, 3, 3), horizon: int = 3) -> Problem:
    rng = np.random.default_rng(seed)
    closed = rng.uniform(0.0, 0.5)

    def some(*shape: int) -> np.ndarray:
        values = rng.uniform(0.0, 1.0, shape).astype(np.float32)
        values[rng.random(shape) < closed] = INF
        return values

    w, a, b = sizes
    problem = Problem(
        waist=some(horizon + 1, w),
        left=some(horizon + 1, w, a),
        right=some(horizon + 1, w, b),
        waist_edges=some(horizon, w, w),
        left_edges=some(horizon, a, a),
        right_edges=some(horizon, b, b),
        apart=rng.random((horizon + 1, a, b)) > 0.5 * closed,
    )
    problem.waist[0], problem.left[0], problem.right[0] = INF, INF, INF
    problem.waist[0, 0], problem.left[0, 0, 1], problem.right[0, 0, 2] = 0.0, 0.0, 0.0
    problem.apart[0, 1, 2] = True
    return problem


def price(problem: Problem, depth: int, triple: tuple[int, ...]) -> float:
    w, left, right = triple
    if not problem.apart[depth, left, right]:
        return np.inf
    return float(problem.waist[depth, w] + problem.left[depth, w, left] + problem.right[depth, w, right])


def step(problem: Problem, depth: int, a: tuple[int, ...], b: tuple[int, ...]) -> float:
    tables = problem.waist_edges, problem.left_edges, problem.right_edges
    return float(sum(table[depth, i, j] for table, i, j in zip(tables, a, b, strict=True)))


def whole_product(problem: Problem) -> tuple[int, float]:
    """The deepest slice that can be reached, and the cost of the cheapest way to the last; every edge looked at."""
    horizon = len(problem.waist_edges)
    triples = list(product(*(range(table.shape[1]) for table in (problem.waist, problem.apart, problem.right_edges))))
    costs = {t: price(problem, 0, t) for t in triples}
    for depth in range(horizon):
        costs = {
            b: price(problem, depth + 1, b) + min(costs[a] + step(problem, depth, a, b) for a in triples)
            for b in triples
        }
        if not np.isfinite(min(costs.values())):
            return depth, np.inf
    return horizon, min(costs.values())


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 100_000))
def test_same_feasibility_and_optimum_as_the_whole_product(seed: int) -> None:
    problem = random_problem(seed, (2, 3, 3) if seed % 2 else (1, 2, 5))
    way = joint_path(problem)
    reached, cost = whole_product(problem)
    assert (way.status is PlanStatus.FOUND) == np.isfinite(cost)
    if way.status is PlanStatus.FOUND:
        assert np.isclose(way.cost, cost, atol=1e-5)
        nodes = [tuple(row) for row in way.nodes]
        along = price(problem, 0, nodes[0])
        for depth, (a, b) in enumerate(pairwise(nodes)):
            along += step(problem, depth, a, b) + price(problem, depth + 1, b)
        assert np.isclose(along, cost, atol=1e-5)
    else:
        assert reach(problem).depth == reached


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 100_000))
def test_leaving_out_what_cannot_matter_changes_nothing(seed: int) -> None:
    """Larger than the first selection: the widening search against one sweep over everything."""
    problem = random_problem(seed, (11, 30, 27), 5)
    way, (found, cost) = joint_path(problem), _everything(problem)
    assert (way.status is PlanStatus.FOUND) == found
    assert not found or np.isclose(way.cost, cost, atol=1e-5)


def _everything(problem: Problem) -> tuple[bool, float]:
    """Dynamic programming over the whole product as NumPy says it, double precision."""
    costs = np.full((len(problem.waist[0]), *problem.apart[0].shape), np.inf)
    for depth in range(len(problem.waist)):
        prices = (
            problem.waist[depth].astype(np.float64)[:, None, None]
            + problem.left[depth][:, :, None]
            + problem.right[depth][:, None, :]
            + np.where(problem.apart[depth], 0.0, np.inf)
        )
        if depth == 0:
            costs = prices
            continue
        for axis, table in enumerate((problem.waist_edges, problem.left_edges, problem.right_edges)):
            moved = np.moveaxis(costs, axis, -1)
            costs = np.moveaxis((moved[..., None] + table[depth - 1]).min(axis=-2), -1, axis)
        costs = costs + prices
    return bool(np.isfinite(costs).any()), float(costs.min())


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 100_000))
def test_bounds_never_exceed_what_a_path_costs(seed: int) -> None:
    problem = random_problem(seed)
    way = joint_path(problem)
    if way.status is PlanStatus.FOUND:
        for group, through in enumerate(bounds_of(problem).through):
            assert np.all(through[np.arange(len(way.nodes)), way.nodes[:, group]] <= way.cost + 1e-5)


def test_the_budget_ends_a_search() -> None:
    problem = random_problem(3, (11, 30, 27), 5)
    assert joint_path(problem, budget=100).status is PlanStatus.OUT_OF_BUDGET
