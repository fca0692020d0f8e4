"""Arms of who ducks hang: they do not lie along a bent trunk, pointing back like a ski jumper's."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.poses import Poser
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene

Floats = NDArray[np.float64]
HUMANOID = Humanoid.default()
RATE = 60.0
AHEAD, BEHIND = 45.0, 45.0  # degrees from the vertical that upper arms may be: what a swing has, and a little more
FIRST = DofGroup.ROOT.size
ARMS = slice(DofGroup.LEFT_ARM.at.start, DofGroup.RIGHT_ARM.at.stop)
KEPT = 0.25  # radians from the swing: to keep to what was planned is worth 0.02 rad², and between key times goals are
# told straight
BACK = 0.5  # seconds after which arms swing as ever


def seen(q: Floats, roots: Floats) -> tuple[Floats, Floats, Floats]:
    """How far a chest leans forward (F,), and both upper arms behind the vertical (2, F), degrees; and how high the
    lower hand is, metres (F,)."""
    poser, index = Poser(HUMANOID), HUMANOID.skeleton.index
    local, hips = poser.local(q, roots)
    posed = poser.world(local, hips, roots[:, :3])
    up, places = posed.rotations[:, index("chest")] @ np.array([0.0, 1.0, 0.0]), posed.positions
    bones = [places[:, index(f"{side}LowerArm")] - places[:, index(f"{side}UpperArm")] for side in ("left", "right")]
    behind = np.array([np.arctan2(-bone[:, 2], -bone[:, 1]) for bone in bones])
    hands = np.minimum(places[:, index("leftHand"), 1], places[:, index("rightHand"), 1])
    return np.rad2deg(np.arctan2(up[:, 2], up[:, 1])), np.rad2deg(behind), hands


@pytest.mark.parametrize("bottom", [1.15, 1.25, 1.40])
def test_arms_of_who_ducks_hang_and_soon_swing_again(bottom: float) -> None:
    beam = {"type": "box", "name": "beam", "center": [0.0, bottom + 0.3, 1.8], "size": [3.0, 0.6, 0.2]}
    scene = Scene.of("low", [beam], finish=(0.0, 5.0))
    controller, frames = Controller(HUMANOID, scene, seed=0), []
    while controller.root.z < 4.0 and len(frames) < 8.0 * RATE:
        frames.append(controller.step(Command(forward=1.0), 1 / RATE))
    q, roots = np.array([frame.q for frame in frames]), np.array([frame.root for frame in frames])
    lean, behind, hands = seen(q, roots)
    bent = lean > 30.0
    assert bent.sum() > 0.3 * RATE
    assert behind[:, bent].max() < BEHIND
    assert behind[:, bent].min() > -AHEAD
    assert hands[bent].min() > 0.15
    upright = int(np.flatnonzero(lean > 10.0)[-1]) + round(BACK * RATE)
    goals = np.array([frame.goal for frame in frames])
    assert np.abs(q[upright:, ARMS] - goals[upright:, ARMS.start - FIRST : ARMS.stop - FIRST]).max() < KEPT
    verdict = judge(ShownMotion.at_rate(q, roots), HUMANOID, scene, JudgeSettings(mesh=False))
    assert verdict.capsules.touching == 0
    assert not any("Arm" in contact.part or "Hand" in contact.part for contact in verdict.itself.contacts)
