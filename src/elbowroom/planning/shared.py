"""Frozen things that many walkers and threads share: each is made once and lives as long as somebody uses it."""

from collections import deque
from collections.abc import Callable, Hashable
from threading import Lock
from typing import Generic, TypeVar
from weakref import WeakValueDictionary

Thing = TypeVar("Thing")


class Shared(Generic[Thing]):
    """Things by what they are made of; the last few stay though nobody uses them, for who comes next."""

    def __init__(self, idle: int = 2) -> None:
        """At most `idle` things stay that nobody uses."""
        self._made: WeakValueDictionary[Hashable, Thing] = WeakValueDictionary()
        self._latest: deque[Thing] = deque(maxlen=idle)
        self._lock = Lock()

    def get(self, made_of: Hashable, make: Callable[[], Thing]) -> Thing:
        """The thing that is made of this: what `make` returned when it was asked for first."""
        with self._lock:
            found = self._made.get(made_of)
            if found is None:
                found = self._made[made_of] = make()
            if all(found is not other for other in self._latest):
                self._latest.append(found)
            return found
