"""Tasks that are done where they are asked for."""

import os
from dataclasses import dataclass
from typing import Any

import pytest

from elbowroom.errors import InputError
from elbowroom.experiment.parallel import Processes, ThisProcess, workers_here


@dataclass(frozen=True)
class Told:
    number: int
    things: tuple[Any, ...] = ()

    def run(self) -> tuple[int, int]:
        if self.number < 0:
            raise InputError(f"{self.number} is negative")
        return self.number, os.getpid()


def test_each_is_done_once_here_when_it_is_asked_for() -> None:
    run = ThisProcess().run([Told(3), Told(-1)])
    assert next(run) == (0, (3, os.getpid()))
    with pytest.raises(InputError, match=r"^-1 is negative$"):
        next(run)
    assert list(ThisProcess().run([])) == []


def test_one_at_once_needs_no_other_process() -> None:
    assert workers_here(1) == ThisProcess()
    assert (ThisProcess().at_once, workers_here(3).at_once) == (1, 3)
    assert workers_here(3) == Processes(3)
    with pytest.raises(InputError, match="jobs: 0 is not between"):
        workers_here(0)
