"""Gaps in the ground: a body goes over those that are no wider than a foot is long, and no foot stands on them."""

import math

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.planning.navigation.navigator import Navigator
from elbowroom.planning.navigation.way import NoWayError
from elbowroom.world.ground.gaps import WIDEST
from elbowroom.world.ground.ground import Ground, height_along
from elbowroom.world.ground.sole import Sole, sole_on
from elbowroom.world.scene import Scene
from stairs import BEFORE, ON_FLOOR, TREADS, spiral_stair, tread_top

HIGH = 1.0  # metres that the boards are above the plane: nobody steps down
SOLE = Sole(0.06, 0.18, 0.04)


def boards(gap: float, turned: float = 0.0) -> Ground:
    """Two boards with a gap between them about the middle, across the way along `turned`."""
    half = 0.5 * (gap + 2.0)
    both = [
        {
            "type": "box",
            "center": [side * half * math.sin(turned), HIGH - 0.05, side * half * math.cos(turned)],
            "size": [2.0, 0.1, 2.0],
            "yaw": turned,
        }
        for side in (-1.0, 1.0)
    ]
    low = {"type": "box", "center": [8.0, 0.05, 0.0], "size": [1.0, 0.1, 1.0]}
    return Scene.of("boards", [*both, low], start=(-6.0, 0.0), finish=(-6.0, 6.0)).ground


def across(ground: Ground, turned: float = 0.0) -> list[float]:
    """The heights that one comes to from the one board on to the other."""
    sine, cosine = math.sin(turned), math.cos(turned)
    places = [(along * sine, along * cosine) for along in np.linspace(-0.5, 0.5, 41)]
    found, before = [], (-sine, HIGH, -cosine)
    for x, z in places:
        found.append(height_along(ground, before, x, z))
        before = x, found[-1], z
    return found


@pytest.mark.parametrize("turned", [0.0, math.pi / 4, 0.4])
@pytest.mark.parametrize("gap", [0.05, 0.1, 0.2])
def test_a_body_goes_over_a_gap(gap: float, turned: float) -> None:
    assert across(boards(gap, turned), turned) == pytest.approx([HIGH] * 41)


def test_nobody_goes_over_what_is_wider_than_a_foot_is_long() -> None:
    assert across(boards(WIDEST), 0.0) == pytest.approx([HIGH] * 41)
    assert min(across(boards(WIDEST + 0.18))) == -math.inf


def test_no_foot_stands_in_a_gap_but_over_it() -> None:
    ground = boards(0.3)
    for z in np.linspace(-0.4, 0.4, 41).tolist():
        height, _ = sole_on(ground, SOLE, (0.0, HIGH, z), 0.0)
        over = z - SOLE.back > -0.15 and z + SOLE.ahead < 0.15
        assert height == pytest.approx(-math.inf if over else HIGH), "it stands as far as it is over a board"


def test_a_sole_lies_on_the_highest_of_the_treads_that_it_is_over() -> None:
    """Two treads of a steep stair rise by more than a step within its length."""
    treads = [
        {"type": "box", "center": [0.0, 0.09 * (i + 1), 0.1 * i], "size": [1.0, 0.18 * (i + 1), 0.1]} for i in range(4)
    ]
    ground = Scene.of("steep", treads, start=(-6.0, 0.0), finish=(-6.0, 6.0)).ground
    for z in np.linspace(-0.04, 0.1, 8).tolist():
        top = 0.18 * (1 + math.floor((z + SOLE.ahead + 0.05) / 0.1 + 1e-9))
        height, _ = sole_on(ground, SOLE, (0.0, 0.18 if z < 0.05 else 0.36, z), 0.0)
        assert height == pytest.approx(top)


@pytest.mark.parametrize("ceiling", [None, 3.4, 2.5])
def test_a_way_leads_up_a_spiral_of_open_treads_and_over_the_gap_before_the_floor(ceiling: float | None) -> None:
    scene = spiral_stair(ceiling)
    way = Navigator(Humanoid.default(), scene).find(BEFORE, (ON_FLOOR[0], tread_top(TREADS), ON_FLOOR[1]))
    heights = way.corners(BEFORE, 9.0)[:, 1]
    assert heights[-1] == pytest.approx(tread_top(TREADS))


def test_no_way_leads_up_a_spiral_that_is_lower_than_one_can_bend_over_raised_thighs() -> None:
    with pytest.raises(NoWayError):
        Navigator(Humanoid.default(), spiral_stair(2.4)).find(BEFORE, (ON_FLOOR[0], tread_top(TREADS), ON_FLOOR[1]))
