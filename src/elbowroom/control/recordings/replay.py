"""A recording run again, and compared bit for bit."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import told
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame, Phase
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.control.recordings.recorded_things import obey, same_places
from elbowroom.control.recordings.recorded_ways import way_from
from elbowroom.control.recordings.recording import ASSIST, RESTART, Recording, command_of
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene

_PHASES = tuple(Phase)


@dataclass(frozen=True)
class Difference:
    """The first frame that came out otherwise."""

    frame: int  # counted from 0
    time: float  # seconds
    position: float  # metres between the two roots
    angle: float  # radians, the largest difference of a joint or the heading

    def __str__(self) -> str:
        place = f"frame {self.frame} at {self.time:.3f} s"
        return f"{place}: {self.position:.3g} m and {self.angle:.3g} rad from the recording"


@dataclass(frozen=True)
class ReplayResult:
    """How a replay went."""

    frames: int  # compared
    seconds: float  # of motion
    difference: Difference | None  # None: identical bit for bit

    @property
    def identical(self) -> bool:
        """Whether every frame was the recorded one, to the last bit."""
        return self.difference is None


def controller_for(recording: Recording, humanoid: Humanoid) -> Controller:
    """A controller as it was when the recording began."""
    header = recording.header
    settings = header.settings
    return Controller(
        humanoid,
        Scene.from_dict(header.scene, str(recording.path)),
        planner=settings.planner,
        seed=settings.seed,
        assist=settings.assist,
        start=header.start,
        motions=header.motions,
        ahead=Lookahead(settings.queue_size, settings.interval),
    )


def replay(recording: Recording, humanoid: Humanoid, progress: Callable[[int], object] | None = None) -> ReplayResult:
    """Run the recorded commands again, up to the first frame that differs; `progress` is told how many steps are done.

    Raises `InputError` where the recorded scene or a recorded step is not valid.
    """
    controller = controller_for(recording, humanoid)
    count, time, way = 0, 0.0, Command().way
    for chunk in recording.chunks():
        for step in chunk:
            if step["flags"] & RESTART:
                controller.reset()
            controller.assist = bool(step["flags"] & ASSIST)
            pushed = recording.things[recording.things["step"] == count]
            obey(controller, pushed)
            way = way_from(recording.ways, count, way)
            frame = controller.step(command_of(step, way), float(step["dt"]))
            time = frame.time
            if not (_same(step, frame, recording.root_size) and same_places(controller, pushed)):
                return ReplayResult(count + 1, time, _difference(count, step, frame))
            count += 1
        if progress is not None:
            progress(count)
    return ReplayResult(count, time, None)


def _same(step: Any, frame: Frame, known: int) -> bool:
    """Whether a frame is the recorded one, in as many numbers of the root as are `known`: older ones had fewer.

    Those that a frame lacks are recorded as 0.
    """
    same_root = step["root"][:known].tobytes() == told(frame.root)[:known].tobytes()
    same_pose = step["q"].tobytes() == frame.q.tobytes() and same_root
    return bool(same_pose and _PHASES.index(frame.phase) == step["phase"])


def _difference(index: int, step: Any, frame: Frame) -> Difference:
    away = np.abs(step["q"] - frame.q)
    return Difference(index, frame.time, float(np.hypot(away[0], away[1])), float(away[2:].max()))
