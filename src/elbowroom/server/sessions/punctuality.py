"""How punctual a session is: frames against the clock, answers to commands. Times are arguments, in seconds."""

from collections import deque
from collections.abc import Callable

from elbowroom.planning.command import Command, changed
from elbowroom.server.percentiles import percentiles
from elbowroom.server.sessions.meter import Meter

_FRAMES = 600  # that are remembered
_ANSWERS = 1000
_WAITING = 64  # commands that may wait


class Punctuality:
    """Remembers how late the last frames were, and how long the last commands waited for a motion of their own."""

    def __init__(self, meter: Meter | None = None) -> None:
        """`meter` counts what all sessions of a server come to."""
        self._meter = meter or Meter()
        self._late: deque[float] = deque(maxlen=_FRAMES)
        self._answers: deque[float] = deque(maxlen=_ANSWERS)
        self._waiting: deque[tuple[float, Command]] = deque(maxlen=_WAITING)  # since when, the oldest first

    def shown(self, late: float) -> None:
        """A frame was ready so long after it was due."""
        self._late.append(late)
        self._meter.frames.add(late)

    def asked(self, now: float, command: Command) -> None:
        """A command wants something else than the motion that is shown."""
        if not self._waiting or changed(self._waiting[-1][1], command):
            self._waiting.append((now, command))

    def begin(self) -> None:
        """Another walk is shown, or the same from its start: nothing waits for what it shows."""
        self._waiting.clear()

    def heard(self, now: float, heeds: Callable[[Command], bool]) -> None:
        """The motion that is shown `heeds` some commands: they and what was asked for before them wait no longer."""
        late = next((place for place in range(len(self._waiting), 0, -1) if heeds(self._waiting[place - 1][1])), 0)
        for _ in range(late):
            asked, _ = self._waiting.popleft()
            self._answers.append(now - asked)
            self._meter.answers.add(now - asked)

    @property
    def late_ms(self) -> float:
        """99th percentile of the frames' lateness, milliseconds."""
        return 1e3 * percentiles(self._late, 99)[0]

    @property
    def answer_ms(self) -> tuple[float, float, float] | None:
        """Median, 99th percentile and longest wait of the commands, milliseconds; None where there was none."""
        if not self._answers:
            return None
        half, most, longest = percentiles(self._answers, 50, 99, 100)
        return 1e3 * half, 1e3 * most, 1e3 * longest
