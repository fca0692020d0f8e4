"""Planning beside playback: a session's plans are made in a thread of their own, where kernels need no GIL."""

import os
import sys
import threading
import time
from concurrent.futures import Executor, Future

from elbowroom.control.plans.desk import Job
from elbowroom.control.plans.wayfinder import Answer
from elbowroom.server.sessions.meter import Meter

_TURN = 0.001  # seconds
_BEHIND = 5  # of niceness: a third of the share of a thread that shows frames


def let_frames_go_first() -> None:
    """Have threads that plan let go of the interpreter within a millisecond of being asked; by itself it takes five.

    Frames wait for each of the threads in turn: behind three of them they would be late before they are begun.
    """
    sys.setswitchinterval(_TURN)


def give_way() -> None:
    """Have processors go to threads that show frames before the thread that calls this; on Linux, elsewhere nothing.

    For a machine that serves many, whose frames are late where plans have the processors. Where a browser draws on the
    same ones plans would wait for that.
    """
    if sys.platform == "linux":
        os.setpriority(os.PRIO_PROCESS, threading.get_native_id(), _BEHIND)


class PlanningThread:
    """A `PlanningDesk` whose jobs are done by an executor; one session, one job at a time."""

    immediate = False

    def __init__(self, executor: Executor, meter: Meter | None = None) -> None:
        """`meter` is told what plans take."""
        self._executor = executor
        self._meter = meter or Meter()
        self._future: Future[Answer | None] | None = None

    @property
    def busy(self) -> bool:
        """Whether a job is being done, or its answer waits."""
        return self._future is not None

    def submit(self, job: Job) -> None:
        """Take on a job; returns at once."""
        self._future = self._executor.submit(self._done, job, time.perf_counter())

    def take(self) -> Answer | None:
        """The answer, once, if it is there; raises what the job raised."""
        if self._future is None or not self._future.done():
            return None
        future, self._future = self._future, None
        return future.result()

    def forget(self) -> None:
        """Let the job go: one that has begun ends unheard."""
        if self._future is not None:
            self._future.cancel()
            self._future = None

    def _done(self, job: Job, asked: float) -> Answer | None:
        spent = time.thread_time()
        try:
            return job()
        finally:
            self._meter.planned(time.perf_counter() - asked, time.thread_time() - spent)
