"""A walk that was shown: the controller's frames at 60 Hz, and every joint in the world."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.body.gait.foot_state import standing
from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import HEIGHT
from elbowroom.body.skeleton import Skeleton
from elbowroom.control.controller import Controller
from elbowroom.experiment.judge.poses import Posed, Poser
from elbowroom.experiment.motion.scripts import Script

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

RATE = 60  # frames a second


@dataclass(frozen=True, eq=False)
class Walked:
    """N frames, 1/60 s apart."""

    script: Script
    roots: Floats  # (N, SHOWN)
    joints: Posed
    standing: Bools  # (N, 2) which feet stand, as the walk means it
    clearances: Floats  # (N,) metres from what is in the way

    def settled(self) -> slice:
        """The frames that count."""
        return slice(round(self.script.settled * RATE), len(self.roots))


def walk(humanoid: Humanoid, script: Script) -> Walked:
    """Let the controller walk a script; it ends early where the scene's finish is crossed."""
    controller = Controller(humanoid, script.scene)
    qs, roots, clearances = [], [], []
    for number in range(round(script.seconds * RATE)):
        frame = controller.step(script.hand(number / RATE, controller.root), 1.0 / RATE)
        qs.append(frame.q)
        roots.append(frame.root)
        clearances.append(frame.clearance)
        if script.scene.finished(controller.root):
            break
    states = np.array(roots)
    return Walked(
        script,
        states,
        posed(humanoid, np.array(qs), states),
        standing(states),
        np.array(clearances),
    )


def posed(humanoid: Humanoid, q: Floats, roots: Floats) -> Posed:
    """Every joint in the world for configurations (N, DOF) and root states (N, 7)."""
    poser = Poser(humanoid)
    local, hips = poser.local(q, roots)
    return poser.world(local, hips, roots[:, [0, 1, 2, HEIGHT] if roots.shape[1] > HEIGHT else [0, 1, 2]])


def joint_track(joints: Posed, skeleton: Skeleton, bone: str) -> Floats:
    """The places (N, 3) of a joint."""
    places: Floats = joints.positions[:, skeleton.index(bone)]
    return places
