"""The one place where the servers of a cluster keep what all must find: an actor with bytes by name."""

import time
from collections import OrderedDict
from collections.abc import Callable
from typing import Any

import ray

from elbowroom.server.stores.shelf import LASTING

MOST = 2 * 2**30  # bytes


class Keeper:
    """Runs as an actor: keeps the newest, those that were asked for lately first, for some minutes."""

    def __init__(self, most: int = MOST, clock: Callable[[], float] = time.monotonic) -> None:
        self._most, self._clock = most, clock
        self._kept: OrderedDict[str, tuple[float, bytes]] = OrderedDict()  # what was used least recently first
        self._size = 0

    def put(self, name: str, data: bytes) -> None:
        """Keep bytes under a name."""
        self.drop(name)
        self._kept[name] = self._clock(), data
        self._size += len(data)
        while self._size > self._most:
            self.drop(next(iter(self._kept)))

    def get(self, name: str) -> bytes | None:
        """The bytes; None where there are none (any more). What is small, as where a user is, lasts for minutes."""
        if name not in self._kept:
            return None
        put, data = self._kept[name]
        if name.startswith("user:") and self._clock() - put > LASTING:
            self.drop(name)
            return None
        self._kept.move_to_end(name)
        return data

    def drop(self, name: str) -> None:
        """Forget the bytes."""
        if name in self._kept:
            self._size -= len(self._kept.pop(name)[1])


class SharedShelf:
    """The keeper, as a server sees it: a `Shelf`."""

    def __init__(self, keeper: Any) -> None:
        """`keeper` is the handle of the actor."""
        self._keeper = keeper

    def put(self, name: str, data: bytes) -> None:
        """Hand the bytes over, without waiting."""
        self._keeper.put.remote(name, data)

    def get(self, name: str) -> bytes | None:
        """The bytes; None where there are none (any more)."""
        found: bytes | None = ray.get(self._keeper.get.remote(name))
        return found

    def drop(self, name: str) -> None:
        """Forget the bytes, without waiting."""
        self._keeper.drop.remote(name)
