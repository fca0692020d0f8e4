"""A desk whose answers come some turns late, always the same: slow planning without a clock."""

from elbowroom.control.plans.desk import Job
from elbowroom.control.plans.wayfinder import Answer


class LateDesk:
    """Hands each answer over after `turns` turns of playback."""

    immediate = False

    def __init__(self, turns: int) -> None:
        self.turns = turns
        self.taken: list[int] = []  # the turns, counted from 0, in which an answer was handed over
        self._turn = -1
        self._due = 0
        self._answer: Answer | None = None

    @property
    def busy(self) -> bool:
        return self._answer is not None

    def submit(self, job: Job) -> None:
        self._answer, self._due = job(), self._turn + self.turns

    def take(self) -> Answer | None:
        if self._answer is None or self._turn < self._due:
            return None
        answer, self._answer = self._answer, None
        self.taken.append(self._turn)
        return answer

    def forget(self) -> None:
        self._answer = None

    def next_turn(self) -> None:
        """A turn begins."""
        self._turn += 1
