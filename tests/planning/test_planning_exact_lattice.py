"""Dynamic programming over a lattice: the same feasibility and the same optimum as trying every way."""

from itertools import pairwise, product

import numpy as np
import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.lattice.dynamic_programming import cheapest_path, settle_backward, widen
from elbowroom.planning.exact.lattice.lattice import BACK, EXTRA, HOLD, Lattice, Work, new_work
from elbowroom.planning.exact.lattice.paths import traced
from elbowroom.planning.exact.lattice.postures import BLOCK, Postures, postures_of, spans_of
from elbowroom.planning.model.limb import limb_of

STEP, WEIGHT, HORIZON = 0.8, 1.5, 3
INF = np.float32(np.inf)
SOME = postures_of(limb_of(body_model(Humanoid.default()), DofGroup.WAIST), np.zeros((1, DofGroup.WAIST.size)), STEP)


def with_moves(postures: Postures, moves: NDArray[np.float32]) -> Postures:
    """The same with other edges."""
    return postures._replace(moves=moves, spans=spans_of(moves))


def random_lattice(seed: int, size: int = 3, extras: int = 2, horizon: int = HORIZON) -> Lattice:
    """`size` postures and, at most, `extras` more at each key time."""
    rng = np.random.default_rng(seed)
    width, lanes = int(rng.integers(2, 5)), -(-size // BLOCK) * BLOCK
    postures = rng.uniform(-0.5, 0.5, (size, width))
    postures = postures[np.argsort(postures[:, 0])]
    squares = np.sum((postures[:, None] - postures) ** 2, axis=2)
    moves = np.full((size, lanes), INF, np.float32)
    moves[:, :size] = np.where(squares <= STEP**2, squares, INF)
    cost = rng.uniform(0.0, 1.0, (horizon + 1, lanes + EXTRA)).astype(np.float32)
    cost[rng.random(cost.shape) < rng.uniform(0.0, 0.6)] = INF
    cost[:, size:lanes], cost[:, lanes + extras :] = INF, INF
    closed = rng.random((horizon, lanes + EXTRA, lanes + EXTRA)) < rng.choice([0.0, 0.4])
    columns = np.ascontiguousarray(postures[np.minimum(np.arange(lanes), size - 1)].T, np.float32)
    return Lattice(
        postures=with_moves(
            SOME._replace(configurations=postures, columns=columns, step=STEP), moves.astype(np.float32)
        ),
        extras=rng.uniform(-0.5, 0.5, (horizon + 1, EXTRA, width)),
        goals=rng.uniform(-0.3, 0.3, (horizon + 1, width)),
        cost=cost,
        masks=np.where(rng.random(horizon) < 0.6, np.arange(horizon), -1),
        closed=closed,
        previous=rng.integers(0, size, horizon + 1),
        weight=WEIGHT,
    )


def posture_of(lattice: Lattice, depth: int, node: int) -> NDArray[np.float64]:
    """The configuration (d,) of a node."""
    width, known = lattice.postures.moves.shape[1], lattice.postures.configurations
    posture: NDArray[np.float64] = known[node] if node < width else lattice.extras[depth, node - width]
    return posture


def work_for(lattice: Lattice) -> Work:
    return new_work(*lattice.cost.shape)


def step_price(lattice: Lattice, depth: int, source: int, target: int) -> float:
    """What going from a node to one of the next depth costs, its own price included."""
    a, b = posture_of(lattice, depth, source), posture_of(lattice, depth + 1, target)
    mask = lattice.masks[depth]
    if np.linalg.norm(b - a) > STEP or (mask >= 0 and lattice.closed[mask, source, target]):
        return np.inf
    change = (b - lattice.goals[depth + 1]) - (a - lattice.goals[depth])
    return float(lattice.cost[depth + 1, target] + WEIGHT * change @ change)


def every_way(lattice: Lattice) -> tuple[int, float]:
    """The deepest depth that has a way, and the least cost of a way to it."""
    horizon, size = len(lattice.goals) - 1, len(lattice.postures.configurations)
    nodes = [*range(size), *range(BLOCK, BLOCK + EXTRA)]
    start = BLOCK + HOLD
    costs = {
        (depth, a, b): step_price(lattice, depth, a, b)
        for depth in range(horizon)
        for a in (nodes if depth else [start])
        for b in nodes
    }
    for length in range(horizon, 0, -1):
        ways = product(nodes, repeat=length)
        best = min(sum(costs[t, a, b] for t, (a, b) in enumerate(pairwise((start, *way)))) for way in ways)
        if np.isfinite(best):
            return length, best
    return 0, 0.0


@settings(deadline=None, max_examples=12)
@given(st.integers(0, 10_000))
def test_same_feasibility_and_optimum_as_trying_every_way(seed: int) -> None:
    lattice = random_lattice(seed)
    work = work_for(lattice)
    reached, _ = cheapest_path(lattice, work, 0, False)
    expected, cost = every_way(lattice)
    assert reached == expected
    way = traced(lattice, work, reached)
    if reached:
        assert work.costs[reached].min() == pytest.approx(cost, abs=1e-5)
        paid = sum(step_price(lattice, t, a, b) for t, (a, b) in enumerate(pairwise(way.tolist())))
        assert paid == pytest.approx(cost, abs=1e-5)


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 10_000))
def test_going_on_after_steps_were_closed_equals_beginning_anew(seed: int) -> None:
    lattice = random_lattice(seed, size=40)
    work = work_for(lattice)
    if cheapest_path(lattice, work, 0, False)[0] < HORIZON:
        return
    lattice.masks[1] = 1
    lattice.closed[1] = np.random.default_rng(seed).random(lattice.closed[1].shape) < 0.5
    resumed, _ = cheapest_path(lattice, work, 1, False)
    fresh = work_for(lattice)
    anew, _ = cheapest_path(lattice, fresh, 0, False)
    assert resumed == anew
    assert np.array_equal(traced(lattice, work, anew), traced(lattice, fresh, anew))
    assert work.costs[anew].min() == fresh.costs[anew].min()


