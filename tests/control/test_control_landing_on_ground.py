"""Where a foot lands that would land across an edge: on the tread, on its ball, or with little of it in the air."""

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.gait.landing_places import Stepper
from elbowroom.body.gait.own_steps import CYCLE
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import WITH_FEET
from elbowroom.control.feet.landing_on_ground import FootPlace, Lie, farther_onto
from elbowroom.jit import exact_kernel
from elbowroom.planning.model.footing import Footing, Underfoot
from elbowroom.world.scene import Scene
from feet_walks import GAIT

Floats = NDArray[np.float64]

LEFT, BALL, RISE, TRIED, TOES = 0, 6, 0.1, 0.18, 0.03  # side; column of the gait's legs; metres
WHO = Stepper(GAIT.legs, GAIT.scale, CYCLE)


@exact_kernel
def farther(
    under: Underfoot, who: Stepper, row: Floats, side: int, goal: FootPlace, deepest: float
) -> tuple[float, Lie]:
    """The kernel, for who calls it from Python."""
    return farther_onto(under, who, row, side, goal, deepest)


def landed(begin: float, length: float, z: float, deepest: float = -math.inf) -> tuple[float, float]:
    """How much farther ahead a left foot lands that would at `z`, where a block lies so; and how high."""
    block: dict[str, Any] = {
        "type": "box",
        "center": [0.0, 0.5 * RISE, begin + 0.5 * length],
        "size": [1.8, RISE, length],
    }
    ground = Scene.of("block", [block], finish=(0.0, 9.0)).ground
    under, row = Footing(body_model(Humanoid.default()), ground).underfoot, np.zeros(WITH_FEET)
    ahead, (height, _) = farther(under, WHO, row, LEFT, (float(GAIT.legs[LEFT, 3]), z, 0.0), deepest)
    return ahead, height


def test_a_foot_that_stands_whole_lands_where_it_would() -> None:
    ahead, height = landed(0.5, 1.0, 1.0)
    assert abs(ahead) < 1e-9
    assert math.isclose(height, RISE)


@pytest.mark.parametrize("over", [-0.05, 0.05])
def test_a_foot_across_an_edge_lands_as_little_farther_as_it_has_to(over: float) -> None:
    """Where its toes begin is borne by the far edge, its ankle by the near one."""
    begin, length, front = 0.5, 0.6, float(GAIT.legs[LEFT, BALL]) + TOES * GAIT.scale
    edge = begin + length - front if over > 0.0 else begin
    ahead, height = landed(begin, length, edge + over)
    assert math.isclose(height, RISE)
    assert abs(over) - 1e-9 <= abs(ahead) <= abs(over) + 0.03
    assert ahead * over < 0.0


def test_a_foot_that_could_step_over_a_tread_goes_back_to_it() -> None:
    """Ahead of the block it would stand whole too, and nearer, but deeper than it should."""
    begin, length = 0.5, 0.4
    z = begin + length + 0.03
    ahead, height = landed(begin, length, z)
    assert ahead > 0.0
    assert abs(height) < 1e-9
    ahead, height = landed(begin, length, z, 0.5 * RISE)
    assert ahead < 0.0
    assert math.isclose(height, RISE)


def test_a_foot_on_a_block_shorter_than_itself_stands_on_its_ball() -> None:
    begin, length, ball = 0.5, 0.06, float(GAIT.legs[LEFT, BALL])
    for z in np.linspace(begin - ball - 0.08, begin + length - ball + 0.08, 9):
        ahead, height = landed(begin, length, float(z))
        assert abs(ahead) <= TRIED * GAIT.scale + 1e-9
        if math.isclose(height, RISE):
            assert begin <= z + ahead + ball <= begin + length


@pytest.mark.parametrize("over", [0.002, 0.02, 0.05])
def test_a_foot_that_would_have_its_toes_alone_on_a_tread_stands_before_it_or_goes_on_onto_it(over: float) -> None:
    """It stood in the air before the edge, or came down a little short, and then did."""
    begin, ball = 1.0, float(GAIT.legs[LEFT, BALL])
    front = ball + TOES * GAIT.scale
    ahead, height = landed(begin, 0.6, begin - front + over)
    stands = begin - front + over + ahead
    assert stands + front < begin if height < 0.5 * RISE else begin - 0.15 * ball <= stands <= begin + 0.03


def test_a_foot_keeps_a_centimetre_to_the_edge_that_it_comes_down_from() -> None:
    begin, length = 0.5, 1.0
    under = Footing(body_model(Humanoid.default()), Scene.of("empty", [], finish=(0.0, 9.0)).ground).sole
    edge = begin + length
    ahead, height = landed(begin, length, edge + under.back + 0.004)
    assert abs(height) < 1e-9
    assert 0.004 <= ahead <= 0.02
