"""Many small tasks, and who does them: this process, several of this machine, or whatever else is `Workers`."""

import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol, TypeVar

from elbowroom.errors import InputError
from elbowroom.experiment.opened import Openable

MAX_JOBS = 256
Result_co = TypeVar("Result_co", covariant=True)
Result = TypeVar("Result")


class Task(Protocol[Result_co]):
    """Something that can be sent to another process and done there; equal tasks give equal results."""

    @property
    def things(self) -> tuple[Openable[Any], ...]:
        """What it asks of `opened`: scenes, avatars. Who does many tasks on another machine sends each there once."""

    def run(self) -> Result_co:
        """Do it."""


class Workers(Protocol):
    """Who does tasks."""

    @property
    def at_once(self) -> int:
        """How many tasks are done at the same time."""

    def run(self, tasks: Sequence[Task[Result]]) -> Iterator[tuple[int, Result]]:
        """Do the tasks; gives (index of the task, its result) as they finish, each once.

        What a task raises is raised here; raises `InputError` where the workers are lost. What is begun ends with the
        iterator.
        """


def usable_cores() -> int:
    """The number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def check_jobs(jobs: int) -> None:
    """Raises `InputError` unless this many processes may be started."""
    if not 1 <= jobs <= MAX_JOBS:
        raise InputError(f"jobs: {jobs} is not between 1 and {MAX_JOBS}")


@dataclass(frozen=True)
class ThisProcess:
    """The very process that asks, which does one task after the other: nothing is started for it."""

    at_once: ClassVar[int] = 1

    def run(self, tasks: Sequence[Task[Result]]) -> Iterator[tuple[int, Result]]:
        """See `Workers`."""
        for place, task in enumerate(tasks):
            yield place, task.run()


def workers_here(jobs: int) -> Workers:
    """So many at once on this machine; raises `InputError` for a number out of range."""
    return ThisProcess() if jobs == 1 else Processes(jobs)


@dataclass(frozen=True)
class Processes:
    """Processes of this machine: fresh ones (spawned) for each call, that do not outlive this one, however it ends.

    Raises `InputError` for numbers out of range.
    """

    at_once: int = 1

    def __post_init__(self) -> None:
        check_jobs(self.at_once)

    def run(self, tasks: Sequence[Task[Result]]) -> Iterator[tuple[int, Result]]:
        """See `Workers`; raises `InputError` if a process dies."""
        if not tasks:
            return
        context = multiprocessing.get_context("spawn")
        pool = ProcessPoolExecutor(min(self.at_once, len(tasks)), mp_context=context, initializer=_prepare)
        try:
            places = {pool.submit(_run, task): place for place, task in enumerate(tasks)}
            for future in as_completed(places):
                yield places.pop(future), future.result()
        except BrokenProcessPool:
            raise InputError("a worker process died (out of memory?); run again, what is done is kept") from None
        finally:
            pool.shutdown(wait=False, cancel_futures=True)


def _run(task: Task[Result]) -> Result:
    return task.run()


def _prepare() -> None:
    """In a new process: leave at once when the user interrupts, and when the process that asked is gone."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    threading.Thread(target=_leave_with_parent, daemon=True).start()


def _leave_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
