"""Where planning is done: at once, in the turn that asks; or elsewhere, while playback goes on."""

from collections.abc import Callable
from typing import Protocol

from elbowroom.control.plans.wayfinder import Answer

Job = Callable[[], Answer | None]  # none if it was called off meanwhile


class PlanningDesk(Protocol):
    """Takes one job at a time and hands its answer over when it is there.

    What is shown depends on it only by the turns in which answers are handed over: a desk that hands them over in the
    same turns gives the same frames, bit for bit.
    """

    @property
    def immediate(self) -> bool:
        """Whether the answer is always there at once."""

    @property
    def busy(self) -> bool:
        """Whether a job is being done, or its answer waits."""

    def submit(self, job: Job) -> None:
        """Take on a job; the desk is not busy."""

    def take(self) -> Answer | None:
        """The answer to the job, once, if it is there; raises what the job raised.

        A job that ended without an answer leaves the desk free.
        """

    def forget(self) -> None:
        """Let the job and its answer go; the desk is not busy then."""


class ImmediateDesk:
    """Does each job at once, in the caller's thread."""

    immediate = True

    def __init__(self) -> None:
        self._answer: Answer | None = None

    @property
    def busy(self) -> bool:
        """Whether an answer waits."""
        return self._answer is not None

    def submit(self, job: Job) -> None:
        """Do the job."""
        self._answer = job()

    def take(self) -> Answer | None:
        """The answer, once."""
        answer, self._answer = self._answer, None
        return answer

    def forget(self) -> None:
        """Let the answer go."""
        self._answer = None
