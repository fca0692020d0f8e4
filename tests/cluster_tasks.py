"""Small tasks for a cluster, in a module that its workers can import."""

import os
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import ray

from elbowroom.errors import InputError
from elbowroom.experiment.opened import Openable, opened


class Answer(NamedTuple):
    """What a task says of itself."""

    value: int
    node: str
    process: int


@dataclass(frozen=True)
class FilesBytes:
    """A file as a thing: how often it is opened is seen by a mark beside it."""

    path: Path

    def open(self) -> bytes:
        """Read it, leaving a mark."""
        with self.path.with_suffix(".opened").open("a") as marks:
            marks.write("x")
        return self.path.read_bytes()


@dataclass(frozen=True)
class Square:
    """Squares a number, taking a while."""

    number: int
    seconds: float = 0.0
    file: Path | None = None  # its bytes are added up as well

    @property
    def things(self) -> tuple[Openable[Any], ...]:
        """The file."""
        return () if self.file is None else (FilesBytes(self.file),)

    def run(self) -> Answer:
        """The square; raises `InputError` for a negative number."""
        if self.number < 0:
            raise InputError(f"{self.number} is negative")
        time.sleep(self.seconds)
        more = 0 if self.file is None else sum(opened(FilesBytes(self.file)))
        return Answer(self.number**2 + more, ray.get_runtime_context().get_node_id(), os.getpid())


@dataclass(frozen=True)
class Death:
    """Ends its worker: always, or until it has done so once."""

    mark: Path | None = None
    things: tuple[Openable[Any], ...] = ()

    def run(self) -> str:
        """Dies, or says that it lives."""
        if self.mark is not None and self.mark.exists():
            return "lives"
        if self.mark is not None:
            self.mark.touch()
        os._exit(9)
