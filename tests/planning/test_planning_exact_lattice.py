"""Dynamic programming over a lattice: the same feasibility and the same optimum as trying every way."""

from itertools import pairwise, product

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from elbowroom.planning.exact.lattice import Ban, Lattice, cheapest_way, new_work

STEP, OWN, HORIZON = 0.8, 2, 4


def random_lattice(seed: int, size: int = 3) -> Lattice:
    rng = np.random.default_rng(seed)
    width = int(rng.integers(2, 5))
    postures = rng.uniform(-0.5, 0.5, (size, width))
    near = np.linalg.norm(postures[:, None] - postures, axis=2) <= STEP
    price = rng.uniform(0.0, 1.0, (HORIZON + 1, size + OWN))
    price[rng.random(price.shape) < rng.uniform(0.0, 0.6)] = np.inf
    return Lattice(
        postures=postures,
        first=np.concatenate([[0], np.cumsum(near.sum(axis=1))]).astype(np.int32),
        targets=np.nonzero(near)[1].astype(np.int32),
        own=rng.uniform(-0.5, 0.5, (HORIZON + 1, OWN, width)),
        goals=rng.uniform(-0.3, 0.3, (HORIZON + 1, width)),
        start=rng.uniform(-0.5, 0.5, width),
        price=price,
        closed=rng.random((HORIZON, int(near.sum()))) < rng.choice([0.0, 0.4]),
        like=rng.integers(-1, size, (HORIZON + 1, OWN)).astype(np.int32),
        kept=size,
        step=STEP,
        step_weight=1.5,
    )


def random_ban(seed: int, lattice: Lattice, count: int) -> Ban:
    rng = np.random.default_rng([seed, 1])
    width = len(lattice.start)
    return Ban(
        rng.integers(0, HORIZON, count).astype(np.int32), rng.uniform(-0.5, 0.5, (count, 2 * width)), width * 0.25
    )


def posture(lattice: Lattice, depth: int, node: int) -> np.ndarray:
    size = len(lattice.postures)
    if depth == 0:
        return lattice.start
    row: np.ndarray = lattice.postures[node] if node < size else lattice.own[depth, node - size]
    return row


def is_closed(lattice: Lattice, depth: int, source: int, target: int) -> bool:
    """Whether the step is closed: known as such, or as that between the postures most like its ends."""
    size = len(lattice.postures)
    special = depth == 0 or source >= size
    if special and target >= size:
        return False
    twin = source
    if special:
        twin = int(lattice.like[0, 0]) if depth == 0 else int(lattice.like[depth, source - size])
    aim = int(lattice.like[depth + 1, target - size]) if target >= size else target
    if twin < 0:
        return False
    row = slice(lattice.first[twin], lattice.first[twin + 1])
    return any(lattice.closed[depth, row][lattice.targets[row] == aim])


def step_cost(lattice: Lattice, ban: Ban, depth: int, source: int, target: int) -> float:
    a, b = posture(lattice, depth, source), posture(lattice, depth + 1, target)
    if np.linalg.norm(b - a) > STEP or is_closed(lattice, depth, source, target):
        return np.inf
    keeps = target == lattice.kept and (depth == 0 or source == lattice.kept)
    for at, banned in zip(ban.depths, ban.steps, strict=True):
        if at == depth and np.linalg.norm(banned - np.concatenate([a, b])) <= (1e-9 if keeps else ban.radius):
            return np.inf
    change = (b - lattice.goals[depth + 1]) - (a - lattice.goals[depth])
    return float(lattice.price[depth + 1, target] + lattice.step_weight * change @ change)


def every_way(lattice: Lattice, ban: Ban) -> tuple[int, float]:
    """The deepest depth that has a way, and the least cost of a way to it."""
    total = lattice.price.shape[1]
    costs = {
        (depth, a, b): step_cost(lattice, ban, depth, a, b)
        for depth in range(HORIZON)
        for a in (range(total) if depth else [0])
        for b in range(total)
    }
    for length in range(HORIZON, 0, -1):
        ways = (
            sum(costs[depth, a, b] for depth, (a, b) in enumerate(pairwise((0, *way))))
            for way in product(range(total), repeat=length)
        )
        best = min(ways)
        if np.isfinite(best):
            return length, best
    return 0, 0.0


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 10_000), st.integers(0, 6))
def test_same_feasibility_and_optimum_as_trying_every_way(seed: int, bans: int) -> None:
    lattice = random_lattice(seed)
    ban = random_ban(seed, lattice, bans)
    way = cheapest_way(lattice, ban, new_work(lattice), 0)
    reached, cost = every_way(lattice, ban)
    assert way.reached == reached
    assert np.isclose(way.cost, cost, atol=1e-12)
    assert len(way.path) == reached + 1
    assert np.array_equal(way.path[0], lattice.start)
    assert np.all(np.linalg.norm(np.diff(way.path, axis=0), axis=1) <= STEP + 1e-6)


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 10_000), st.integers(1, 6))
def test_going_on_after_new_bans_equals_beginning_anew(seed: int, bans: int) -> None:
    lattice = random_lattice(seed, size=12)
    ban = random_ban(seed, lattice, bans)
    work = new_work(lattice)
    cheapest_way(lattice, Ban(ban.depths[:0], ban.steps[:0], ban.radius), work, 0)
    resumed = cheapest_way(lattice, ban, work, int(ban.depths.min()))
    anew = cheapest_way(lattice, ban, new_work(lattice), 0)
    if anew.reached >= ban.depths.min():
        assert resumed.reached == anew.reached
        assert resumed.cost == anew.cost
        assert np.array_equal(resumed.path, anew.path)


def test_who_follows_the_goal_pays_nothing() -> None:
    lattice = random_lattice(3)
    own = lattice.own.copy()
    own[:, 1] = lattice.goals
    price = np.ones_like(lattice.price)
    price[:, -1] = 0.0
    lattice = lattice._replace(own=own, price=price, start=lattice.goals[0], closed=np.zeros_like(lattice.closed))
    way = cheapest_way(lattice, random_ban(0, lattice, 0), new_work(lattice), 0)
    assert way.cost < 1e-12
    assert np.allclose(way.path, lattice.goals)
