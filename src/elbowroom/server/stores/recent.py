"""A few things that clients sent: when there are too many, one that nobody uses has to go."""

import threading
from collections import OrderedDict
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Generic, TypeVar

from elbowroom.errors import InputError

Item = TypeVar("Item")


@dataclass(frozen=True)
class Capacity:
    """How much there is place for."""

    most: int  # things in all
    each: int  # things of one sender; "", this machine, may fill it all
    size: int  # bytes of all of them, in memory or on disk


@dataclass(frozen=True)
class _Sent(Generic[Item]):
    item: Item
    size: int
    sender: str


class RecentlySent(Generic[Item]):
    """Things by id; may be used from several threads. What a user holds stays."""

    def __init__(self, capacity: Callable[[], Capacity], gone: Callable[[Item], object]) -> None:
        """`gone` is called with each thing that had to go."""
        self._capacity, self._gone = capacity, gone
        self._lock = threading.Lock()
        self._sent: OrderedDict[str, _Sent[Item]] = OrderedDict()  # the one used least recently first
        self._held: dict[Hashable, frozenset[str]] = {}

    def add(self, item_id: str, item: Item, size: int, sender: str = "") -> None:
        """Take a thing in, in place of others; raises `InputError` where those are all in use, or it is too large."""
        new = _Sent(item, size, sender)
        with self._lock:
            leaving = self._leaving(new)
            removed = [self._sent.pop(old).item for old in leaving]
            self._sent[item_id] = new
        for old in removed:
            self._gone(old)

    def get(self, item_id: str) -> Item | None:
        """The thing with this id, which counts as use; None if there is none (any more)."""
        with self._lock:
            if item_id not in self._sent:
                return None
            self._sent.move_to_end(item_id)
            return self._sent[item_id].item

    def items(self) -> list[Item]:
        """All of them, the one used least recently first."""
        with self._lock:
            return [sent.item for sent in self._sent.values()]

    def hold(self, user: Hashable, *item_ids: str) -> None:
        """These are what a user uses from now on; none: it has left."""
        with self._lock:
            self._held.pop(user, None)
            if item_ids:
                self._held[user] = frozenset(item_ids)

    def _leaving(self, new: _Sent[Item]) -> list[str]:
        """Who has to go for a new thing: the sender's own first."""
        capacity, held = self._capacity(), frozenset[str]().union(*self._held.values())
        if new.size > capacity.size:
            raise InputError(
                f"what was sent takes {new.size >> 20} MiB here; there are {capacity.size >> 20} for all files"
            )
        staying = dict(self._sent)
        leaving: list[str] = []
        while True:
            full = len(staying) >= capacity.most or sum(s.size for s in staying.values()) + new.size > capacity.size
            own = [known for known, sent in staying.items() if new.sender and sent.sender == new.sender]
            if not staying or not (full or len(own) >= capacity.each):
                return leaving
            free = next((known for known in [*own, *(staying if full else ())] if known not in held), None)
            if free is None:
                raise InputError("all files that this server has place for are in use; try again later")
            leaving.append(free)
            del staying[free]
