"""Progress of long work, with the time that is left, on stderr."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TaskID,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

from elbowroom.cli.telling.spoken import said

Move = Callable[[int, int], None]  # pieces done, pieces in all

_SECONDS_BETWEEN_LINES = 15.0
_WINDOW = 600.0  # seconds over which the speed is measured


@contextmanager
def time_left_bar(title: str, quiet: bool) -> Iterator[Move]:
    """A bar while the block runs; a line now and then where stderr is no terminal; nothing where `quiet`.

    What is done when the block first reports (by an earlier run) does not count for the speed.
    """
    console = Console(stderr=True)
    if quiet:
        yield _nothing
    elif console.is_terminal:
        with _bar(console) as progress:
            yield _Bar(progress, progress.add_task(title, total=None)).move
    else:
        yield _Lines(title, console).move


def _nothing(done: int, total: int) -> None:
    del done, total


def _bar(console: Console) -> Progress:
    left = TimeRemainingColumn(compact=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    rest = (TextColumn(f"[dim]{said('left')}"), left)
    return Progress(*columns, *rest, console=console, transient=True, speed_estimate_period=_WINDOW)


class _Bar:
    """Progress as a bar."""

    def __init__(self, progress: Progress, task: TaskID) -> None:
        self._progress, self._task = progress, task
        self._begun = False

    def move(self, done: int, total: int) -> None:
        """Show it."""
        if self._begun:
            self._progress.update(self._task, completed=done)
        else:
            self._progress.reset(self._task, total=total, completed=done)
        self._begun = True


class _Lines:
    """Progress as lines of text."""

    def __init__(self, title: str, console: Console) -> None:
        self._title, self._console = title, console
        self._first: tuple[float, int] | None = None
        self._told = -_SECONDS_BETWEEN_LINES

    def move(self, done: int, total: int) -> None:
        """Tell it, if the last line is long enough ago."""
        now = time.monotonic()
        if self._first is None:
            self._first = (now, done)
        began, before = self._first
        if done < total and now - self._told < _SECONDS_BETWEEN_LINES:
            return
        self._told = now
        text = said("{0}: {1} of {2}", self._title, done, total)
        if before < done < total:
            text += said(", about {0} left", as_time((now - began) / (done - before) * (total - done)))
        self._console.print(text, highlight=False)


def as_time(seconds: float) -> str:
    """A rough duration in words."""
    if seconds < 90.0:
        return said("{0} s", f"{seconds:.0f}")
    if seconds < 5400.0:
        return said("{0} min", f"{seconds / 60.0:.0f}")
    return said("{0} h", f"{seconds / 3600.0:.1f}")
