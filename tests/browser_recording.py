"""A short recording for tests of the page."""

from pathlib import Path

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.control.recordings.recording import Recorder
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene

_STEP = 1.0 / 60.0


def record_walk(file: Path, steps: int) -> Path:
    """A walk without assistance, for which nothing has to be planned; the file."""
    controller, ahead = Controller(Humanoid.default(), Scene.load("doorway"), assist=False), Command(forward=1.0)
    with Recorder(file, controller) as recorder:
        for _ in range(steps):
            recorder.append(controller.step(ahead, _STEP), _STEP)
    return file
