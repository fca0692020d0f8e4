"""One walk through one course."""

import time
from dataclasses import dataclass

import numpy as np

from elbowroom.body.humanoid import Humanoid
from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.plans.lookahead import Lookahead
from elbowroom.experiment.crossing import DT
from elbowroom.experiment.gauntlet.course import Course
from elbowroom.experiment.gauntlet.trial_settings import TrialSettings
from elbowroom.experiment.gauntlet.user import CourseUser
from elbowroom.experiment.listener import Listener
from elbowroom.planning.command import Command


@dataclass(frozen=True)
class JudgeFigures:
    """What the judge, another collision library, found in the shown motion, 240 poses a second."""

    poses: int
    touching: int  # of these
    deepest: float  # metres, 0 where nothing touches
    least_clearance: float | None  # metres
    self_touching: int = 0  # poses with parts of the body deeper in each other than in the natural walk
    self_deepest: float = 0.0  # metres
    mesh_touching: int | None = None  # poses in which the avatar's own surface touches; None where it has none
    mesh_deepest: float | None = None  # metres
    mesh_clearance: float | None = None  # metres, the least


@dataclass(frozen=True)
class TrialResult:
    """How a walk through a course went."""

    level: int
    seed: int
    fingerprint: str  # of the course
    crossed: bool  # through within the limit
    straight: bool  # through, and never stuck
    stuck_times: int
    stopped: bool  # not through in time, and never touching
    touching_frames: int  # shown frames in which the body touches an obstacle
    least_clearance: float  # metres, over all frames
    seconds: float  # of the walk, until the finish or the limit
    limit: float  # seconds that the user had
    frames: int
    collision_checks: int
    plan_ms: tuple[float, ...]  # what each step with a planning call took
    judge: JudgeFigures | None = None  # None where the judge was not asked


def controller_on(humanoid: Humanoid, course: Course, settings: TrialSettings) -> Controller:
    """The controller at the start of a course."""
    ahead = Lookahead(settings.queue_size)
    return Controller(humanoid, course.scene, planner=settings.planner, seed=course.seed, ahead=ahead)


def walk_course(controller: Controller, course: Course, listener: Listener | None = None) -> TrialResult:
    """Let the user walk until the finish or the course's time limit; `listener` hears of every step."""
    user = CourseUser(course.line, np.random.default_rng([course.level, course.seed]))
    ledger = _Ledger()
    frame = controller.step(Command(), 0.0)
    while frame.time < course.limit and not course.scene.finished(controller.root):
        command = user.command(controller.root, frame.stuck, DT)
        began = time.perf_counter()
        frame = controller.step(command, DT)
        ledger.enter(frame, time.perf_counter() - began)
        if listener is not None:
            listener(frame, DT)
    return ledger.result(course, course.scene.finished(controller.root), frame.time)


class _Ledger:
    """What the frames of a trial add up to."""

    def __init__(self) -> None:
        self._frames = self._touching = self._stuck_times = self._checks = self._plans = 0
        self._stuck = False
        self._clearance = np.inf
        self._plan_ms: list[float] = []

    def enter(self, frame: Frame, cost: float) -> None:
        """Add a frame that took `cost` seconds to compute."""
        self._frames += 1
        self._checks += 1
        self._touching += frame.clearance < 0.0
        self._clearance = min(self._clearance, frame.clearance)
        self._stuck_times += frame.stuck and not self._stuck
        self._stuck = frame.stuck
        if frame.plan is not None and frame.plan.number > self._plans:
            self._plans = frame.plan.number
            self._checks += frame.plan.checks
            self._plan_ms.append(round(1e3 * cost, 3))

    def result(self, course: Course, crossed: bool, seconds: float) -> TrialResult:
        """The trial in numbers."""
        return TrialResult(
            level=course.level,
            seed=course.seed,
            fingerprint=course.fingerprint,
            crossed=crossed,
            straight=crossed and self._stuck_times == 0,
            stuck_times=self._stuck_times,
            stopped=not crossed and self._touching == 0,
            touching_frames=self._touching,
            least_clearance=round(float(self._clearance), 6),
            seconds=round(seconds, 3),
            limit=course.limit,
            frames=self._frames,
            collision_checks=self._checks,
            plan_ms=tuple(self._plan_ms),
        )
