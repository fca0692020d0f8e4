"""Where the head looks: ahead of the turn, and level whatever the trunk does."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL, DofGroup, columns_of, limits, within_limits
from elbowroom.body.gait.lowered_hips import hips_sinks
from elbowroom.geometry import quaternion
from elbowroom.planning.gaze import LEAD, keeping_gaze
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]
WAIST, HEAD = columns_of(DofGroup.WAIST), columns_of(DofGroup.HEAD)
T = 0.15


def heads(states: Floats, interval: float = T) -> Floats:
    return natural_walk()(RootPath(0.0, interval, states))[:, HEAD]


def turning(times: Floats, rate: float) -> Floats:
    """Root states of a walk that turns evenly from the first second on."""
    states = np.zeros((len(times), 7))
    states[:, 2], states[:, 3] = rate * np.maximum(times - 1.0, 0.0), 1.1
    states[:, 5] = np.where(times >= 1.0, rate, 0.0)
    return states


@pytest.mark.parametrize("interval", [0.05, 0.15, 0.2, 0.5])
def test_it_looks_where_the_root_will_go(interval: float) -> None:
    times = interval * np.arange(round(4.0 / interval) + 1.0)
    found = heads(turning(times, 0.8), interval)
    wanted = 0.8 * (np.maximum(times + LEAD - 1.0, 0.0) - np.maximum(times - 1.0, 0.0))
    assert np.abs(found[:, 1] - wanted).max() < 0.8 * interval  # straight between key times
    assert np.abs(found[times > 1.0 + interval, 1] - 0.8 * LEAD).max() < 1e-9  # after the last one too
    assert not found[:, 0].any()


def test_straight_on_and_backward_it_looks_ahead_and_sideways_to_that_side() -> None:
    states = np.zeros((9, 7))
    for forward in (0.0, 1.3, -0.8):
        states[:, 3] = forward
        assert not heads(states).any()
    for lateral in (0.9, -0.9):
        states[:, 3:5] = 0.0, lateral
        assert np.all(np.sign(lateral) * heads(states)[:, 1] > np.deg2rad(45.0))


def test_it_stays_within_the_neck() -> None:
    states = np.random.default_rng(0).normal(size=(500, 7)) * 3.0
    goals = natural_walk()(RootPath(0.0, T, states))
    low, high = limits(DofGroup.WAIST).T
    waists = np.random.default_rng(1).uniform(low, high, (500, 3))
    goals[:, WAIST] = waists
    for uppers in (natural_walk()(RootPath(0.0, T, states)), keeping_gaze(goals, np.roll(waists, 1, axis=0))):
        head = np.zeros((500, 3 + LOCAL))
        head[:, DofGroup.HEAD.at] = uppers[:, HEAD]
        assert within_limits(head)


def gaze(uppers: Floats) -> Floats:
    """Where heads look, seen from the root: unit vectors (N, 3)."""
    turned = [
        quaternion.multiply(
            quaternion.about_axis(1, uppers[:, part.start + 1]), quaternion.about_axis(0, uppers[:, part.start])
        )
        for part in (WAIST, HEAD)
    ]
    hips = quaternion.about_axis(0, hips_sinks(1.0, np.zeros(len(uppers)), uppers[:, WAIST.stop - 1].copy())[:, 2])
    seen: Floats = quaternion.rotate(quaternion.multiply(hips, quaternion.multiply(*turned)), np.array([0.0, 0.0, 1.0]))
    return seen


def test_the_gaze_stays_as_far_as_the_neck_can() -> None:
    rng = np.random.default_rng(2)
    goals, waists = rng.uniform(-0.2, 0.2, (300, LOCAL)), rng.uniform(-0.25, 0.25, (300, 3))
    found = keeping_gaze(goals, waists)
    shown = found.copy()
    shown[:, WAIST] = waists
    np.testing.assert_allclose(gaze(shown), gaze(goals), atol=1e-9)
    others = np.delete(np.arange(LOCAL), np.r_[HEAD])
    np.testing.assert_array_equal(found[:, others], goals[:, others])


def test_under_its_own_waist_the_goal_stays_to_the_last_bit() -> None:
    goals = np.random.default_rng(3).uniform(-0.4, 0.4, (50, LOCAL))
    np.testing.assert_array_equal(keeping_gaze(goals, goals[:, WAIST].copy()), goals)


@pytest.mark.parametrize("yaw", [0.0, 0.3, -0.6])
def test_who_bends_deep_looks_down_to_the_same_side_and_nothing_jumps(yaw: float) -> None:
    bends = np.linspace(0.0, np.deg2rad(80.0), 400)
    goals, waists = np.zeros((400, LOCAL)), np.zeros((400, 3))
    goals[:, HEAD.start + 1], waists[:, 0] = yaw, bends
    found = keeping_gaze(goals, waists)[:, HEAD]
    assert np.abs(np.diff(found, axis=0)).max() < 0.02
    assert found[-1, 0] == limits(DofGroup.HEAD)[0, 0]
    assert np.all(np.sign(found[:, 1]) == np.sign(yaw))
