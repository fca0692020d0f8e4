"""A shown motion against the avatar's own body: what a close look finds is found, and known again by its content."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, LOCAL_GROUPS, DofGroup, columns_of, limits
from elbowroom.body.kinematics import body_model
from elbowroom.body.proportions import proportional_humanoid
from elbowroom.jit import exact_kernel
from elbowroom.planning.exact.lattice.tangents import smooth_tangents
from elbowroom.planning.exact.sweep import own_motion
from elbowroom.planning.exact.sweep.own_motion import OwnMotion, own_parts
from elbowroom.planning.exact.sweep.own_samples import CLEAR, MOMENTS, NEAR, STEPS, OwnParts, least_gaps
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.interpolation import hermite
from elbowroom.planning.model.self_pairs import self_clearances, self_pairs
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]
Floats32 = NDArray[np.float32]
Indices = NDArray[np.int64]
T, LOOKS, FAR = 0.15, 500, 99  # seconds, of a key interval; so many key intervals ahead
ASIDE = 1.0  # radians: goals that no key posture is at

MODEL = body_model(proportional_humanoid(1.72))
PAIRS = self_pairs(MODEL)


def swung(seed: int, horizon: int = 12) -> tuple[RootPath, Floats, Floats]:
    """A walk whose arms swing up to 0.5 rad beside the natural way, now and then into the body."""
    rng = np.random.default_rng(seed)
    states, times = np.zeros((horizon + 1, 7)), T * np.arange(horizon + 1)
    states[:, 1], states[:, 3], states[:, 6] = 1.1 * times, 1.1, 0.9 * times
    path = RootPath(0.0, T, states)
    keys = natural_walk()(path) + rng.uniform(-0.5, 0.5, (1, LOCAL))
    keys[:, columns_of(DofGroup.WAIST)] = 0.3 * rng.uniform(-1.0, 1.0, 3) * [1.0, 1.0, 0.0]
    keys += rng.uniform(-0.08, 0.08, keys.shape)
    rates = [
        smooth_tangents(
            np.ascontiguousarray(keys[:, columns_of(group)]), T, np.zeros(group.size), limits(group),
            np.zeros(horizon + 1, np.bool_),
        )
        for group in LOCAL_GROUPS
    ]  # fmt: skip
    return path, keys, np.concatenate(rates, axis=1)


def least_of_looks(path: RootPath, keys: Floats, rates: Floats, k: int, times: Floats) -> Floats:
    """The least gap of each kind (3,) at some times (N,) of a key interval."""
    shown = [hermite(np.array([0.0, T]), keys[k : k + 2], rates[k : k + 2], float(t))[0] for t in times]
    gaps: Floats = self_clearances(MODEL, PAIRS, path.sample(k * T + times), np.array(shown)).min(axis=1)
    return gaps


def looked_at_closely(path: RootPath, keys: Floats, rates: Floats, k: int) -> float:
    """The least gap within a key interval."""
    return float(least_of_looks(path, keys, rates, k, np.linspace(0.0, T, LOOKS)).min())


@exact_kernel
def looked_at(parts: OwnParts, states: Floats, keys: Floats, rates: Floats, chosen: Indices) -> Floats32:
    return least_gaps(parts, states, keys, rates, T, chosen)


@pytest.mark.parametrize("first", [0, 6])
def test_no_contact_is_missed_and_none_made_up(first: int) -> None:
    motion, found, near = OwnMotion(own_parts(MODEL, PAIRS)), [0, 0], 0
    for seed in range(first, first + 6):
        path, keys, rates = swung(seed)
        arms = motion.contacts(path, keys, rates, keys + ASIDE, FAR)
        soon = motion.contacts(path, keys, rates, keys + ASIDE, -path.horizon)
        for k, arm in enumerate(arms):
            gap = looked_at_closely(path, keys, rates, k)
            assert (arm >= 0) == (gap < 4e-4) or abs(gap - 4e-4) < 2e-4
            assert arm >= 0 or gap >= 0.0
            assert soon[k] < 0 or gap < 4e-4
            assert soon[k] >= 0 or gap >= 0.0
            found[int(arm >= 0)] += 1
            near += abs(gap) < 0.04
    assert min(found) > 5
    assert near > 5


@pytest.mark.parametrize("wild", [0.0, 0.3])
def test_looks_that_are_left_out_would_have_seen_nothing(wild: float) -> None:
    """Against a twin that takes every look of a level in an interval where the last one left too little room."""
    parts = own_parts(MODEL, PAIRS)
    rng, touching, near = np.random.default_rng(5), 0, 0
    for seed in range(20, 24):
        path, keys, rates = swung(seed)
        keys = keys + rng.uniform(-wild, wild, keys.shape)
        rates = rates + 10.0 * rng.uniform(-wild, wild, rates.shape)
        found = looked_at(parts, path.states, keys, rates, np.arange(path.horizon))
        for k in range(path.horizon):
            for step, scratch in zip(STEPS, NEAR, strict=True):
                samples = np.arange(step, MOMENTS + 1, step) / MOMENTS * T
                expected = least_of_looks(path, keys, rates, k, samples)
                if expected.min() < 0.0 or expected.min() >= scratch:
                    break
            near += 0.0 <= expected.min() < NEAR[0]
            if expected.min() < CLEAR[-1]:
                touching += 1
                np.testing.assert_allclose(found[expected < CLEAR[-1], k], expected[expected < CLEAR[-1]], atol=1e-6)
                assert found[:, k].argmin() == expected.argmin()
            assert (found[:, k].min() < CLEAR[-1]) == (expected.min() < CLEAR[-1])
    assert touching > 5
    assert near > 5 or wild


def test_what_was_looked_at_is_known_again_and_natural_intervals_are_not_looked_at() -> None:
    path, keys, rates = swung(3)
    motion, goals = OwnMotion(own_parts(MODEL, PAIRS)), keys + ASIDE
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


def test_a_full_memory_forgets_and_finds_the_same_again(monkeypatch: pytest.MonkeyPatch) -> None:
    path, keys, rates = swung(4)
    expected = OwnMotion(own_parts(MODEL, PAIRS)).contacts(path, keys, rates, keys + ASIDE, FAR)
    monkeypatch.setattr(own_motion, "ROOM", 5)
    motion = OwnMotion(own_parts(MODEL, PAIRS))
    for _ in range(2):
        assert np.array_equal(motion.contacts(path, keys, rates, keys + ASIDE, FAR), expected)
