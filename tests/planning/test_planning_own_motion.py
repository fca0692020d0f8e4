"""A shown motion against the avatar's own body: what is proven holds at every moment, and is known by its content."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, LOCAL_GROUPS, SEARCH_ORDER, DofGroup, columns_of, limits
from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import HEIGHT, ROOT_STATE
from elbowroom.planning.exact.lattice.tangents import smooth_tangents
from elbowroom.planning.exact.sweep.motion_bounds import configurations_at
from elbowroom.planning.exact.sweep.own_motion import OwnMotion, own_parts, parts_of
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.halving import ENOUGH
from elbowroom.planning.model.footing import Footing
from elbowroom.planning.model.levers import body_levers
from elbowroom.planning.model.self_pairs import self_clearances, self_pairs
from elbowroom.planning.root.path import RootPath
from elbowroom.world.ground.ground import PLAIN
from elbowroom.world.scene import Scene
from sampled import sampled

Floats = NDArray[np.float64]
T, LOOKS, FAR = 0.15, 2000, 99  # seconds, of a key interval; in it; so many key intervals ahead
ASIDE = 1.0  # radians: goals that no key posture is at
ROUNDING = 2e-5  # metres
PROVABLE = 1.5e-3  # metres: what keeps as much is proven

HUMANOID = proportional_humanoid(1.72)
MODEL = body_model(HUMANOID)
PAIRS = self_pairs(MODEL)
PARTS = own_parts(MODEL, PAIRS, body_levers(HUMANOID))
ON_PLANE = Footing(MODEL, PLAIN)
ARMS = np.r_[columns_of(DofGroup.LEFT_ARM), columns_of(DofGroup.RIGHT_ARM)]
LOWERED = columns_of(DofGroup.WAIST).stop - 1
WAIST = SEARCH_ORDER.index(DofGroup.WAIST)


def swung(seed: int, beside: float = 0.5, depth: float = 0.0, horizon: int = 12) -> tuple[RootPath, Floats, Floats]:
    """A walk whose arms swing up to `beside` radians beside the natural way, now and then into the body.

    It goes down and up by as much as `depth` half leg lengths from one key time to the next.
    """
    rng = np.random.default_rng(seed)
    states, times = np.zeros((horizon + 1, 7)), T * np.arange(horizon + 1)
    states[:, 1], states[:, 3], states[:, 6] = 1.1 * times, 1.1, 0.9 * times
    path = RootPath(0.0, T, states)
    keys = natural_walk()(path) + rng.uniform(-beside, beside, (1, LOCAL))
    keys[:, columns_of(DofGroup.WAIST)] = 0.3 * rng.uniform(-1.0, 1.0, 3) * [1.0, 1.0, 0.0]
    keys += rng.uniform(-0.08, 0.08, keys.shape)
    keys[:, LOWERED] += depth * rng.uniform(size=horizon + 1)
    rates = [
        smooth_tangents(
            np.ascontiguousarray(keys[:, columns_of(group)]), T, np.zeros(group.size), limits(group),
            np.zeros(horizon + 1, np.bool_),
        )
        for group in LOCAL_GROUPS
    ]  # fmt: skip
    return path, keys, np.concatenate(rates, axis=1)


def looked_at(path: RootPath, keys: Floats, rates: Floats, k: int, footing: Footing = ON_PLANE) -> Floats:
    """The least gap of each group at many moments of a key interval."""
    shares = np.linspace(0.0, 1.0, LOOKS)
    shown = configurations_at((keys[k], rates[k], keys[k + 1], rates[k + 1]), T, shares)
    roots, _ = footing.stood(path.sample((k + shares) * T))
    gaps: Floats = self_clearances(MODEL, PAIRS, roots, shown).min(axis=1)
    return gaps


@pytest.mark.parametrize(("wild", "depth"), sampled([(0.3, 0.0), (0.0, 0.0), (0.0, 0.6)]))
def test_what_is_proven_is_so_at_every_moment_and_no_contact_is_made_up(wild: float, depth: float) -> None:
    rng, free, touching, near = np.random.default_rng(5), 0, 0, 0
    for seed in range(9):
        path, keys, rates = swung(seed, 0.2, depth)
        keys = keys + rng.uniform(-wild, wild, keys.shape)
        rates = rates + 10.0 * rng.uniform(-wild, wild, rates.shape)
        gaps, groups = OwnMotion(PARTS).proven(path, keys, rates, keys + ASIDE)
        for k in range(path.horizon):
            each = looked_at(path, keys, rates, k)
            assert gaps[k] < ENOUGH or gaps[k] <= each.min() + ROUNDING
            assert gaps[k] >= ENOUGH or each[groups[k]] < PROVABLE
            free, touching = free + (gaps[k] >= ENOUGH), touching + (gaps[k] < ENOUGH)
            near += 0.0 < np.delete(each, WAIST).min() < 0.02  # belly and thighs are, in every stand
    assert min(touching, near) > 5
    assert free > 5 or wild


@pytest.mark.long
def test_legs_are_where_the_ground_has_them_at_every_moment() -> None:
    treads = [{"type": "box", "center": [0.0, 0.1 * n, 0.3 * n], "size": [3.0, 0.2 * n, 0.3]} for n in range(1, 9)]
    footing = Footing(MODEL, Scene.of("stair", treads, finish=(0.0, 3.0)).ground)
    high = touching = 0
    for seed in range(4):
        path, keys, _ = swung(seed)
        states = np.pad(path.states, ((0, 0), (0, ROOT_STATE - 7)))
        states[:, HEIGHT], states[:, HEIGHT + 1] = 0.2 / 0.3 * states[:, 1], 0.2 / 0.3 * states[:, 3]
        path = RootPath(0.0, T, footing.stood(states)[0])
        keys[:, ARMS] = [-1.0, 0.0, 0.0, 0.3, -1.0, 0.0, 0.0, 0.3]
        keys[:, columns_of(DofGroup.WAIST)] = [1.2, 0.0, 0.4]
        gaps, groups = OwnMotion(PARTS, footing.underfoot).proven(path, keys, np.zeros_like(keys), keys + ASIDE)
        for k in range(path.horizon):
            each = looked_at(path, keys, np.zeros_like(keys), k, footing)
            assert gaps[k] < ENOUGH or gaps[k] <= each.min() + ROUNDING
            assert gaps[k] >= ENOUGH or each[groups[k]] < PROVABLE
            touching += gaps[k] < ENOUGH
            high += gaps[k] < looked_at(path, keys, np.zeros_like(keys), k).min() - 0.01
    assert min(high, touching) > 5


def test_where_a_tread_raises_a_thigh_to_an_upright_trunk_a_bent_one_may_come_as_near_and_no_nearer() -> None:
    stout = 0.05  # metres that trunk and thighs keep apart: more than they have upright
    treads = [
        {"type": "box", "center": [0.0, 0.1 * n, 0.25 * n + 0.3], "size": [3.0, 0.2 * n, 0.25]} for n in range(1, 14)
    ]
    footing = Footing(MODEL, Scene.of("stair", treads, finish=(0.0, 4.0)).ground)
    assert not footing.plain
    parts = PARTS._replace(limits=np.where(PARTS.kinds == WAIST, PARTS.limits + np.float32(stout), PARTS.limits))
    path, keys, rates = folded(0.0)
    states = path.states.copy()
    states[:, 1], states[:, 3] = 0.9 + 0.6 * T * np.arange(len(states)), 0.6
    states[:, HEIGHT], states[:, HEIGHT + 1] = 0.8 * (states[:, 1] - 0.3), 0.8 * 0.6
    path = RootPath(0.0, T, footing.stood(states)[0])

    def waist_touches(waist: list[float]) -> NDArray[np.bool_]:
        keys[:, columns_of(DofGroup.WAIST)] = waist
        found: NDArray[np.bool_] = (
            OwnMotion(parts, footing.underfoot).contacts(path, keys, rates, keys + ASIDE, 0) == WAIST
        )
        return found

    assert not waist_touches([0.0, 0.0, 0.0]).any()
    nearest = np.array([looked_at(path, keys, rates, k, footing)[WAIST].min() for k in range(path.horizon)])
    assert np.all(nearest < stout)
    assert waist_touches([1.4, 0.0, 0.5]).all()


def test_far_ahead_no_less_is_asked_for() -> None:
    motion, free, touching = OwnMotion(PARTS), 0, 0
    for seed in range(8):
        path, keys, rates = swung(seed)
        gaps, groups = motion.proven(path, keys, rates, keys + ASIDE)
        soon = motion.contacts(path, keys, rates, keys + ASIDE, -path.horizon)
        afar = motion.contacts(path, keys, rates, keys + ASIDE, FAR)
        assert np.array_equal(soon, np.where(gaps < ENOUGH, groups, -1))
        assert np.all((soon < 0) | (afar == soon))
        free, touching = free + int(np.sum(soon < 0)), touching + int(np.sum(afar >= 0))
    assert min(free, touching) > 5


def folded(lowering: float) -> tuple[RootPath, Floats, Floats]:
    """Who walks bent, turned and lowered, arms aside."""
    states, times = np.zeros((9, ROOT_STATE)), T * np.arange(9)
    states[:, 1], states[:, 3], states[:, 6] = 1.1 * times, 1.1, times
    keys = np.zeros((9, LOCAL))
    keys[:, columns_of(DofGroup.LEFT_ARM)] = keys[:, columns_of(DofGroup.RIGHT_ARM)] = [0.0, 1.2, 0.0, 0.0]
    keys[:, columns_of(DofGroup.WAIST)] = np.deg2rad(80.0), np.deg2rad(45.0), lowering
    return RootPath(0.0, T, states), keys, np.zeros_like(keys)


def test_who_crouches_and_bends_deep_lays_the_trunk_on_the_thighs() -> None:
    humanoid = Humanoid.default()
    model = body_model(humanoid)
    pairs = self_pairs(model)
    parts = own_parts(model, pairs, body_levers(humanoid))
    motion, trunk = OwnMotion(parts), OwnMotion(parts_of(parts, DofGroup.WAIST))
    path, keys, rates = folded(0.7)
    gaps = self_clearances(model, pairs, path.states, keys)
    assert gaps[WAIST].min() < -0.004
    assert np.delete(gaps, WAIST, axis=0).min() > 0.0  # the arms' pairs see nothing of it
    for it in (motion, trunk):
        assert it.contacts(path, keys, rates, keys + ASIDE, 0).max() == WAIST
    assert np.all(trunk.contacts(*folded(0.2), keys + ASIDE, 0) == -1)


def test_what_was_looked_at_is_known_again_and_natural_intervals_are_not_looked_at() -> None:
    path, keys, rates = swung(3)
    motion, goals = OwnMotion(PARTS), keys + ASIDE
    first = motion.contacts(path, keys, rates, goals, FAR)
    assert np.array_equal(motion.contacts(path, keys, rates, goals, FAR), first)
    assert np.all(motion.contacts(path, keys, rates, keys, FAR) == -1)
    later = RootPath(0.0, T, path.states[3:])
    assert np.array_equal(motion.contacts(later, keys[3:], rates[3:], goals[3:], FAR), first[3:])
    touching = int(np.flatnonzero(first >= 0)[-1])
    goals = keys.copy()
    goals[touching + 1, -1] += ASIDE
    beside = np.isin(np.arange(path.horizon), [touching, touching + 1])
    assert np.array_equal(motion.contacts(path, keys, rates, goals, FAR), np.where(beside, first, -1))


def test_a_full_memory_forgets_and_finds_the_same_again() -> None:
    path, keys, rates = swung(4)
    expected = OwnMotion(PARTS).contacts(path, keys, rates, keys + ASIDE, FAR)
    motion = OwnMotion(PARTS, room=5)
    for _ in range(2):
        assert np.array_equal(motion.contacts(path, keys, rates, keys + ASIDE, FAR), expected)
