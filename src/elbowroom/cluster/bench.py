"""How well a cluster is used: what a task costs beside its work, and how much faster more workers walk courses."""

import json
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

from elbowroom.cluster.bench_settings import ClusterSettings
from elbowroom.cluster.connection import connected
from elbowroom.experiment.gauntlet.tasks import CourseTask
from elbowroom.experiment.gauntlet.trial_settings import TrialSettings
from elbowroom.experiment.machine import machine_kind
from elbowroom.experiment.opened import Openable
from elbowroom.experiment.parallel import Task, Workers

_EMPTY = 400  # tasks without work

Tick = Callable[[int], None]


@dataclass(frozen=True)
class Crew:
    """So many workers, and what they did."""

    workers: int
    seconds: float  # for all courses, by the clock
    course_seconds: float  # that one course kept a worker, on average
    busy: float  # part of the workers' time in which they walked; 1 is perfect
    overhead_ms: float  # of the driver for each task that does nothing, all workers together


@dataclass(frozen=True)
class ClusterReport:
    """All crews on one machine or cluster."""

    machine: str
    settings: ClusterSettings
    crews: tuple[Crew, ...]
    record_bytes: float  # of a course's result in the log

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return asdict(self)


@dataclass(frozen=True)
class Nothing:
    """A task without work."""

    things: tuple[Openable[Any], ...] = ()

    def run(self) -> None:
        """Nothing."""


@dataclass(frozen=True)
class Timed:
    """A task, and how long it kept its worker."""

    task: CourseTask

    @property
    def things(self) -> tuple[Openable[Any], ...]:
        """Those of the task."""
        return self.task.things

    def run(self) -> tuple[float, dict[str, Any]]:
        """Seconds, and the task's result."""
        began = time.perf_counter()
        record = self.task.run()
        return time.perf_counter() - began, record


def run(settings: ClusterSettings, tick: Tick = lambda _: None, tell: Callable[[str], None] = print) -> ClusterReport:
    """Walk the same courses with each number of workers; each crew has walked a course before its time is taken."""
    crews, sizes = [], [0]
    for done, count in enumerate(settings.workers):
        with connected(settings.address, tell, count) as workers:
            crews.append(_crew(settings, workers, sizes))
        tick(done + 1)
    return ClusterReport(machine_kind(), settings, tuple(crews), sum(sizes) / max(len(sizes) - 1, 1))


def _crew(settings: ClusterSettings, workers: Workers, sizes: list[int]) -> Crew:
    count = workers.at_once
    _spent(workers, _tasks(settings, 10_000, 3 * count))
    empty, _ = _spent(workers, [Nothing() for _ in range(_EMPTY)])
    seconds, found = _spent(workers, _tasks(settings, 0, settings.courses))
    walking = sum(spent for spent, _ in found)
    sizes.extend(len(json.dumps(record)) for _, record in found)
    return Crew(count, seconds, walking / len(found), walking / (seconds * count), 1e3 * empty / _EMPTY)


def _tasks(settings: ClusterSettings, seed: int, count: int) -> list[Timed]:
    return [Timed(CourseTask(settings.level, seed + k, TrialSettings())) for k in range(count)]


def _spent(workers: Workers, tasks: "list[Timed] | list[Nothing]") -> tuple[float, list[Any]]:
    """Seconds by the clock until all is done, and the results."""
    began, given = time.perf_counter(), list[Task[Any]](tasks)
    found = [result for _, result in workers.run(given)]
    return time.perf_counter() - began, found
