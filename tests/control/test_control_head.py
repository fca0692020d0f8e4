"""The head of an avatar that walks: it ducks before the trunk does, looks level while that bends, and leads a turn."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DOF, LOWERING, DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.pose.kinematics import body_model, posture_capsules
from elbowroom.control.controller import Controller
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.poses import Poser
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.experiment.motion.scripts import Script, open_ground, strokes
from elbowroom.experiment.motion.turning import head_lead
from elbowroom.experiment.motion.walked import walk
from elbowroom.planning.command import Command
from elbowroom.world.obstacles.obstacles import Obstacles
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
HUMANOID = Humanoid.default()
RATE = 60.0
BEND, NOD = DofGroup.WAIST.at.start, DofGroup.HEAD.at.start


def shown(scene: Scene, command: Callable[[float], Command], seconds: float) -> tuple[Floats, Floats]:
    """Configurations and root states of a walk, which the judge finds free."""
    controller, q, roots = Controller(HUMANOID, scene, seed=0), [], []
    for i in range(round(seconds * RATE)):
        frame = controller.step(command(i / RATE), 1 / RATE)
        q.append(frame.q)
        roots.append(frame.root)
    verdict = judge(ShownMotion.at_rate(np.array(q), np.array(roots)), HUMANOID, scene, JudgeSettings(mesh=False))
    assert verdict.capsules.touching == 0
    return np.array(q), np.array(roots)


def gaze(q: Floats, roots: Floats) -> Floats:
    """Yaw against the world and pitch, positive down, of the head in frames, radians: (F, 2), by the judge's posing."""
    poser = Poser(HUMANOID)
    local, hips = poser.local(q, roots)
    head = poser.world(local, hips, roots[:, :3]).rotations[:, HUMANOID.skeleton.index("head")]
    ahead = head @ np.array([0.0, 0.0, 1.0])
    return np.stack([np.unwrap(np.arctan2(ahead[:, 0], ahead[:, 2])), np.arcsin(-ahead[:, 1])], axis=1)


def stooping(q: Floats, roots: Floats) -> tuple[Floats, Floats]:
    """How far the chest leans from the vertical, degrees, and how far on the head is, metres, in frames: (F,) each."""
    poser, skeleton = Poser(HUMANOID), HUMANOID.skeleton
    local, hips = poser.local(q, roots)
    posed = poser.world(local, hips, roots[:, :3])
    up = posed.rotations[:, skeleton.index("chest")] @ np.array([0.0, 1.0, 0.0])
    return np.rad2deg(np.arccos(np.clip(up[:, 1], -1.0, 1.0))), posed.positions[:, skeleton.index("head"), 2]


def beam(bottom: float) -> Scene:
    box = Obstacles.boxes(
        np.array([[0.0, bottom + 0.1, 2.0]]), np.array([[0.0, 0, 0, 1]]), np.array([[1.5, 0.1, 0.07]])
    )
    return replace(Scene.load("empty"), obstacles=box)


def on(_: float) -> Command:
    return Command(forward=1.0)


def test_below_a_beam_that_only_the_crown_would_touch_the_head_alone_ducks() -> None:
    tops = posture_capsules(body_model(HUMANOID), np.zeros(DOF), np.zeros(7))[:, [1, 4], 0].max(axis=1)
    crown = float((tops + HUMANOID.capsules.radii).max())
    q, roots = shown(beam(crown - 0.02), on, 3.5)
    assert roots[-1, 1] > 2.8
    assert np.rad2deg(q[:, NOD].max()) > 15.0
    assert np.rad2deg(np.abs(q[:, BEND]).max()) < 1.0
    assert q[:, LOWERING].max() < 0.02


def test_under_a_low_beam_trunk_and_knees_help_and_where_there_is_room_the_gaze_is_level() -> None:
    q, roots = shown(Scene.load("beam"), on, 5.4)
    assert roots[-1, 1] > 4.8
    pitch, (stoop, z) = np.rad2deg(gaze(q, roots)[:, 1]), stooping(q, roots)
    assert stoop.max() > 30.0
    assert q[:, LOWERING].max() > 0.2
    # two key times before a head goes below something it begins to, some 0.65 m, and two after it, 0.35 m, it is back
    bent_in_the_open = (stoop > 4.0) & ((z < 1.27) | ((z > 2.4) & (z < 2.65)) | (z > 4.43))
    assert bent_in_the_open.sum() > 10
    # to keep to what was planned is worth 0.02 rad², 8 degrees, and hips list and bob by some more
    assert np.abs(pitch[bent_in_the_open]).max() < 10.0
    assert np.abs(pitch[-1]) < 1.0


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_head_leads_a_turn_by_some_tenths_of_a_second(side: float) -> None:
    """The gaze passes half the turn so much before the body does."""
    q, roots = shown(Scene.load("empty"), lambda t: Command(forward=1.0, turn=side * (1.5 < t < 2.6)), 4.0)
    yaw, heading = side * gaze(q, roots)[:, 0], side * roots[:, 2]
    half = 0.5 * heading[-1]
    assert heading[-1] > 0.8
    lead = (np.argmax(heading > half) - np.argmax(yaw > half)) / RATE
    assert 0.2 <= lead <= 0.5
    assert abs(yaw[-1] - heading[-1]) < 0.05


@pytest.mark.parametrize("degrees", [90.0, -90.0, 120.0])
def test_who_is_told_to_turn_looks_there_before_going_there(degrees: float) -> None:
    """By 0.2 to 1 s: legs do not go aside before the body has turned."""
    ahead, turned = (Command(forward=1.0, direction=direction) for direction in (0.0, np.deg2rad(degrees)))
    walked = walk(HUMANOID, Script("turn", open_ground(), strokes((1.5, ahead), (9.0, turned)), 3.5))
    lead = head_lead(walked, HUMANOID.skeleton)
    assert lead is not None
    assert 0.2 <= lead <= 1.0
