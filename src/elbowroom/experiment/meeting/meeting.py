"""Two in a corridor: one walks, the other comes towards it or stands in its way; nobody is driven back or touched."""

import math
from functools import cache
from time import thread_time
from typing import NamedTuple

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.body.root import RootState
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.experiment.beside import BesideDesk
from elbowroom.experiment.meeting.settings import MeetingKind
from elbowroom.experiment.pacing import late_frames
from elbowroom.planning.command import Command
from elbowroom.world.scene import Scene

STEP = 0.3  # metres: the longest step back, and who goes farther was driven
_DT = 1 / 60
_PAST = 0.8  # metres that are between both when they have passed
_BODY = 0.32  # metres from the middle of one who stands to the wall, at least
_LENGTH, _HEIGHT, _THICK = 40.0, 2.2, 0.2  # metres, of the walls


class Start(NamedTuple):
    """Where both begin, metres, and what they want."""

    width: float  # of the corridor
    left: tuple[float, float]  # of its middle, as the first sees it
    apart: float
    paces: tuple[float, float]  # forward of their commands; 0 of who stands
    heading: float = 0.0  # of the corridor, as the first walks


class Met(NamedTuple):
    """How it ended."""

    start: Start
    passed: bool
    touched: bool
    seconds: float  # until then
    back: float  # metres, the farthest that one was driven back
    frame_ms: float  # processor time of the longest step of one; with its plan, where plans are made at once
    late: int  # frames that one of them was shown later than a frame after they were due

    @property
    def driven_back(self) -> bool:
        """Whether somebody was, by more than a step."""
        return self.back > STEP

    @property
    def well(self) -> bool:
        """Whether both may be content."""
        return self.passed and not self.touched and not self.driven_back


def corridor(width: float, heading: float = 0.0) -> Scene:
    """Two walls that are so far apart, along a heading."""
    walls = []
    for side in (-0.5, 0.5):
        x, z = placed(heading, side * (width + _THICK), 3.0)
        size = [_THICK, _HEIGHT, _LENGTH]
        walls.append({"type": "box", "center": [x, 0.5 * _HEIGHT, z], "size": size, "yaw": heading})
    return Scene.from_dict({**Scene.load("empty").to_dict(), "obstacles": walls})


def placed(heading: float, left: float, ahead: float) -> tuple[float, float]:
    """Where something is, x and z, that lies so far left and ahead as a heading goes."""
    sine, cosine = math.sin(heading), math.cos(heading)
    return left * cosine + ahead * sine, ahead * cosine - left * sine


def drawn(width: float, kind: MeetingKind, seed: int) -> Start:
    """Both somewhere across a corridor, some metres apart, each with a pace of its own; it leads anywhere."""
    rng = np.random.default_rng([seed, round(1000 * width), list(MeetingKind).index(kind)])
    room = 0.5 * width - _BODY
    left = float(rng.uniform(-room, room)), float(rng.uniform(-room, room))
    paces = float(rng.uniform(0.6, 1.0)), float(rng.uniform(0.6, 1.0)) * (kind is MeetingKind.WALKS)
    return Start(width, left, float(rng.uniform(3.0, 6.0)), paces, float(rng.uniform(-math.pi, math.pi)))


@cache
def load_kernels() -> None:
    """Once in a process: what loading them takes is no frame's time."""
    for pace in (1.0, 0.0):
        meet(Start(0.95, (0.0, 0.0), 2.5, (1.0, pace)), 6.0)


class _Walker:
    """One of both, and what its steps cost."""

    def __init__(self, humanoid: Humanoid, scene: Scene, start: RootState, pace: float, *, live: bool) -> None:
        self._desk = BesideDesk(_DT) if live else None
        self.controller = Controller(humanoid, scene, start=start, ahead=Lookahead(desk=self._desk))
        self._command = Command(forward=pace)
        self.costs: list[float] = []  # seconds of processor time, one for each step; plans made beside cost none

    def step(self) -> Frame:
        """The next frame."""
        began, planned = thread_time(), self._planned
        frame = self.controller.step(self._command, _DT)
        self.costs.append(thread_time() - began - (self._planned - planned))
        return frame

    @property
    def _planned(self) -> float:
        return 0.0 if self._desk is None else self._desk.processor

    @property
    def late(self) -> int:
        """How many frames were shown later than a frame after they were due."""
        return late_frames(np.array(self.costs), _DT)


def meet(start: Start, seconds: float = 15.0, *, live: bool = False) -> Met:
    """Let them walk until they have passed, or for so long; `live` plans beside playback, as a session does."""
    heading = start.heading
    humanoid, scene = Humanoid.default(), corridor(start.width, heading)
    along = np.array([math.sin(heading), math.cos(heading)])
    first, second = placed(heading, start.left[0], 0.0), placed(heading, start.left[1], start.apart)
    one = _Walker(humanoid, scene, RootState(*first, heading), start.paces[0], live=live)
    two = _Walker(humanoid, scene, RootState(*second, heading + math.pi), start.paces[1], live=live)
    farthest, back, touched, passed, turn = np.full(2, -np.inf), 0.0, False, False, 0
    while not passed and turn < round(seconds / _DT):
        turn += 1
        one.controller.others = (two.controller.prediction(),)
        two.controller.others = (one.controller.prediction(),)
        mine, yours = one.step(), two.step()
        touched |= mine.touching or yours.touching
        come = np.array([mine.root[:2] @ along, start.apart - yours.root[:2] @ along])
        farthest = np.maximum(farthest, come)
        back = max(back, float((farthest - come).max()))
        passed = bool(come.sum() > start.apart + _PAST)
    longest = 1e3 * max(one.costs + two.costs)
    return Met(start, passed, touched, turn * _DT, back, longest, one.late + two.late)
