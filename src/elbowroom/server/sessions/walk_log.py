"""The walk of a session as a recording, in memory: what a page saves as `.elbow`."""

from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import NamedTuple

from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.recordings.recorded_things import Seen, seen_now
from elbowroom.control.recordings.recording import RecordingHeader, StepWriter
from elbowroom.errors import InputError

MOST_STEPS = 36_000  # ten minutes; what follows is not kept
_LONGEST = 0.5  # seconds of standing that are told as one step


class _Step(NamedTuple):
    frame: Frame
    dt: float
    assist: bool
    things: Seen


class WalkLog:
    """Appends what is shown; steps in which somebody stands, and nothing else happens, are told as one."""

    def __init__(self, controller: Controller) -> None:
        """Nothing is recorded yet."""
        self._controller = controller
        self._header = _header_of(controller)
        self.begin()

    def begin(self) -> None:
        """Begin anew: the controller was put back to its start."""
        self._file = BytesIO()
        self._last: _Step | None = None
        self._writer: StepWriter | None = None
        if self._header is not None:
            header = replace(self._header, start=self._controller.start)
            self._writer = StepWriter(self._file, self._controller, header)

    def add(self, frame: Frame, dt: float) -> None:
        """Keep the step that the controller has just made, by the frame that it led to."""
        last, step = self._last, _Step(frame, dt, self._controller.assist, seen_now(self._controller))
        if last is not None:
            if self._is_more_of(last, step):
                step = step._replace(dt=last.dt + dt)
            else:
                self._write(last)
        self._last = step

    def recording(self) -> bytes:
        """The whole file, as far as the walk has gone; raises `InputError` where there is none."""
        if self._writer is None:
            raise InputError("this walk is not recorded: the avatar's file is not here any more")
        if self._last is not None:
            self._write(self._last)
            self._last = None
        end = self._writer.end()
        return self._file.getvalue() + end

    def _is_more_of(self, last: _Step, step: _Step) -> bool:
        frame, other = last.frame, step.frame
        stands = frame.command.idle and other.command == frame.command and last.assist == step.assist
        if not stands or step.things or last.dt + step.dt > _LONGEST:
            return False
        return frame.q.tobytes() == other.q.tobytes() and frame.root.tobytes() == other.root.tobytes()

    def _write(self, step: _Step) -> None:
        if self._writer is not None and self._writer.steps < MOST_STEPS:
            self._writer.append_later(*step)


def _header_of(controller: Controller) -> RecordingHeader | None:
    """The header, without the folder where this server keeps the avatar; None where its file is gone."""
    try:
        header = RecordingHeader.of(controller)
    except InputError:
        return None
    return replace(header, live=True, avatar=replace(header.avatar, path=Path(header.avatar.path).name))
