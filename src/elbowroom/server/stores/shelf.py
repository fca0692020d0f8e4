"""Bytes by name that outlast a session; where several servers are one to their users, what all of them must find."""

import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from typing import Protocol

LASTING = 600.0  # seconds
_MOST = 1024  # things


class Shelf(Protocol):
    """Bytes by name, which servers may share; any thread may use it."""

    def put(self, name: str, data: bytes) -> None:
        """Keep the bytes for a while."""

    def get(self, name: str) -> bytes | None:
        """The bytes; None where there are none (any more)."""

    def drop(self, name: str) -> None:
        """Forget the bytes."""


class OwnShelf:
    """In the memory of this process: the newest, for some minutes. For what is small."""

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._kept: OrderedDict[str, tuple[float, bytes]] = OrderedDict()  # the oldest first

    def put(self, name: str, data: bytes) -> None:
        """Keep the bytes for a while."""
        with self._lock:
            self._kept[name] = self._clock(), data
            self._kept.move_to_end(name)
            while len(self._kept) > _MOST:
                self._kept.popitem(last=False)

    def get(self, name: str) -> bytes | None:
        """The bytes; None where there are none (any more)."""
        with self._lock:
            put, data = self._kept.get(name, (0.0, None))
        return data if self._clock() - put <= LASTING else None

    def drop(self, name: str) -> None:
        """Forget the bytes."""
        with self._lock:
            self._kept.pop(name, None)
