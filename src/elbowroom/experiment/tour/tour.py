"""A tour: places visited one after the other, and what was shown on the way judged."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from elbowroom.control.controller import Controller
from elbowroom.control.frame import Frame
from elbowroom.control.recordings.recording import Recorder
from elbowroom.experiment.crossing import DT
from elbowroom.experiment.judge.motion import ShownMotion
from elbowroom.experiment.judge.settings import JudgeSettings
from elbowroom.experiment.judge.verdict import Judging
from elbowroom.experiment.listener import Listener
from elbowroom.experiment.tour.leg import Leg, LegTimes, walk_to
from elbowroom.planning.navigation.way import Place, Spot

_SPARE, _PACE = 30.0, 0.4  # seconds; m/s: who is slower on the whole has run out of time

Heard = Callable[[int, Leg], object]  # the number of a leg that has ended, and how
Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Milliseconds:
    """What something cost, over all times that it was done."""

    count: int
    median: float
    p99: float
    worst: float
    total: float

    @classmethod
    def of(cls, values: Floats) -> "Milliseconds":
        """Of costs (n,) in milliseconds."""
        if not len(values):
            return cls(0, 0.0, 0.0, 0.0, 0.0)
        median, p99, worst = (round(float(np.percentile(values, share)), 3) for share in (50, 99, 100))
        return cls(len(values), median, p99, worst, round(float(values.sum()), 3))


@dataclass(frozen=True)
class TourResult:
    """How a tour went."""

    scene: str
    seed: int
    targets: int
    arrived: int
    stuck: int  # times
    stuck_s: float
    seconds: float  # of walking
    plan_ms: Milliseconds  # frames that planned, on the clock
    plan_cpu_ms: Milliseconds  # the same in processor time
    frame_ms: Milliseconds  # all frames, on the clock
    frame_cpu_ms: Milliseconds  # those that did not plan, in processor time
    find_ms: Milliseconds  # finding the ways
    legs: tuple[Leg, ...]

    @property
    def given_up(self) -> tuple[Leg, ...]:
        """The legs that did not lead there."""
        return tuple(leg for leg in self.legs if not leg.arrived)


class FrameCollector:
    """Collects what is shown, for the judge."""

    def __init__(self, frame: Frame, recorder: Recorder | None = None) -> None:
        self._q, self._roots, self._recorder = [frame.q], [frame.root], recorder

    def append(self, frame: Frame, dt: float) -> None:
        """Keep one step."""
        self._q.append(frame.q)
        self._roots.append(frame.root)
        if self._recorder is not None:
            self._recorder.append(frame, dt)

    def motion(self) -> ShownMotion:
        """All of it."""
        return ShownMotion.at_rate(np.array(self._q), np.array(self._roots), 1.0 / DT)


def run_tour(
    controller: Controller,
    targets: Sequence[Place | Spot],
    listener: Listener | None = None,
    heard: Heard | None = None,
) -> TourResult:
    """Visit places one after the other; from where one was not reached, the next is gone to."""
    legs, times = list[Leg](), list[LegTimes]()
    for number, target in enumerate(targets):
        leg, cost = walk_to(controller, target, _limit(controller, target), listener)
        legs.append(leg)
        times.append(cost)
        if heard is not None:
            heard(number, leg)
    on_the_clock = np.concatenate([np.empty(0), *(cost.frame_ms for cost in times)])
    processor = np.concatenate([np.empty(0), *(cost.frame_cpu_ms for cost in times)])
    planned = np.concatenate([np.empty(0, np.bool_), *(cost.planned for cost in times)])
    return TourResult(
        scene=controller.scene.name,
        seed=controller.settings.seed,
        targets=len(legs),
        arrived=sum(leg.arrived for leg in legs),
        stuck=sum(leg.stuck_times for leg in legs),
        stuck_s=round(sum(leg.stuck_s for leg in legs), 3),
        seconds=round(sum(leg.seconds for leg in legs), 3),
        plan_ms=Milliseconds.of(on_the_clock[planned]),
        plan_cpu_ms=Milliseconds.of(processor[planned]),
        frame_ms=Milliseconds.of(on_the_clock),
        frame_cpu_ms=Milliseconds.of(processor[~planned]),
        find_ms=Milliseconds.of(np.array([cost.find_ms for cost in times])),
        legs=tuple(legs),
    )


def judging(shown: FrameCollector, controller: Controller, *, mesh: bool) -> Judging:
    """The other library's judgement of what was shown, against all that stands in the scene."""
    return Judging(shown.motion(), controller.humanoid, controller.scene, JudgeSettings(mesh=mesh))


def _limit(controller: Controller, target: Place | Spot) -> float:
    """Seconds that a leg may take."""
    across = float(np.hypot(*controller.scene.ground_size))
    return _SPARE + max(across, float(np.hypot(target[0], target[-1]))) / _PACE
