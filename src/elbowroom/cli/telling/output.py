"""What commands print: results on stdout, progress on stderr."""

import json
import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn
from rich.table import Table

from elbowroom.cli.telling.spoken import said
from elbowroom.errors import InputError


def print_json(result: Mapping[str, Any]) -> None:
    """One JSON object on stdout; what is no JSON number becomes null."""
    print(json_text(result))


def json_text(result: Mapping[str, Any]) -> str:
    """One JSON object; what is no JSON number becomes null."""
    return json.dumps(_plain(result), indent=2, allow_nan=False)


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def print_row(title: str, row: Mapping[str, str]) -> None:
    """A small table of names and values on stdout."""
    table = Table(title=said(title), title_justify="left", show_header=False, box=None, pad_edge=False)
    table.add_column(style="dim")
    table.add_column(justify="right")
    for name, value in row.items():
        table.add_row(said(name), said(value))
    Console().print(table)


class Bar:
    """A progress bar, or nothing."""

    def __init__(self, progress: Progress | None, task: TaskID | None) -> None:
        self._progress, self._task = progress, task

    def move(self, completed: float, note: str = "") -> None:
        """Show what is done by now, in the unit of the total."""
        if self._progress is not None and self._task is not None:
            self._progress.update(self._task, completed=completed, note=note)

    def note(self, note: str) -> None:
        """Say what is done now."""
        if self._progress is not None and self._task is not None:
            self._progress.update(self._task, note=note)


@contextmanager
def progress_bar(title: str, total: float | None, quiet: bool) -> Iterator[Bar]:
    """A progress bar on stderr while the block runs; it leaves no trace behind.

    Silent where `quiet`, and where stderr is no terminal.
    """
    console = Console(stderr=True)
    if quiet or not console.is_terminal:
        yield Bar(None, None)
        return
    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[note]}"), TimeElapsedColumn())
    with Progress(*columns, console=console, transient=True) as progress:
        yield Bar(progress, progress.add_task(title, total=total, note=""))


def write_text(path: Path, text: str) -> None:
    """Write a text file; raises `InputError` where that cannot be."""
    try:
        path.write_text(text, "utf-8")
    except OSError as error:
        raise InputError(f"{path}: cannot be written ({error.strerror})") from None
