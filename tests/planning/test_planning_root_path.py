"""Interpolation of root states: velocities are derivatives, ends are met, the phase only runs forward."""

import itertools

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.root import RootState
from elbowroom.planning.root.path import RootPath, interpolate_root


def random_states(rng: np.random.Generator, count: int) -> NDArray[np.float64]:
    states = rng.uniform(-1.0, 1.0, (count, 7))
    states[:, 6] = np.cumsum(rng.uniform(0.0, 0.4, count))
    return states


def world_velocity(state: NDArray[np.float64]) -> NDArray[np.float64]:
    sine, cosine = np.sin(state[2]), np.cos(state[2])
    forward, left = np.array([sine, cosine]), np.array([cosine, -sine])
    velocity: NDArray[np.float64] = state[3] * forward + state[4] * left
    return velocity


def test_the_ends_are_the_key_states() -> None:
    rng = np.random.default_rng(0)
    for a, b in zip(random_states(rng, 50), random_states(rng, 50), strict=True):
        np.testing.assert_allclose(interpolate_root(a, b, 0.0, 0.3), a, atol=1e-12)
        np.testing.assert_allclose(interpolate_root(a, b, 1.0, 0.3), b, atol=1e-12)


def test_velocities_are_the_derivatives_of_the_shown_motion() -> None:
    rng, step, interval = np.random.default_rng(1), 1e-6, 0.25
    for a, b in zip(random_states(rng, 30), random_states(rng, 30), strict=True):
        for u in (0.1, 0.5, 0.83):
            state = interpolate_root(a, b, u, interval)
            before, after = (interpolate_root(a, b, u + side * step, interval) for side in (-1.0, 1.0))
            rate = (after - before) / (2.0 * step * interval)
            np.testing.assert_allclose(world_velocity(state), rate[:2], atol=1e-6)
            np.testing.assert_allclose(state[5], rate[2], atol=1e-6)


def test_constant_acceleration_is_reproduced_exactly() -> None:
    interval, speed, gain = 0.2, 0.4, 2.0
    a = np.array([0.0, 0.0, 0.0, speed, 0.0, 0.0, 0.0])
    end = speed + gain * interval
    b = np.array([0.0, 0.5 * (speed + end) * interval, 0.0, end, 0.0, 0.0, 0.2])
    for u in np.linspace(0.0, 1.0, 11):
        time = u * interval
        state = interpolate_root(a, b, u, interval)
        np.testing.assert_allclose(state[[1, 3]], [speed * time + 0.5 * gain * time**2, speed + gain * time])


def test_the_phase_never_runs_backwards() -> None:
    rng = np.random.default_rng(2)
    states = random_states(rng, 40)
    for a, b in itertools.pairwise(states):
        phases = [interpolate_root(a, b, u, 0.2)[6] for u in np.linspace(0.0, 1.0, 50)]
        assert np.all(np.diff(phases) >= 0.0)


def test_a_path_is_sampled_piece_by_piece_and_holds_its_ends() -> None:
    states = random_states(np.random.default_rng(3), 5)
    path = RootPath(2.0, 0.25, states)
    assert path.horizon == 4
    np.testing.assert_allclose(path.times, [2.0, 2.25, 2.5, 2.75, 3.0])
    np.testing.assert_allclose(path.sample(path.times), states, atol=1e-12)
    np.testing.assert_allclose(path.sample([0.0, 9.0]), states[[0, -1]], atol=1e-12)
    assert path.at(2.6) == RootState(*interpolate_root(states[2], states[3], (2.6 - 2.5) / 0.25, 0.25))


@pytest.mark.parametrize("count", [1, 2])
def test_shortest_paths(count: int) -> None:
    states = random_states(np.random.default_rng(4), count)
    np.testing.assert_allclose(RootPath(0.0, 0.2, states).sample([0.0, 0.1, 5.0])[[0, -1]], states[[0, -1]], atol=1e-12)
