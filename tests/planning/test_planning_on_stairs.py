"""What is liked on stairs: hips lower under an upright trunk on the way down, arms off thighs, all within limits."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import ARMS, DofGroup, columns_of, limits
from elbowroom.body.gait.lowered_hips import hips_sinks
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model
from elbowroom.body.root import HEIGHT, ROOT_STATE
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.model.footing import Footing
from elbowroom.planning.model.lowered_legs import LoweredLegs
from elbowroom.planning.model.self_pairs import self_clearances, self_pairs
from elbowroom.planning.on_stairs import goals_on_stairs
from elbowroom.planning.root.path import RootPath
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]

MODEL = body_model(Humanoid.default())
GAIT = MODEL.gait
CLIMB = HEIGHT + 1
WAIST, TREAD, RISE, STEPS = columns_of(DofGroup.WAIST), 0.28, 0.17, 8
ABDUCTIONS = [columns_of(arm).start + 1 for arm in ARMS]


def stair() -> Scene:
    treads: list[dict[str, Any]] = [
        {"type": "box", "center": [0.0, 0.5 * RISE * n, TREAD * n], "size": [3.0, RISE * n, TREAD]}
        for n in range(1, STEPS)
    ]
    return Scene.of("stair", treads, finish=(0.0, 3.0))


def walk(up: bool, horizon: int = 12) -> RootPath:
    """Along the stair at the speed at which people climb one."""
    states, times = np.zeros((horizon + 1, ROOT_STATE)), 0.15 * np.arange(horizon + 1)
    speed = 0.56
    gone = 0.4 + speed * times if up else TREAD * STEPS - 0.5 - speed * times
    states[:, 1], states[:, 2], states[:, 3] = gone, 0.0 if up else np.pi, speed
    states[:, HEIGHT], states[:, CLIMB] = RISE / TREAD * gone, (1.0 if up else -1.0) * RISE / TREAD * speed
    states[:, 6] = times
    return RootPath(0.0, 0.15, states)


def liked(path: RootPath, walked: Floats | None = None) -> Floats:
    found: Floats = goals_on_stairs(
        natural_walk()(path) if walked is None else walked, path.states, GAIT.scale, GAIT.half_leg
    )
    return found


def test_on_the_level_it_is_what_is_liked_anyway() -> None:
    states = walk(up=True).states
    states[:, HEIGHT:] = 0.0
    goals = natural_walk()(RootPath(0.0, 0.15, states))
    assert np.array_equal(goals_on_stairs(goals, states, GAIT.scale, GAIT.half_leg), goals)
    assert np.array_equal(goals_on_stairs(goals, states[:, :7].copy(), GAIT.scale, GAIT.half_leg), goals)


def test_who_goes_down_is_lower_and_upright_and_who_climbs_is_as_high_as_ever() -> None:
    for up in (True, False):
        path = walk(up)
        before, after = natural_walk()(path), liked(path)
        deep = GAIT.half_leg * (after - before)[:, WAIST.start + 2]
        _, _, leans = hips_sinks(GAIT.half_leg, np.zeros(len(after)), np.ascontiguousarray(after[:, WAIST.start + 2])).T
        assert np.all(after[:, ABDUCTIONS] > before[:, ABDUCTIONS] + 0.05)
        assert np.abs(leans + after[:, WAIST.start] - before[:, WAIST.start]).max() < 1e-9
        assert np.all(np.abs(deep) < 1e-12) if up else np.all((deep > 0.03) & (deep < 0.5 * RISE))


def test_it_sets_in_gently_and_stays_within_limits() -> None:
    states = np.repeat(walk(up=False).states[:1], 200, axis=0)
    states[:, CLIMB] = np.linspace(0.0, -2.0, 200)
    path = RootPath(0.0, 0.15, states)
    steps = np.abs(np.diff(liked(path), axis=0))
    assert steps.max() < 0.02
    lowest = np.tile(limits(DofGroup.WAIST)[:, 1], (200, 1))
    wildest = natural_walk()(path)
    wildest[:, WAIST], wildest[:, ABDUCTIONS] = lowest, limits(ARMS[0])[1, 1]
    wild = liked(path, wildest)
    for group in (DofGroup.WAIST, *ARMS):
        least, most = limits(group).T
        assert np.all((wild[:, columns_of(group)] >= least) & (wild[:, columns_of(group)] <= most))


@pytest.mark.parametrize("up", [True, False])
def test_arms_hang_clear_of_thighs_that_come_up(up: bool) -> None:
    footing, path, pairs = Footing(MODEL, stair().ground), walk(up), self_pairs(MODEL)
    states, there = footing.stood(path.sample(np.linspace(0.0, path.horizon * path.interval, 200)))
    times = np.linspace(0.0, path.horizon, 200)

    def least(keys: Floats) -> float:
        uppers = np.stack([np.interp(times, np.arange(len(keys)), column) for column in keys.T], axis=1)
        return float(self_clearances(MODEL, pairs, states, uppers)[1:].min())

    assert there.all()
    assert least(liked(path)) > 0.01 > 0.0 > least(natural_walk()(path))


def test_there_is_room_to_crouch_on_treads_for_who_stands_on_them() -> None:
    """Feet that stand touch what they stand on, however deep one crouches."""
    scene, path = stair(), walk(up=False)
    legs = LoweredLegs(MODEL, scene.obstacles, scene.ground)
    stood = legs.stood(path)
    deep, still = np.full(path.horizon + 1, 0.2), np.zeros(path.horizon + 1)
    assert not legs.blocked_intervals(stood, deep, still, 0.02).any()