@settings(deadline=None, max_examples=20)
@given(st.integers(0, 10_000))
def test_nothing_is_missed_beyond_the_spans_of_steps(seed: int) -> None:
    lattice = random_lattice(seed, size=70, extras=EXTRA, horizon=6)
    near = np.where(lattice.postures.moves <= 0.1, lattice.postures.moves, INF)
    postures = with_moves(lattice.postures, near)
    assert np.ptp(postures.spans, axis=1).min() < near.shape[1]
    found = []
    for spans in (postures.spans, np.tile([0, near.shape[1]], (len(near), 1))):
        work, everywhere = work_for(lattice), lattice._replace(postures=postures._replace(spans=spans))
        reached, _ = cheapest_path(everywhere, work, 0, False)
        settle_backward(everywhere, work, 0, np.inf if reached < 6 else float(work.costs[6].min()) + 0.5)
        found.append((reached, traced(everywhere, work, reached), work.costs[: reached + 1], work.onward))
    for one, other in zip(*found, strict=True):
        assert np.array_equal(one, other)


@exact_kernel
def widened(lattice: Lattice, work: Work) -> int:
    return int(widen(lattice, work))


@settings(deadline=None, max_examples=60)
@given(st.integers(0, 10_000), st.sampled_from([0.02, 0.3, 1.0]))
def test_what_a_glance_finds_is_the_cheapest_way_and_can_be_made_whole(seed: int, dear: float) -> None:
    lattice = random_lattice(seed, size=70, extras=EXTRA, horizon=6)
    lattice = lattice._replace(cost=np.float32(dear) * lattice.cost)
    glanced, whole = work_for(lattice), work_for(lattice)
    reached, _ = cheapest_path(lattice, glanced, 0, True)
    assert reached == cheapest_path(lattice, whole, 0, False)[0]
    assert np.array_equal(traced(lattice, glanced, reached), traced(lattice, whole, reached))
    event(f"all was seen at a glance: {np.array_equal(glanced.costs[: reached + 1], whole.costs[: reached + 1])}")
    widened(lattice, glanced)
    assert np.array_equal(glanced.costs[: reached + 1], whole.costs[: reached + 1])


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 10_000))
def test_costs_from_both_ends_meet(seed: int) -> None:
    lattice = random_lattice(seed, size=40, extras=EXTRA, horizon=6)
    work = work_for(lattice)
    reached, _ = cheapest_path(lattice, work, 0, False)
    if reached < 6:
        return
    best = float(work.costs[6].min())
    settle_backward(lattice, work, 0, best + 1e-3)
    for depth in range(6):
        assert np.min(work.costs[depth] + work.onward[depth]) == pytest.approx(best, abs=2e-5)


def test_who_follows_the_goal_pays_nothing() -> None:
    lattice = random_lattice(3)
    own, cost = lattice.extras.copy(), np.ones_like(lattice.cost)
    own[:, BACK], own[0, HOLD] = lattice.goals, lattice.goals[0]
    cost[:, BLOCK + BACK] = 0.0
    lattice = lattice._replace(extras=own, cost=cost, masks=np.full(HORIZON, -1))
    work = work_for(lattice)
    reached, _ = cheapest_path(lattice, work, 0, False)
    assert reached == HORIZON
    assert work.costs[HORIZON].min() < 1e-6
    assert np.all(traced(lattice, work, reached)[1:] == BLOCK + BACK)
