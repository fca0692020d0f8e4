"""Planning beside playback as a live session has it, in trials that run faster than life."""

import math
from time import perf_counter, thread_time

from elbowroom.control.plans.desk import Job
from elbowroom.control.plans.wayfinder import Answer


class BesideDesk:
    """A `PlanningDesk` that answers after as many frames as making the plan really took.

    A session plans in a thread of its own, so frames do not wait for plans, and answers come late. Here the plan is
    made at once, its time is measured, and the answer is held back for that time.
    """

    immediate = False

    def __init__(self, dt: float) -> None:
        self._dt = dt
        self._answer: Answer | None = None
        self._frames = 0  # that the answer is still held back
        self.busy = False
        self.spent = 0.0  # seconds of planning up to now
        self.processor = 0.0  # of these, seconds that a processor was at it
        self.last = 0.0  # seconds that the last plan took

    def submit(self, job: Job) -> None:
        """Do the job, and hold its answer back."""
        began, worked = perf_counter(), thread_time()
        self._answer = job()
        self.last = perf_counter() - began
        self.spent += self.last
        self.processor += thread_time() - worked
        self._frames, self.busy = math.ceil(self.last / self._dt), True

    def take(self) -> Answer | None:
        """The answer, once, when its time has come; asked for once in every frame."""
        if not self.busy:
            return None
        if self._frames > 0:
            self._frames -= 1
            return None
        self.busy = False
        return self._answer

    def forget(self) -> None:
        """Let the answer go."""
        self.busy = False
