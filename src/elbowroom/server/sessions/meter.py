"""What all sessions of a server do to it, counted since it began: frames and how late they were, answers, plans."""

import time
from bisect import bisect_left
from collections import deque
from collections.abc import Callable
from threading import Lock
from typing import NamedTuple

LATE = 0.025  # seconds: a frame that is shown later than this is not in time
PROMPT = 0.150  # seconds in which a command is answered

_WINDOW, _EVERY = 4.0, 0.5  # seconds that are looked back on, and between two readings


class Histogram:
    """Counts of durations up to each of some bounds, in seconds; may be used from several threads."""

    def __init__(self, *bounds: float) -> None:
        self.bounds = bounds
        self._counts = [0] * (len(bounds) + 1)
        self._sum = 0.0
        self._lock = Lock()

    def add(self, seconds: float) -> None:
        """Count one."""
        place = bisect_left(self.bounds, seconds)
        with self._lock:
            self._counts[place] += 1
            self._sum += seconds

    def read(self) -> tuple[list[int], float]:
        """How many were up to each bound, those above the last one in the end (so the last is all), and their sum."""
        with self._lock:
            counts, total = list(self._counts), self._sum
        for place in range(1, len(counts)):
            counts[place] += counts[place - 1]
        return counts, total

    def beyond(self, bound: float) -> tuple[int, int]:
        """How many there were, and how many of them above one of the bounds."""
        counts, _ = self.read()
        return counts[-1], counts[-1] - counts[self.bounds.index(bound)]


class Reading(NamedTuple):
    """Counts at a moment, or what came between two moments; times in seconds."""

    time: float = 0.0
    processor: float = 0.0  # of all threads
    frames: int = 0
    late: int = 0  # of the frames
    planning: float = 0.0  # by the clock
    planning_processor: float = 0.0

    @property
    def cores(self) -> float:
        """How many processor cores were busy."""
        return self.processor / self.time if self.time > 0.0 else 0.0

    @property
    def late_share(self) -> float:
        """The part of the frames that were late."""
        return self.late / self.frames if self.frames else 0.0

    @property
    def planning_stretch(self) -> float:
        """How much longer plans took than their processor time: they wait for a core, or for each other."""
        return self.planning / self.planning_processor if self.planning_processor > 0.0 else 1.0


class Meter:
    """Counts, and what the last seconds were like; reads the clock that it is given."""

    def __init__(
        self, clock: Callable[[], float] = time.monotonic, processor: Callable[[], float] = time.process_time
    ) -> None:
        self._clock, self._processor = clock, processor
        self.frames = Histogram(0.001, 0.0025, 0.005, 0.01, LATE, 0.05, 0.1, 0.25)
        self.answers = Histogram(0.025, 0.05, 0.1, PROMPT, 0.25, 0.5, 1.0, 2.0)
        self.plans = Histogram(0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5)
        self.planning_processor = Histogram()
        self._readings: deque[Reading] = deque()
        self.look()

    def planned(self, seconds: float, processor: float) -> None:
        """A plan took so many seconds, and so many of a processor."""
        self.plans.add(seconds)
        self.planning_processor.add(processor)

    def look(self) -> None:
        """Take a reading, if the last one is not new."""
        now = self._clock()
        if self._readings and now - self._readings[-1].time < _EVERY:
            return
        (frames, late), (_, planning) = self.frames.beyond(LATE), self.plans.read()
        spent = self.planning_processor.read()[1]
        self._readings.append(Reading(now, self._processor(), frames, late, planning, spent))
        while len(self._readings) > 2 and self._readings[1].time <= now - _WINDOW:
            self._readings.popleft()

    def lately(self) -> Reading:
        """What the last four seconds, or what there was of them, came to."""
        self.look()
        first, last = self._readings[0], self._readings[-1]
        return Reading._make(after - before for before, after in zip(first, last, strict=True))
