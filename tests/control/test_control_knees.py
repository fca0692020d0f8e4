"""Knees and hips of shown walks: they bend and straighten as a leg's mass lets them, whatever is asked for."""

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import savgol_filter

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.experiment.motion.angles import leg_angles
from elbowroom.experiment.motion.walked import posed
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from sampled import sampled

Floats = NDArray[np.float64]

AVATAR = Humanoid.default()
DT = 1 / 60
AHEAD, STAND = Command(forward=1.0), Command()
TURNED = tuple(Command(forward=1.0, direction=np.radians(angle)) for angle in (0, 90, 180, 45))
# What is asked for, one after the other, for so many frames each.
WAYS = {
    "start": ((AHEAD,), 150),
    "run": ((Command(forward=1.0, run=True),), 150),
    "stop and go": ((AHEAD, STAND), 80),
    "other ways": (TURNED, 78),
    "back and on": ((Command(forward=-1.0), AHEAD), 110),
    "there and back": ((Command(strafe=1.0), Command(strafe=-1.0)), 90),
    "round": ((Command(turn=1.0), STAND), 80),
}
NO_SNAP = 9.5  # degrees
NO_JOLT = 0.011  # metres


def beside_smooth(values: Floats) -> float:
    """How far a track (N,) gets from the cubics that fit it best over a seventh of a second each."""
    return float(np.abs(values - savgol_filter(values, 9, 3)).max())


@pytest.mark.parametrize("name", sampled(WAYS, 3))
def test_knees_do_not_snap_and_hips_do_not_jolt(name: str) -> None:
    commands, frames = WAYS[name]
    controller, shown = Controller(AVATAR, Scene.load("empty")), []
    for k in range(max(4 * frames, 300)):
        shown.append(controller.step(commands[k // frames % len(commands)], DT))
    joints = posed(AVATAR, np.array([frame.q for frame in shown]), np.array([frame.root for frame in shown]))
    for side in ("left", "right"):
        assert beside_smooth(leg_angles(joints, AVATAR.skeleton, side)["knee"]) < NO_SNAP
    assert beside_smooth(joints[0][:, AVATAR.skeleton.index("hips"), 1]) < NO_JOLT


def test_hips_go_up_a_stair_without_a_jolt() -> None:
    """They came down to the foot below until it was let go, and then rose by 22 mm in one frame."""
    treads = [(2.0 + 0.28 * k, 0.17 * (k + 1)) for k in range(3)]
    stair = [
        {"type": "box", "center": [0.0, 0.5 * top, 0.5 * (begin + 4.5)], "size": [1.8, top, 4.5 - begin]}
        for begin, top in treads
    ]
    controller, shown = Controller(AVATAR, Scene.of("stair", stair, finish=(0.0, 4.5))), list[tuple[Floats, Floats]]()
    while controller.root.z < 3.0 and len(shown) < 400:
        frame = controller.step(AHEAD, DT)
        shown.append((frame.q, frame.root))
    assert controller.root.z >= 3.0
    joints = posed(AVATAR, np.array([q for q, _ in shown]), np.array([root for _, root in shown]))
    rises = np.diff(joints[0][:, AVATAR.skeleton.index("hips"), 1])
    assert rises.max() < 0.012, rises.max()
