"""Legs on a spiral stair of open, tapering treads: the walking cycle goes up and down it, and touches nothing."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.gait.cycle import phase_rate, quickness
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import HEIGHT, RISES, RootState
from elbowroom.planning.root.legs.lower_body import LowerBody
from elbowroom.world.ground.ground import eased_height
from stairs import RISE, TURN, spiral_stair, tread_top

AVATAR = Humanoid.default()
STAIR = spiral_stair()
FIRST, STEP = math.radians(290.0), 0.03  # where a walk on the treads begins; seconds between states


def around(radius: float, speed: float, phase: float, *, up: bool) -> NDArray[np.float64]:
    """Root states of an even walk on a circle, up or down the stair."""
    body = LowerBody(AVATAR, STAIR.obstacles, STAIR.ground)
    along = 1.0 if up else -1.0
    rate = quickness(body.model.gait.scale) * phase_rate(speed, 0.0, -along * speed / radius)
    times = np.arange(0.0, 2.8 * radius / speed, STEP)
    angles = (FIRST if up else FIRST + 2.8) + along * speed / radius * times
    rows = np.zeros((len(times), len(RootState._fields)))
    rows[:, 0], rows[:, 1] = radius * np.cos(angles), radius * np.sin(angles)
    rows[:, 2] = np.arctan2(-along * np.sin(angles), along * np.cos(angles))
    rows[:, 3], rows[:, 5], rows[:, 6] = speed, -along * speed / radius, phase + rate * times
    near = (rows[0, 0], tread_top(0) + RISE * (angles[0] - FIRST + 2.0 * TURN) / TURN, rows[0, 1])
    for row in rows:
        row[HEIGHT] = eased_height(STAIR.ground, near, row[0], row[1])
        near = row[0], row[HEIGHT], row[1]
    return rows


@pytest.mark.parametrize("up", [True, False], ids=["up", "down"])
@pytest.mark.parametrize("radius", [0.55, 0.65])
def test_a_walk_on_the_treads_of_a_spiral_touches_none(radius: float, up: bool) -> None:
    body, worst = LowerBody(AVATAR, STAIR.obstacles, STAIR.ground), math.inf
    for speed, phase in ((0.2, 0.0), (0.3, 0.5)):
        rows = around(radius, speed, phase, up=up)
        stood, found = body.footing.stood(rows)
        assert found.all(), "a foot has nothing to stand on"
        assert np.abs(stood[:, [RISES, RISES + 2]]).max() < 0.9
        worst = min(worst, float(body.clearance(body.near(0.0, 0.0, 4.0, 1.0), rows).min()))
    assert worst >= 0.0
