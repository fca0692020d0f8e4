"""Goal functions along a root path."""

import numpy as np

from elbowroom.body.clips.stock_clips import arm_swing_goal
from elbowroom.body.dof import LOCAL, LOCAL_GROUPS, DofGroup, within_limits
from elbowroom.planning.goal import fixed_goal, natural_walk, periodic_goal, side_by_side
from elbowroom.planning.root.path import RootPath


def walk(speed: float, rate: float = 0.9, horizon: int = 30, interval: float = 0.2) -> RootPath:
    states = np.zeros((horizon + 1, 7))
    time = interval * np.arange(horizon + 1)
    states[:, 1], states[:, 3], states[:, 6] = speed * time, speed, rate * time
    return RootPath(0.0, interval, states)


def test_a_fixed_goal_stays() -> None:
    goals = fixed_goal([0.1, -0.2])(walk(1.0))
    np.testing.assert_array_equal(goals, np.tile([0.1, -0.2], (31, 1)))


def test_a_fixed_goal_keeps_its_own_copy() -> None:
    wanted = np.zeros(2)
    goal = fixed_goal(wanted)
    wanted[0] = 1.0
    assert not goal(walk(1.0)).any()


def test_a_periodic_goal_follows_phase_and_speed_of_the_path() -> None:
    path = walk(1.2)
    goals = periodic_goal(DofGroup.LEFT_ARM)(path)
    np.testing.assert_array_equal(goals, arm_swing_goal(DofGroup.LEFT_ARM, path.states[:, 6], path.states[:, 3]))
    assert np.ptp(goals[:, 0]) > np.deg2rad(20.0)


def test_arms_hang_still_when_the_body_stands() -> None:
    goals = natural_walk()(walk(0.0, rate=0.0))
    np.testing.assert_array_equal(goals, np.tile(goals[0], (31, 1)))
    np.testing.assert_allclose(goals[0, 3:7], goals[0, 7:11])
    assert not goals[0, 11:].any()


def test_arms_swing_against_each_other_at_full_speed() -> None:
    goals = natural_walk()(walk(1.3))
    left, right = goals[:, 3], goals[:, 7]
    assert np.corrcoef(left, right)[0, 1] < -0.8


def test_the_natural_walk_has_a_goal_for_every_group_and_stays_within_limits() -> None:
    uppers = natural_walk()(walk(2.2, rate=1.2))
    assert uppers.shape == (31, LOCAL)
    assert within_limits(np.concatenate([np.zeros((31, 3)), uppers], axis=1))


def test_the_natural_walk_is_the_goals_of_each_group_side_by_side() -> None:
    path = RootPath(0.0, 0.15, np.random.default_rng(5).normal(size=(200, 7)))
    groups = {group: periodic_goal(group) for group in LOCAL_GROUPS}
    np.testing.assert_array_equal(natural_walk()(path), side_by_side(groups)(path))
