"""A way out that is gone on with from any moment of it keeps the bounds of the root, and leads to the same place."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.root import ROOT_STATE
from elbowroom.planning.root.motion import MotionBounds, brake, go_as, steer
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]

INTERVAL, LENGTH, MOVING, REST = 0.15, 5, 2, 4
BOUNDS = MotionBounds(turn_rate=1.0, acceleration=2.0, braking=3.0, turn_acceleration=4.0)


def steps_out(rng: np.random.Generator, count: int) -> RootPath:
    """Short steps, each to a stand, and a stand for a while."""
    states = np.zeros((count * LENGTH + REST + 1, ROOT_STATE))
    states[0, :3] = rng.uniform(-1.0, 1.0, 3)
    for first in range(0, count * LENGTH, LENGTH):
        step = states[first : first + LENGTH + 1]
        steer(step[: MOVING + 1], rng.uniform(-0.4, 0.4, 3), INTERVAL, BOUNDS)
        brake(step, MOVING, INTERVAL, BOUNDS)
    states[count * LENGTH :] = states[count * LENGTH]
    return RootPath(0.0, INTERVAL, states)


def asked_of_the_ground(path: RootPath) -> tuple[Floats, Floats]:
    """How fast velocities change along a path: on the ground, and of the heading."""
    rate = 240.0
    states = path.sample(np.arange(0.0, path.horizon * path.interval, 1.0 / rate))
    places, headings = (np.diff(part, 2, axis=0) * rate**2 for part in (states[:, :2], states[:, 2]))
    return np.linalg.norm(places, axis=1), np.abs(headings)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 0.75])
def test_who_goes_on_between_key_times_keeps_the_bounds(seed: int, share: float) -> None:
    path = steps_out(np.random.default_rng(seed), 3)
    left = path.sample(INTERVAL * (1.0 + share + np.arange(float(path.horizon))))
    states = np.zeros_like(left)
    states[0] = left[0]
    go_as(states, left, INTERVAL, BOUNDS)
    places, headings = asked_of_the_ground(RootPath(0.0, INTERVAL, states))
    assert places.max() <= 1.001 * BOUNDS.braking
    assert headings.max() <= 1.001 * BOUNDS.turn_acceleration
    np.testing.assert_allclose(states[-1, :3], path.states[-1, :3], atol=0.005)
    np.testing.assert_allclose(states[-1, 3:6], 0.0, atol=1e-9)
