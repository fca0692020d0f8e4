"""Planning that can pause: it stops after each search, says what that cost, and goes on when it is asked to."""

from collections.abc import Callable, Generator
from typing import TypeVar

from elbowroom.planning.result import GroupEvidence

Found = TypeVar("Found")

# What it stops with: the cost of a group's search, or None after something else that takes its time.
Pausing = Generator[GroupEvidence | None, None, Found]


def _nothing() -> None:
    """Nobody calls the work off."""


def finished(work: Pausing[Found], go_on: Callable[[], None] = _nothing) -> Found:
    """What is found without a pause; `go_on` is called where one could be, and raises an exception to call it off."""
    while True:
        try:
            next(work)
        except StopIteration as end:
            found: Found = end.value
            return found
        go_on()
