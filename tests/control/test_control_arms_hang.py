"""Who ducks walks on at full pace, and the arms hang: they do not point back along a bent trunk, as a ski jumper's."""

import numpy as np
import pytest
from numpy.typing import NDArray

from elbowroom.body.dof import DofGroup
from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.poses import Poser
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene
from sampled import sampled

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


def under(bottom: float, z: float) -> Scene:
    """A beam across the way."""
    beam = {"type": "box", "name": "beam", "center": [0.0, bottom + 0.3, z], "size": [3.0, 0.6, 0.2]}
    return Scene.of("low", [beam], finish=(0.0, 5.0))


@pytest.mark.parametrize("bottom", sampled([1.10, 1.25, 1.40]))
def test_arms_of_who_ducks_hang_and_soon_swing_again(bottom: float) -> None:
    scene = under(bottom, 1.8)
    controller = Controller(HUMANOID, scene, seed=0)
    frames: list[Frame] = []
    while controller.root.z < 4.0 and len(frames) < 4.5 * RATE:
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
    assert verdict.itself.touching == 0


@pytest.mark.parametrize("bottom", [1.10, 1.11, 1.15, 1.20])
def test_wherever_in_a_stride_one_comes_to_it_a_low_beam_is_passed_without_a_halt(bottom: float) -> None:
    """The belly was on the thighs in some moments of a full stride: who came in those dithered before the beam."""
    controller, seconds = Controller(HUMANOID, under(bottom, 2.6), seed=0), 0.0
    while controller.root.z < 4.0:
        frame = controller.step(Command(forward=1.0), 1 / RATE)
        assert frame.clearance >= 0.0
        assert not frame.stuck
        seconds += 1 / RATE
        assert seconds < 4.8
    assert frame.plan is not None
    assert frame.plan.found
