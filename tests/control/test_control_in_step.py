"""A walk begins with the foot that is behind, or swings already: none steps twice while the other is left behind."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.fitting.proportions import proportional_humanoid
from elbowroom.body.gait.foot_state import SWING, X, Z
from elbowroom.body.root import FOOT, ROOT_STATE, WITH_FEET, RootState
from elbowroom.control.controller import Controller
from elbowroom.control.feet.in_step import in_step
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

LEFT, RIGHT = 0, 1
DT = 1 / 60
IDLE, WALK = Command(), Command(forward=1.0)


def feet_apart(side: int, way: Floats, by: float) -> Floats:
    """A row in which one foot is so far behind along a way (x aside, z ahead) of the root's frame."""
    row = np.zeros(WITH_FEET)
    row[[ROOT_STATE + X, ROOT_STATE + FOOT + X]] = 0.09, -0.09
    row[[ROOT_STATE + FOOT * side + X, ROOT_STATE + FOOT * side + Z]] -= by * way
    return row


def place(phase: float, side: int) -> float:
    """Where in its cycle a foot is."""
    return (phase + 0.5 * side) % 1.0


@pytest.mark.parametrize("heading", [0.0, 2.0, -0.7])
@pytest.mark.parametrize("aside", [0.0, math.pi, 0.5])
@pytest.mark.parametrize("side", [LEFT, RIGHT])
@pytest.mark.parametrize("phase", [0.0, 3.3, 7.85])
def test_the_foot_that_is_behind_goes_first(heading: float, aside: float, side: int, phase: float) -> None:
    way = np.array([math.sin(aside), math.cos(aside)])
    wanted = np.array([math.sin(heading + aside), math.cos(heading + aside)])
    root = RootState(heading=heading, phase=phase)
    found = in_step(root, feet_apart(side, way, 0.4), wanted, 1.0)
    assert place(found.phase, side) == pytest.approx(0.5)
    assert phase <= found.phase < phase + 1.0
    assert found._replace(phase=phase) == root


@pytest.mark.parametrize("side", [LEFT, RIGHT])
@pytest.mark.parametrize("over", [0.01, 0.5, 0.99])
def test_a_foot_in_the_air_goes_on_wherever_it_is(side: int, over: float) -> None:
    row = feet_apart(1 - side, np.array([0.0, 1.0]), 0.4)
    row[ROOT_STATE + FOOT * side + SWING] = over
    found = in_step(RootState(phase=1.3), row, np.array([0.0, 1.0]), 1.0)
    assert place(found.phase, side) == pytest.approx(0.62 + 0.38 * over)


def test_else_it_is_what_it_was() -> None:
    behind, ahead = feet_apart(LEFT, np.array([0.0, 1.0]), 0.4), np.array([0.0, 1.0])
    root = RootState(phase=0.3)
    assert in_step(root, behind, ahead, 1.0) != root
    assert in_step(root, behind, np.zeros(2), 1.0) == root  # who wants to go nowhere
    assert in_step(root, feet_apart(LEFT, ahead, 0.05), ahead, 1.0) == root  # beside each other
    for other in (root._replace(forward=0.1), root._replace(lateral=-0.1), root._replace(left_rise=0.1)):
        assert in_step(other, behind, ahead, 1.0) == other


@pytest.mark.parametrize("later", [0.26, 0.39])
def test_who_walks_again_as_he_has_hardly_stopped_lifts_no_foot_that_is_ahead(later: float) -> None:
    """It was, 2 frames after it had landed 0.7 m ahead of the other, which stood until its hip was as far off."""
    controller = Controller(proportional_humanoid(), Scene.load("empty"))
    keys = [IDLE] * 24 + [WALK] * round(later / DT) + [IDLE] * 18 + [WALK] * 90
    rows = np.array([controller.step(command, DT).root for command in keys])
    feet = rows[:, ROOT_STATE : ROOT_STATE + 2 * FOOT].reshape(-1, 2, FOOT)
    lifted = (feet[:-1, :, SWING] <= 0.0) & (feet[1:, :, SWING] > 0.0)
    assert lifted.sum() >= 4
    for frame, side in np.argwhere(lifted):
        assert feet[frame, side, Z] < feet[frame, 1 - side, Z] + 0.05
