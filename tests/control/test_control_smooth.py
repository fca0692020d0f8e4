"""Whole walks as they are shown: bounded speeds and accelerations, no jump of a velocity, soon back in the swing."""

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import LOCAL_GROUPS, DofGroup, columns_of
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import ROOT_STATE
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.shown.body_check import BodyCheck
from elbowroom.planning.command import Command
from elbowroom.planning.exact.settings import ExactSettings
from elbowroom.planning.goal import natural_walk
from elbowroom.planning.root.path import RootPath
from elbowroom.planning.root.settings import RootMotionSettings
from elbowroom.world.scene import Scene
from sampled import sampled

Floats = NDArray[np.float64]

AVATAR = Humanoid.default()
DT = 1 / 60
HEAD_TURN = columns_of(DofGroup.HEAD).start + 1
NEAREST = 0.02  # metres: as near as at the nearest, nearly
FORWARD = Command(forward=1.0)
SCENES = ("c", "d", "doorway", "beam")
SEEDS = (None, 5, pytest.param(6, marks=pytest.mark.long))
LIMITS, ROOT = ExactSettings(), RootMotionSettings()
ROUNDING = 1.01


def fickle(seed: int, turns: int) -> list[Command]:
    """Mostly ahead, with stops, side steps, slow and turned walks."""
    rng = np.random.default_rng(seed)
    others = [Command(), Command(forward=0.5), Command(forward=1.0, strafe=0.7), Command(forward=0.7, turn=0.4)]
    others += [Command(forward=-1.0), Command(forward=1.0, strafe=-0.7), Command(forward=0.7, turn=-0.4)]
    commands: list[Command] = []
    while len(commands) < turns:
        commands += [FORWARD] * int(rng.integers(30, 80))
        commands += [others[rng.integers(len(others))]] * int(rng.integers(8, 30))
    return commands[:turns]


@cache
def walk(scene: str, seed: int | None, rate: int = 60) -> tuple[Frame, ...]:
    """Ahead, or under changing commands, shown `rate` times a second."""
    controller, turns = Controller(AVATAR, Scene.load(scene), planner="exact"), 6 * rate
    commands = [FORWARD] * turns if seed is None else fickle(seed, turns)
    frames = []
    for command in commands:
        frames.append(controller.step(command, 1 / rate))
        if controller.scene.finished(controller.root):
            break
    return tuple(frames)


def configurations(frames: tuple[Frame, ...]) -> Floats:
    q = np.array([frame.q for frame in frames])
    q[:, 2] = np.unwrap(q[:, 2])
    return q


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("scene", sampled(SCENES, 2))
def test_joints_keep_their_speeds_and_accelerations(scene: str, seed: int | None) -> None:
    """At every moment, also where a plan begins in the middle of a motion because the command changed."""
    frames = walk(scene, seed)
    assert min(frame.clearance for frame in frames) >= 0.0
    q = configurations(frames)
    for group in LOCAL_GROUPS:
        way = q[:, group.at]
        speeds = np.linalg.norm(np.diff(way, axis=0), axis=1) / DT
        asked = np.linalg.norm(np.diff(way, 2, axis=0), axis=1) / DT**2
        assert speeds.max() <= ROUNDING * LIMITS.speed_of(group)
        assert asked.max() <= ROUNDING * LIMITS.acceleration_of(group)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("scene", SCENES)
def test_the_root_keeps_its_accelerations(scene: str, seed: int | None) -> None:
    q = configurations(walk(scene, seed))
    places = np.linalg.norm(np.diff(q[:, :2], 2, axis=0), axis=1) / DT**2
    assert places.max() <= 1.01 * ROOT.braking
    assert np.abs(np.diff(q[:, 2])).max() / DT <= 1.01 * ROOT.turn_rate
    assert np.abs(np.diff(q[:, 2], 2)).max() / DT**2 <= 1.01 * ROOT.turn_acceleration


def test_no_velocity_jumps_between_plans() -> None:
    """Eight times as many frames: in none of them does a velocity change by more than its acceleration allows."""
    rate = 480
    q = configurations(walk("d", None, rate))
    for group in LOCAL_GROUPS:
        change = np.linalg.norm(np.diff(q[:, group.at], 2, axis=0), axis=1) * rate
        assert change.max() <= ROUNDING * LIMITS.acceleration_of(group) / rate
    assert np.linalg.norm(np.diff(q[:, :2], 2, axis=0), axis=1).max() * rate <= 1.01 * ROOT.braking / rate


@pytest.mark.parametrize("scene", ["a", "b", *SCENES])
def test_half_a_second_after_the_last_obstacle_the_walk_is_natural(scene: str) -> None:
    """As it is shown at the key times, and as it is planned from then on.

    The last obstacle is passed when the natural walk, legs included, would clear everything from then on.

    Where it clears everything all the time, as of a body that turns in a doorway, that is where it is nearest last. The
    head turns farther while the body still does: it looks where one goes.
    """
    frames, check = walk(scene, None), BodyCheck(AVATAR, Scene.load(scene))
    clear = np.array([check.clearance(frame.root[:ROOT_STATE], frame.goal, frame.time) for frame in frames])
    touching = np.flatnonzero(clear < LIMITS.margin)
    passed = int((touching if len(touching) else np.flatnonzero(clear < clear.min() + NEAREST))[-1])
    later = frames[passed + round(0.5 / DT) :]
    assert later
    keys = [frame for frame in later if abs(frame.time / LIMITS.interval - round(frame.time / LIMITS.interval)) < 1e-6]
    assert len(keys) > 1
    shown = np.array([frame.q[DofGroup.ROOT.size :] for frame in keys])
    natural = natural_walk()(RootPath(0.0, DT, np.array([frame.root for frame in keys])))
    off = np.abs(shown - natural)
    assert np.delete(off, HEAD_TURN, axis=1).max() < 0.06
    assert off[:, HEAD_TURN].max() < 0.1
    for plan in {frame.plan.number: frame.plan for frame in later if frame.plan is not None}.values():
        at = plan.root.path.times >= frames[passed].time + 0.5
        assert np.abs((plan.local.configurations - plan.local.goals)[at]).max() < 0.06
