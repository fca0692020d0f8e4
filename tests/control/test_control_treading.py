"""Feet that step where ground is not a plane: as on the plane where it is level, and on treads, sills and ramps."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.gait.foot_state import SWING, Z
from elbowroom.body.gait.gliding import gliding
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import lower_body
from elbowroom.body.root import HEIGHT, RISES, ROOT_STATE, WITH_FEET
from elbowroom.control.controller import Controller
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from feet_walks import GAIT

Floats = NDArray[np.float64]

AVATAR = Humanoid.default()
FRAME, BALL = 1 / 60, 6  # seconds; column of the gait's legs
BESIDE = {"type": "box", "center": [3.0, 0.1, 2.0], "size": [0.4, 0.2, 0.4]}
ASKED = (Command(forward=1.0), Command(), Command(strafe=1.0), Command(turn=1.0), Command(forward=-1.0), Command())


def shown(obstacles: list[dict[str, Any]], held: int = 45) -> Floats:
    """What is shown while commands follow on one another."""
    controller, rows = Controller(AVATAR, Scene.of("place", obstacles, finish=(0.0, 30.0))), []
    for k in range(held * len(ASKED)):
        rows.append(controller.step(ASKED[k // held], FRAME).root)
    return np.array(rows)


def test_on_a_level_floor_feet_step_and_bodies_live_as_on_the_plane() -> None:
    """A low box that nobody comes near makes the ground of a place uneven."""
    assert not Scene.of("place", [BESIDE], finish=(0.0, 30.0)).ground.plain
    assert np.abs(shown([BESIDE]) - shown([])).max() < 1e-6


@pytest.mark.parametrize("begin", [2.0, 2.08])
def test_a_foot_on_a_sill_that_is_shorter_than_itself_stands_on_its_ball(begin: float) -> None:
    """It rolls over that: in the air it would slide."""
    sill = {"type": "box", "center": [0.0, 0.05, begin + 0.05], "size": [1.8, 0.1, 0.1]}
    controller, balls = Controller(AVATAR, Scene.of("sill", [sill], finish=(0.0, 5.0))), list[float]()
    while controller.root.z < begin + 0.4:
        row = controller.step(ASKED[0], FRAME).root
        for side, (foot, rise) in enumerate(zip(row[ROOT_STATE:WITH_FEET].reshape(2, -1), row[RISES::2], strict=False)):
            if foot[SWING] <= 0.0 and row[HEIGHT] + rise > 0.08:
                balls.append(row[1] + foot[Z] + GAIT.legs[side, BALL])
    assert balls
    assert begin - 1e-3 < min(balls) <= max(balls) < begin + 0.1 + 1e-3


def test_feet_of_the_cycle_are_raised_alike_in_a_row_of_their_own() -> None:
    rng, still = np.random.default_rng(0), np.zeros(WITH_FEET)
    for _ in range(200):
        root, lowering = np.zeros(ROOT_STATE), rng.uniform(0.0, 0.4, 1)
        root[3], root[6], root[RISES:] = rng.uniform(0.6, 1.3), rng.uniform(), rng.uniform(-0.2, 0.2, 4)
        both = (gliding(GAIT, still, root, 60.0), root)
        own, planned = (lower_body(GAIT, row[None], lowering) for row in both)
        assert max(np.abs(one - other).max() for one, other in zip(own, planned, strict=True)) < 0.012
