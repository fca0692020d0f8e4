"""What head and arms would like under a waist: arms hang by gravity, however the trunk leans."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import ARMS, DOF, LOCAL, DofGroup, columns_of, limits, within_limits
from elbowroom.body.humanoid import Humanoid
from elbowroom.experiment.judge.poses import Poser
from elbowroom.planning.carried import carried
from elbowroom.planning.gaze import keeping_gaze
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.root.path import RootPath

Floats = NDArray[np.float64]
HUMANOID = Humanoid.default()
WAIST = columns_of(DofGroup.WAIST)


def walking(count: int) -> Floats:
    """Goals (n, LOCAL) at all phases of a walk."""
    states = np.zeros((count, 7))
    states[:, 3], states[:, 6] = 1.1, np.linspace(0.0, 3.0, count)
    return natural_walk()(RootPath(0.0, 0.15, states))


def hanging(uppers: Floats, side: str) -> Floats:
    """Where upper arms point, seen from the side: radians ahead of the vertical (N,), by the judge's posing."""
    q, roots, skeleton = np.zeros((len(uppers), DOF)), np.zeros((len(uppers), 7)), HUMANOID.skeleton
    q[:, DOF - LOCAL :] = uppers
    poser = Poser(HUMANOID)
    local, hips = poser.local(q, roots)
    places = poser.world(local, hips, roots[:, :3]).positions
    bone = places[:, skeleton.index(f"{side}LowerArm")] - places[:, skeleton.index(f"{side}UpperArm")]
    return np.arctan2(bone[:, 2], -bone[:, 1])


@pytest.mark.parametrize("side", ["left", "right"])
@pytest.mark.parametrize("deepest", [(80.0, 0.0, 0.38), (60.0, 20.0, 0.0), (-20.0, 0.0, 0.6), (-20.0, 0.0, 0.0)])
def test_arms_swing_about_the_vertical_whatever_the_trunk_does(side: str, deepest: tuple[float, float, float]) -> None:
    goals = walking(200)
    waists = np.linspace(0.0, 1.0, 200)[:, None] * [*np.deg2rad(deepest[:2]), deepest[2]]
    found = carried(goals, waists)
    assert np.abs(np.diff(found, axis=0) - np.diff(goals, axis=0)).max() < 0.04  # nothing jumps
    shown, natural = found.copy(), goals.copy()
    shown[:, WAIST] = waists
    astray = hanging(shown, side) - hanging(natural, side)
    assert np.rad2deg(np.abs(astray)).max() < 15.0


def test_all_else_is_as_the_gaze_has_it_and_under_the_own_waist_to_the_last_bit() -> None:
    rng = np.random.default_rng(0)
    goals, waists = rng.uniform(-0.4, 0.4, (80, LOCAL)), rng.uniform([-0.4, -0.7, 0.0], [1.3, 0.7, 0.7], (80, 3))
    arms = np.r_[tuple(columns_of(arm) for arm in ARMS)]
    others = np.delete(np.arange(LOCAL), arms)
    np.testing.assert_array_equal(carried(goals, waists)[:, others], keeping_gaze(goals, waists)[:, others])
    np.testing.assert_array_equal(carried(goals, goals[:, WAIST].copy()), goals)


def test_arms_stay_within_their_range() -> None:
    rng = np.random.default_rng(1)
    low, high = limits(DofGroup.WAIST).T
    goals, waists = np.zeros((300, LOCAL)), rng.uniform(low, high, (300, 3))
    for arm in ARMS:
        low, high = limits(arm).T
        goals[:, columns_of(arm)] = rng.uniform([low[0], 0.0, low[2], low[3]], [high[0], 0.0, *high[2:]], (300, 4))
    q = np.zeros((300, DOF))
    q[:, DOF - LOCAL :] = carried(goals, waists)
    assert within_limits(q)
