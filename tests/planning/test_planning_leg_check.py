"""How far legs are free along a path, against every state of it and of every stop, posed one by one."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import leg_capsules
from elbowroom.body.root import ROOT_STATE, RootState
from elbowroom.planning.root.legs.along_path import UNKNOWN, PathLooks, free_part
from elbowroom.planning.root.legs.leg_cache import KnownLegs
from elbowroom.planning.root.legs.lower_body import LowerBody
from elbowroom.planning.root.motion import MotionBounds, dense_states, steer, stopping_states
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

AVATAR, INTERVAL, SKIN, SPACING, HORIZON = Humanoid.default(), 0.15, 0.01, 0.0125, 8
EVERY = np.ones(HORIZON, np.bool_)


def walks(seed: int, count: int) -> list[Floats]:
    """Random ways among the obstacles of the paper's scenes."""
    rng, found = np.random.default_rng(seed), []
    for _ in range(count):
        states = np.zeros((HORIZON + 1, ROOT_STATE))
        states[0] = RootState(*rng.uniform([-0.6, 0, -3, -0.7, -0.6, -2, 0], [0.6, 4.5, 3, 2, 0.6, 2, 1]))
        steer(states, rng.uniform([-0.7, -0.6, -2.5], [2.2, 0.6, 2.5]), INTERVAL, BOUNDS)
        found.append(states)
    return found


BOUNDS = MotionBounds(2.5, 2.0, 3.0, 14.0)
NOTHING_KNOWN = np.full((2, HORIZON), UNKNOWN)


def free_of_all(body: LowerBody, states: Floats) -> tuple[int, int]:
    """The twin: no rectangle, no bound, nothing left out; and how many states it posed."""
    near, touching, posed = body.near(0.0, 2.0, 20.0), [HORIZON], 0
    for rows, owner in (
        dense_states(states, INTERVAL, SPACING, EVERY),
        stopping_states(states, INTERVAL, BOUNDS, SPACING, EVERY),
    ):
        room = clearance(leg_capsules(body.model, rows), body.radii, near.obstacles)
        touching += (owner[room < SKIN] - 1).tolist()
        posed += len(rows)
    return min(touching), posed


@pytest.mark.parametrize("name", ["b", "d"])
def test_a_path_is_as_far_free_as_all_of_its_states_are(name: str) -> None:
    body, posed, all_posed = LowerBody(AVATAR, Scene.load(name).obstacles), 0, 0
    looks, near = PathLooks(body.legs, body.hull, BOUNDS, SKIN, SPACING), body.near(0.0, 2.0, 20.0)
    kept: list[int] = []
    for states in walks(ord(name), 40):
        free, count = free_part(looks, near, states, INTERVAL, SKIN, NOTHING_KNOWN.copy())
        wanted, every = free_of_all(body, states)
        assert free == wanted
        kept, posed, all_posed = [*kept, free], posed + count, all_posed + every
    assert 5 < kept.count(HORIZON) < 35
    assert len(set(kept)) > 3
    assert posed < 0.2 * all_posed


def test_what_is_known_is_not_looked_at_again_and_says_the_same() -> None:
    body, known = LowerBody(AVATAR, Scene.load("d").obstacles), KnownLegs()
    looks, near = PathLooks(body.legs, body.hull, BOUNDS, SKIN, SPACING), body.near(0.0, 2.0, 20.0)
    for states in walks(5, 20):
        asked = looks, near, states, INTERVAL, SKIN
        room, names = known.recalled(INTERVAL, states)
        assert np.isnan(room).all()
        free, _ = free_part(*asked, room)
        known.learn(names, room)
        again, _ = known.recalled(INTERVAL, states)
        np.testing.assert_array_equal(again, room)
        assert free_part(*asked, again) == (free, 0)
        assert np.isnan(known.recalled(2.0 * INTERVAL, states)[0]).all()
