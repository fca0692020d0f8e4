"""Who may begin a session: as many as the server shows in time, by what it has measured."""

import time
from collections import Counter, deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from elbowroom.experiment.parallel import usable_cores
from elbowroom.server.entrance.cut_short import ABOUT_TO_END
from elbowroom.server.entrance.guard import is_loopback
from elbowroom.server.sessions.meter import Meter, Reading

FIRST = 8  # sessions that are let in whatever was measured: a few on a busy machine are not sent away
AMONG = 2  # the same for a server among others, which may have room
EACH = 8  # sessions of one machine that is not this one
MOST = 128  # sessions, each of which holds memory

_FULL = 0.9  # part of the cores that sessions may fill
_LATE = 0.01  # part of the frames that may be late
_STRETCH = 3.0  # plans may take so many times their processor time
_GUESS = 0.1  # cores: what a session takes that has begun just now, if it is not known better
_FRESH = 3.0  # seconds in which a session counts as just begun


class Admission:
    """Counts sessions and says whether there is room for another."""

    def __init__(
        self,
        meter: Meter,
        cores: float | None = None,
        clock: Callable[[], float] = time.monotonic,
        first: int = FIRST,
    ) -> None:
        """`cores` that there are for sessions, by default all that the process may use."""
        self._meter, self._clock, self._first = meter, clock, first
        self._cores = float(usable_cores()) if cores is None else cores
        self._of_machines: Counter[str] = Counter()
        self._begun: deque[float] = deque()
        self.refused = 0
        self.ending = False  # whether the server lets nobody in any more

    @property
    def sessions(self) -> int:
        """Sessions that are shown now."""
        return self._of_machines.total()

    @property
    def has_room(self) -> bool:
        """Whether another session of this machine would be let in now."""
        return self._refusal("127.0.0.1") is None

    def refusal(self, machine: str) -> str | None:
        """Why a machine (an address) may not begin another session now; None if it may."""
        reason = self._refusal(machine)
        self.refused += reason is not None
        return reason

    @contextmanager
    def seat(self, machine: str) -> Iterator[None]:
        """A session of a machine, while it lasts."""
        self._of_machines[machine] += 1
        self._begun.append(self._clock())
        try:
            yield
        finally:
            self._of_machines -= Counter((machine,))

    def _refusal(self, machine: str) -> str | None:
        if self.ending:
            return ABOUT_TO_END
        if not is_loopback(machine) and self._of_machines[machine] >= EACH:
            return f"your machine has {EACH} sessions here already"
        if self.sessions >= MOST or (self.sessions >= self._first and self._is_busy(self._meter.lately())):
            return f"this server has {self.sessions} sessions already, as many as it can show in time; try again later"
        return None

    def _is_busy(self, lately: Reading) -> bool:
        fresh = self._fresh()
        known = max(self.sessions - fresh, 0)
        each = max(lately.cores / known, 0.25 * _GUESS) if known and not fresh else _GUESS
        expected = lately.cores + each * (fresh + 1)
        late, waiting = lately.late_share > _LATE, lately.planning_stretch > _STRETCH
        return expected > _FULL * self._cores or late or waiting

    def _fresh(self) -> int:
        """Sessions that have begun so lately that what they take was hardly measured."""
        while self._begun and self._clock() - self._begun[0] > _FRESH:
            self._begun.popleft()
        return min(len(self._begun), self.sessions)
