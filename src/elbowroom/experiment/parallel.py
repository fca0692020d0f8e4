"""Many small jobs, each in one of several processes of their own."""

import multiprocessing
import os
import signal
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from typing import Protocol, TypeVar

from elbowroom.errors import InputError

MAX_JOBS = 256
Result_co = TypeVar("Result_co", covariant=True)
Result = TypeVar("Result")


class Task(Protocol[Result_co]):
    """Something that can be sent to another process and done there; equal tasks give equal results."""

    def run(self) -> Result_co:
        """Do it."""


def usable_cores() -> int:
    """The number of processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def check_jobs(jobs: int) -> None:
    """Raises `InputError` unless this many processes may be started."""
    if not 1 <= jobs <= MAX_JOBS:
        raise InputError(f"jobs: {jobs} is not between 1 and {MAX_JOBS}")


def run_all(tasks: Sequence[Task[Result]], jobs: int) -> Iterator[tuple[int, Result]]:
    """Run the tasks in `jobs` processes; gives (index of the task, its result) as they finish.

    The processes are fresh ones (spawned), end with the iterator, and do not outlive this process, however it ends.
    What a task raises is raised here; raises `InputError` if a process dies.
    """
    check_jobs(jobs)
    if not tasks:
        return
    context = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(min(jobs, len(tasks)), mp_context=context, initializer=_prepare)
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
