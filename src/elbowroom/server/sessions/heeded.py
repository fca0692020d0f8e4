"""Which command the shown motion was planned for: a plan is shown from its start on, until another one begins."""

from collections import deque

from elbowroom.control.frame import Frame
from elbowroom.planning.command import Command


class Heeded:
    """Follows the frames of one walk."""

    def __init__(self) -> None:
        self.command = Command()
        self._plan = 0  # the number of the last one
        self._coming: deque[tuple[float, Command]] = deque()  # starts, seconds, and commands of plans not shown yet

    def follow(self, frame: Frame) -> None:
        """Go on to a frame, the next one of the walk."""
        plan = frame.plan
        if plan is not None and plan.number != self._plan:
            self._plan, start = plan.number, plan.root.path.start_time
            while self._coming and self._coming[-1][0] >= start:
                self._coming.pop()
            self._coming.append((start, plan.command))
        while self._coming and self._coming[0][0] <= frame.time:
            self.command = self._coming.popleft()[1]
