"""Whether an avatar gets through a scene, found by walking it with nobody looking and a bounded effort."""

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.experiment.crossing import DT
from elbowroom.experiment.scripted_user import ScriptedUser
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene


@dataclass(frozen=True)
class WalkLimits:
    """When to give up."""

    limit: float = 30.0  # seconds of simulated time
    work: float = 20.0  # seconds of processor time


@dataclass(frozen=True)
class UnseenWalk:
    """How it went."""

    decided: bool  # False where the work was over before the walk
    passed: bool  # through the finish
    stuck: int  # times
    seconds: float  # of simulated time
    x: float  # where the avatar was in the end, metres
    z: float


def walk_unseen(
    humanoid: Humanoid, scene: Scene, limits: WalkLimits, clock: Callable[[], float] = time.process_time
) -> UnseenWalk:
    """Let the scripted user steer from the start until the finish, or as far as the limits go.

    `clock` counts seconds of work. The same walk as a session's, but for planning being done at once.
    """
    controller = Controller(humanoid, scene)
    user = ScriptedUser(np.random.default_rng(0))
    until = clock() + limits.work
    frame, stuck = controller.step(Command(), 0.0), 0
    while not scene.finished(controller.root) and frame.time < limits.limit and clock() < until:
        was_stuck = frame.stuck
        frame = controller.step(user.command(frame.stuck, DT), DT)
        stuck += frame.stuck and not was_stuck
    passed, root = scene.finished(controller.root), controller.root
    decided = passed or frame.time >= limits.limit
    return UnseenWalk(decided, passed, stuck, frame.time, root.x, root.z)
