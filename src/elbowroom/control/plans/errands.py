"""Plans that are asked for and come later: one at a time, when they start, and which of them nobody waits for."""

from collections.abc import Callable
from functools import partial
from threading import Event
from typing import NamedTuple

from elbowroom.control.key_frame_queue import KeyFrameQueue
from elbowroom.control.plans.desk import PlanningDesk
from elbowroom.control.plans.foresight import Foresight, Haste
from elbowroom.control.plans.wayfinder import Answer, Question
from elbowroom.planning.command import Command, changed

_SAME_TIME = 1e-9  # seconds


class Heard(NamedTuple):
    """An answer that has come."""

    answer: Answer
    question: Question
    start: float  # seconds, when its motion starts in playback
    late: bool  # that moment has been played


class _Asked(NamedTuple):
    """A plan that is being made."""

    question: Question
    time: float  # seconds, when it was asked for
    delay: float  # of the queue then
    standing: bool  # it starts where the avatar stands, whenever that is
    haste: Haste
    superseded: Event  # set when something else is wanted


class Errands:
    """What a desk is asked for on behalf of one queue; learns how long it takes."""

    def __init__(self, desk: PlanningDesk) -> None:
        self._desk = desk
        self.begin()

    def begin(self) -> None:
        """Nothing is asked for, and nothing is known of how long plans take."""
        self._asked: _Asked | None = None
        self._too_late = False  # the last plan in a hurry came so
        self.foresight = Foresight(self._desk.immediate)

    @property
    def immediate(self) -> bool:
        """Whether answers are always there at once."""
        return self._desk.immediate

    @property
    def busy(self) -> bool:
        """Whether a plan is being made, or its answer waits."""
        return self._desk.busy

    @property
    def continues(self) -> bool:
        """Whether the plan that is being made goes on from the queue."""
        return self._asked is not None and not self._asked.standing

    def start(self, queue: KeyFrameQueue, *, at_once: bool, hurry: bool) -> float:
        """When a plan that is asked for now should start, as the queue is not empty: as soon as it can be there.

        That is the next unplayed key frame (receding horizon), or between key frames, if the user wants something else
        `at_once`.
        """
        coming, soonest = queue.unplayed().times, queue.time + self.foresight.lead(self._haste(hurry=hurry))
        time = soonest if at_once else next((time for time in coming if time >= soonest), coming[-1])
        return min(float(time), float(coming[-1]))

    def _haste(self, *, hurry: bool) -> Haste:
        return (Haste.AGAIN if self._too_late else Haste.HURRY) if hurry else Haste.NONE

    def ask(self, question: Question, answer: Callable[[Question], Answer | None], queue: KeyFrameQueue) -> None:
        """Submit a question to be answered by `answer`; the desk is not busy."""
        superseded = Event()
        asked = question._replace(query=question.query._replace(superseded=superseded.is_set))
        haste = self._haste(hurry=question.query.hurry)
        self._asked = _Asked(asked, queue.time, queue.delay, queue.empty, haste, superseded)
        self._desk.submit(partial(answer, asked))

    def hear(self, queue: KeyFrameQueue) -> Heard | None:
        """The answer, once, if it is there and still of use."""
        answer, asked = self._desk.take(), self._asked
        if answer is None or asked is None:
            self._asked = asked if self._desk.busy else None
            return None
        self._asked = None
        self.foresight.waited(queue.time - asked.time, asked.haste)
        start = queue.time if asked.standing else answer.path.start_time + queue.delay - asked.delay
        late = start < queue.time - _SAME_TIME
        self._too_late = late and asked.haste is not Haste.NONE
        return Heard(answer, asked.question, start, late)

    def supersede(self, command: Command) -> None:
        """Call off a plan in the making for what is not wanted any more; one that is in a hurry is soon there."""
        if self._asked is not None:
            query = self._asked.question.query
            if not query.hurry and changed(query.command, command):
                self._asked.superseded.set()

    def drop_continued(self) -> None:
        """A plan in the making that goes on from the queue is of no use any more."""
        if self.continues:
            self._asked = None

    def forget(self) -> None:
        """Let go of all that was asked for."""
        if self._asked is not None:
            self._asked.superseded.set()
        self._asked = None
        self._desk.forget()
