"""Hips that go down: lower all the way down, as the ground under the leg ahead is, and as ever elsewhere."""

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.footholds import beside
from elbowroom.body.gait.posed_feet import posed_feet
from elbowroom.body.gait.stride import CLIMB, climbing_rate
from elbowroom.body.root import ROOT_STATE
from feet_walks import GAIT

Floats = NDArray[np.float64]

SPEED, CLIMBS = 0.56, 0.34  # m/s ahead and down: over treads of 17 by 28 cm


def sunk(climb: Floats, phase: Floats) -> Floats:
    """How far the hips (N,) are below T-pose over feet that stand under them."""
    rows = np.repeat(beside(GAIT, np.zeros(ROOT_STATE))[None], len(phase), axis=0)
    rows[:, 3], rows[:, 6], rows[:, CLIMB] = SPEED, phase, climb
    sinks: Floats = posed_feet(GAIT.legs, GAIT.scale, GAIT.half_leg, rows, np.zeros(len(rows)))[1]
    return sinks[:, 0]


def test_hips_that_go_down_are_as_low_as_the_leg_ahead_asks_for_when_it_lands() -> None:
    falls = 0.31 * CLIMBS / climbing_rate(SPEED, 0.0, 0.0, -CLIMBS)
    level, down = (sunk(np.full(2, climb), np.array([0.0, 0.25])) for climb in (0.0, -CLIMBS))
    assert down[0] - level[0] > falls
    assert 0.4 * falls < down[1] - level[1] < falls


def test_they_begin_to_as_the_ground_does_and_never_rise_in_the_world_by_much() -> None:
    slow = sunk(-np.linspace(0.0, CLIMBS, 100), np.zeros(100))
    assert np.abs(np.diff(slow)).max() < 0.005
    times = np.linspace(0.0, 1.0, 61)
    heights = -CLIMBS * times - sunk(np.full(61, -CLIMBS), times * climbing_rate(SPEED, 0.0, 0.0, -CLIMBS))
    assert np.diff(heights).max() / (times[1] - times[0]) < 0.2
    assert np.diff(heights).min() / (times[1] - times[0]) > -0.9


def test_who_goes_up_or_on_the_level_has_his_hips_where_the_walk_has_them() -> None:
    phase = np.linspace(0.0, 1.0, 40)
    rows = np.repeat(beside(GAIT, np.zeros(ROOT_STATE))[None], 40, axis=0)
    rows[:, 6] = phase
    assert np.ptp(posed_feet(GAIT.legs, GAIT.scale, GAIT.half_leg, rows, np.zeros(40))[1][:, 0]) < 1e-12
    assert sunk(np.full(40, CLIMBS), phase).max() < sunk(np.full(40, -CLIMBS), phase).min()
