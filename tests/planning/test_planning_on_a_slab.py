"""What stands on a slab is in the way as if it stood on the plane, and the slab is not: for legs, paths and frames."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import leg_capsules
from elbowroom.body.root import HEIGHT, ROOT_STATE, RootState
from elbowroom.control.shown.body_check import BodyCheck, Frames
from elbowroom.planning.command import Command
from elbowroom.planning.root.legs.hull import to_check
from elbowroom.planning.root.legs.lower_body import LowerBody
from elbowroom.planning.root.motion import MotionBounds, dense_states, steer
from elbowroom.planning.root.planner import RootPlanner
from elbowroom.planning.root.query import Asked
from elbowroom.world.ground.making import ground_of
from elbowroom.world.obstacles.clearance import clearance
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.obstacles.shapes import Box
from elbowroom.world.scene import Scene
from sampled import sampled

Floats = NDArray[np.float64]

AVATAR = Humanoid.default()
BOUNDS = MotionBounds(2.5, 2.0, 3.0, 14.0)
HIGH, SIDE = 0.2, 30.0  # metres: the slab's top, and how far it reaches
UP = np.array([0.0, HIGH, 0.0])


def on_slab(obstacles: Obstacles) -> Obstacles:
    """The same, on a slab."""
    turns = np.concatenate([obstacles.rotations, [[0.0, 0.0, 0.0, 1.0]]])
    return Obstacles(
        (*obstacles.shapes, Box((SIDE, HIGH, SIDE))),
        np.concatenate([obstacles.centers + UP, [0.5 * UP]]),
        turns,
        (*obstacles.standing_names, "slab"),
    )


def raised(states: Floats) -> Floats:
    """Root states on the slab."""
    higher = states.copy()
    higher[..., HEIGHT] += HIGH
    return higher


@pytest.mark.parametrize("name", sampled("abcd"))
def test_no_contact_of_legs_is_left_out_and_the_slab_is_none(name: str) -> None:
    scene, rng = Scene.load(name), np.random.default_rng(ord(name))
    slab = on_slab(scene.obstacles)
    body, flat = LowerBody(AVATAR, slab, ground_of(slab)), LowerBody(AVATAR, scene.obstacles)
    every, looked_at, before = np.ones(8, np.bool_), 0, 0
    for _ in range(20):
        states = np.zeros((9, ROOT_STATE))
        states[0] = RootState(*rng.uniform([-0.6, 0, -3, -0.7, -0.6, -2, 0], [0.6, 4.5, 3, 2, 0.6, 2, 1]))
        steer(states, rng.uniform([-0.7, -0.6, -2.5], [2.2, 0.6, 2.5]), 0.15, BOUNDS)
        moving, _ = to_check(raised(states), 0.15, 3.0, 14.0, 0.01, body.hull, body.boxes)
        shown, owner = dense_states(states, 0.15, 0.0125, every)
        clear = clearance(leg_capsules(flat.model, shown), flat.radii, scene.obstacles.standing)
        least = np.full(8, np.inf)
        np.minimum.at(least, owner - 1, clear)
        assert not np.any(~moving & (least < 0.01))
        near = body.near(float(states[0, 0]), float(states[0, 1]), 6.0, HIGH)
        np.testing.assert_allclose(
            np.minimum(body.clearance(near, raised(shown)), 0.3), np.minimum(clear, 0.3), atol=2e-5
        )
        looked_at += int(moving.sum())
        before += int(to_check(states, 0.15, 3.0, 14.0, 0.01, flat.hull, flat.boxes)[0].sum())
    assert looked_at <= 1.3 * before + 8


@pytest.mark.parametrize("name", sampled(["a", "b", "doorway"]))
def test_ways_are_planned_there_as_on_the_plane(name: str) -> None:
    scene = Scene.load(name)
    slab = replace(scene, obstacles=on_slab(scene.obstacles))
    planners = [RootPlanner(AVATAR, each) for each in (scene, slab)]
    for ahead in (0.0, 0.8, 1.5):
        start = scene.start._replace(z=scene.start.z + ahead, forward=1.1)
        first, second = (
            list(planner.candidates(Asked(here, Command(forward=1.0), 12, 0.15)))
            for planner, here in zip(planners, (start, start._replace(height=HIGH)), strict=True)
        )
        assert [plan.kind for plan in first] == [plan.kind for plan in second]
        for one, other in zip(first, second, strict=True):
            np.testing.assert_allclose(one.path.states[:, :7], other.path.states[:, :7], atol=0.02)
            np.testing.assert_allclose(other.path.states[:, HEIGHT], HIGH, atol=1e-6)


@pytest.mark.long
def test_frames_are_as_far_from_all_but_the_slab() -> None:
    scene, rng = Scene.load("d"), np.random.default_rng(4)
    slab = replace(scene, obstacles=on_slab(scene.obstacles))
    flat, high = (BodyCheck(AVATAR, each) for each in (scene, slab))
    proven = [0, 0]
    for _ in range(60):
        root, upper = np.zeros(ROOT_STATE), np.zeros(DOF - DofGroup.ROOT.size)
        root[:7] = rng.uniform([-0.6, 0, -3, -0.7, -0.6, -2, 0], [0.6, 5.5, 3, 2, 0.6, 2, 1])
        later = root.copy()
        later[[0, 1, 6]] += rng.uniform(-0.02, 0.02, 3)
        here, there = raised(root), raised(later)
        on_plane, on_top = flat.clearance(root, upper, 0.0), high.clearance(here, upper, 0.0)
        assert min(on_plane, 0.2) == pytest.approx(min(on_top, 0.2), abs=2e-5)
        for number, (check, pair) in enumerate(
            ((flat, (root, later)), (high, (high.standing(here), high.standing(there))))
        ):
            proven[number] += check.free_between(Frames(pair, (upper, upper), (0.0, 1 / 60)))
    assert proven[0] == proven[1] > 10
