"""Whatever the user does: nothing touches, not even between frames, and there is always a way to move again."""

import numpy as np
import pytest

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import judge
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene

AVATAR = Humanoid.default()
DT = 1 / 60
STEPS = 420
_WAYS_OUT = (
    Command(forward=-1.0), Command(forward=1.0), Command(strafe=1.0), Command(strafe=-1.0), Command(turn=1.0),
    Command(turn=-1.0),
)  # fmt: skip


def any_command(rng: np.random.Generator) -> Command:
    """Forward, as a hurried user does it, back, aside, a turn, all at once, nothing."""
    names = ["forward", "back", "strafe", "turn", "mixed", "direction", "stop"]
    kind = rng.choice(names, p=[0.4, *[0.1] * 6])
    sign = float(rng.choice([-1.0, 1.0]))
    return {
        "forward": Command(forward=1.0, run=bool(rng.random() < 0.3)),
        "back": Command(forward=-1.0),
        "strafe": Command(strafe=sign),
        "turn": Command(turn=sign),
        "mixed": Command(*rng.uniform(-1.0, 1.0, 3)),
        "direction": Command(forward=1.0, direction=float(rng.uniform(-1.0, 1.0))),
        "stop": Command(),
    }[str(kind)]


_LONG = [pytest.param(scene, seed, marks=pytest.mark.long) for scene, seed in (("b", 1), ("c", 2), ("doorway", 4))]


@pytest.mark.parametrize(("scene", "seed"), [("d", 3), *_LONG])
def test_no_sequence_of_commands_leads_into_an_obstacle_or_a_dead_end(scene: str, seed: int) -> None:
    pytest.importorskip("coal")
    rng, place = np.random.default_rng(seed), Scene.load(scene)
    controller = Controller(AVATAR, place, planner="exact", seed=seed)
    frames: list[Frame] = []
    while len(frames) < STEPS:
        command = any_command(rng)
        frames += [controller.step(command, DT) for _ in range(int(rng.integers(3, 50)))]
    assert not any(frame.touching for frame in frames)
    assert can_move(controller)
    q, roots = np.array([frame.q for frame in frames]), np.array([frame.root for frame in frames])
    verdict = judge(ShownMotion.at_rate(q, roots), AVATAR, place, JudgeSettings(mesh=False))
    assert verdict.capsules.touching == 0, verdict.capsules.contacts[0]
    assert np.ptp(roots[:, :2], axis=0).max() > 0.5


def can_move(controller: Controller) -> bool:
    """Whether some command moves the avatar ten centimetres, or turns it a quarter of a radian, in two seconds."""
    for command in _WAYS_OUT:
        before = controller.root
        for _ in range(round(2.0 / DT)):
            controller.step(command, DT)
            after = controller.root
            gone = np.hypot(after.x - before.x, after.z - before.z)
            if gone > 0.1 or abs(after.heading - before.heading) > 0.25:
                return True
    return False
