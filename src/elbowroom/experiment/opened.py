"""What tasks open by name: each thing once in a process, however many tasks ask for it."""

from typing import Any, Protocol, TypeVar

Opened_co = TypeVar("Opened_co", covariant=True)
Opened = TypeVar("Opened")

_MOST = 64  # things that a process holds


class Openable(Protocol[Opened_co]):
    """What can be opened, such as a scene by its name; equal things, equal hashes, and the same is found in them."""

    def open(self) -> Opened_co:
        """Read it; raises `InputError` where it cannot be read."""


_held: dict[Openable[Any], Any] = {}


def opened(thing: Openable[Opened]) -> Opened:
    """What the thing names, opened now if this process does not hold it."""
    if thing not in _held:
        bring(thing, thing.open())
    found: Opened = _held[thing]
    return found


def is_held(thing: Openable[Any]) -> bool:
    """Whether this process has opened or been brought it."""
    return thing in _held


def bring(thing: Openable[Opened], found: Opened) -> None:
    """Have `opened` give this: what was opened elsewhere, say where the file is. The oldest is forgotten."""
    if thing not in _held and len(_held) >= _MOST:
        del _held[next(iter(_held))]
    _held[thing] = found
